//! The equation of a step as it is solved at length, with neither the number of coordinates nor the form of
//! the matrix in its type ([`nonlinear`](crate::numbers::nonlinear)).

use nalgebra::{SMatrix, SVector};

use super::Solution;
use crate::numbers::{
    NewtonMatrix, Scalar, Singular,
    nonlinear::{Equations, Evaluate, Matrix, Room, Root, Solved, Unsolved, VECTORS, Way},
    slices::{vector, write},
};
use crate::step::equation::StepEquation;
use crate::step::{Momenta, Report, Segment, State, StepError};
use crate::system::Quantity;

/// The equation of a step from `state`, behind a pointer, so that systems of one size share what asks it.
pub(crate) struct StepProblem<'e, S, M, const N: usize> {
    pub(crate) equation: &'e dyn StepEquation<S, N, Matrix = M>,
    pub(crate) state: &'e State<S, N>,
    pub(crate) h: S,
}

/// An equation that was not solved.
pub(crate) struct NotSolved<S, const N: usize> {
    pub(crate) error: StepError,
    /// Where derivatives were last no finite numbers, if they were. On core alone nobody asks.
    pub(crate) lost: Option<Segment<S, N>>,
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> StepProblem<'_, S, M, N> {
    /// The solution by this way, from the velocity `v`.
    ///
    /// # Errors
    /// Those of [`at_length`](crate::numbers::nonlinear::AtLength::at_length).
    #[cold]
    #[inline(never)]
    pub(crate) fn solved(
        &self,
        way: Way<'_, S>,
        v: &SVector<S, N>,
    ) -> Result<Solution<S, N>, NotSolved<S, N>> {
        self.equation.compare();
        let mut buffer = room::<S, N>();
        let mut evaluate = Evaluations { of: self, present: M::zero(), before: M::zero(), lost: None };
        let momenta = Momenta { p0: nalgebra::zero(), p1: nalgebra::zero() };
        let mut solution = Solution { unknown: *v, momenta, report: Report::of_no_equation() };
        let of = Equations {
            evaluate: &mut evaluate,
            q: self.state.q.as_slice(),
            p: self.state.p.as_slice(),
            h: self.h,
            held: &[],
        };
        let Momenta { p0, p1 } = &mut solution.momenta;
        let root = Root { v: solution.unknown.as_mut_slice(), p0: p0.as_mut_slice(), p1: p1.as_mut_slice() };
        match S::at_length(of, way, root, Room::new(buffer.as_flattened_mut(), N)) {
            Ok(report) => solution.report = report.into(),
            Err(error) => return Err(NotSolved { error: error.into(), lost: evaluate.lost }),
        }
        Ok(solution)
    }
}

/// Room for the vectors of the solver.
pub(super) fn room<S: Scalar, const N: usize>() -> [[S; N]; VECTORS] {
    [[S::zero(); N]; VECTORS]
}

/// A [`StepProblem`] with the matrices that were evaluated last.
struct Evaluations<'p, 'e, S, M, const N: usize> {
    of: &'p StepProblem<'e, S, M, N>,
    present: M,
    before: M,
    /// The segment on which a derivative was last no finite number.
    lost: Option<Segment<S, N>>,
}

/// Writes |Aᵢᵢ| for each i.
fn write_sizes<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(entries: &mut [S], matrix: &M) {
    for (i, entry) in entries.iter_mut().enumerate() {
        *entry = matrix.entry(i, i).abs();
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Evaluations<'_, '_, S, M, N> {
    fn inertia(&self, q: &[S], v: &[S]) -> SMatrix<S, N, N> {
        self.of.equation.inertia(&Segment { q0: vector(q), v: vector(v), h: self.of.h })
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Evaluate<S> for Evaluations<'_, '_, S, M, N> {
    fn kernel(&mut self, q: &[S], v: &[S], h: S, held: &[S], p0: &mut [S]) {
        let segment = Segment { q0: vector(q), v: vector(v), h };
        let kernel = self.of.equation.kernel(&segment);
        self.present = kernel.matrix;
        if cfg!(feature = "std")
            && (0..N).any(|i| !kernel.p0[i].is_finite() || !kernel.matrix.row_is_finite(i))
        {
            self.lost = Some(segment);
        }
        if held.iter().any(|held| *held != S::zero()) {
            self.present.hold(held);
        }
        write(p0, &kernel.p0);
    }

    fn keep(&mut self) {
        self.before = self.present;
    }

    fn solve(&self, right: &[S], x: &mut [S]) -> Result<(), Singular> {
        write(x, &self.present.solve(&vector(right))?);
        Ok(())
    }

    fn magnitudes(&self, of: Matrix<'_, S>, v: &[S], sums: &mut [S]) {
        let v = vector(v);
        let found = match of {
            Matrix::Present => self.present.magnitudes(&v),
            Matrix::Before => self.before.magnitudes(&v),
            Matrix::Mass { q, v: at } => self.inertia(q, at).magnitudes(&v),
        };
        write(sums, &found);
    }

    fn diagonal(&self, of: Matrix<'_, S>, entries: &mut [S]) {
        if let Matrix::Mass { q, v } = of {
            write_sizes(entries, &self.inertia(q, v));
        } else {
            write_sizes(entries, if matches!(of, Matrix::Before) { &self.before } else { &self.present });
        }
    }

    fn row_is_finite(&self, row: usize) -> bool {
        self.present.row_is_finite(row)
    }

    fn momenta(&self, q: &[S], v: &[S], h: S, p0: &mut [S], p1: &mut [S]) {
        let momenta = self.of.equation.momenta(&Segment { q0: vector(q), v: vector(v), h });
        write(p0, &momenta.p0);
        write(p1, &momenta.p1);
    }

    fn cancelling(&self, q: &[S], v: &[S], h: S, terms: &mut [S]) {
        write(terms, &self.of.equation.cancelling(&Segment { q0: vector(q), v: vector(v), h }));
    }

    fn add_holding(&self, q: &[S], v: &[S], h: S, terms: &mut [S]) {
        let holding = self.of.equation.holding(&Segment { q0: vector(q), v: vector(v), h });
        terms.iter_mut().zip(holding.as_slice()).for_each(|(term, holding)| *term += *holding);
    }

    fn along_constraints(&mut self, q: &[S], v: &[S], h: S, correction: &[S], along: &mut [S]) -> bool {
        let segment = Segment { q0: vector(q), v: vector(v), h };
        let found = self.of.equation.along_constraints(&segment, &vector(correction));
        found.is_some_and(|found| {
            write(along, &found);
            true
        })
    }

    fn is_held(&self, q: &[S], v: &[S], h: S) -> bool {
        self.of.equation.is_held(&Segment { q0: vector(q), v: vector(v), h })
    }
}

impl<S: Scalar> From<Solved<S>> for Report<S> {
    fn from(Solved { iterations, damped, residual, floor, last_correction }: Solved<S>) -> Self {
        Self { iterations, damped, residual, floor, last_correction }
    }
}

impl<S: Scalar> From<Unsolved<S>> for StepError {
    fn from(error: Unsolved<S>) -> Self {
        match error {
            Unsolved::NonFinite { index } => Self::NonFinite { quantity: Quantity::Derivatives, index },
            Unsolved::Singular { iteration, column } => Self::SingularNewtonMatrix { iteration, column },
            Unsolved::NoRoot { iteration, residual } => {
                Self::NoRealSolution { iteration, residual: residual.widen() }
            }
            Unsolved::LostPrecision { residual, floor } => {
                Self::LostPrecision { residual: residual.widen(), floor: floor.widen() }
            }
            Unsolved::NotConverged { iterations, residual, floor } => {
                Self::NotConverged { iterations, residual: residual.widen(), floor: floor.widen() }
            }
        }
    }
}
