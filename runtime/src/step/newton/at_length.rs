//! The equation of a step as it is solved at length, with neither the number of coordinates nor the form of
//! the matrix in its type ([`nonlinear`](crate::numbers::nonlinear)).

use nalgebra::{SMatrix, SVector};

use super::Solution;
use crate::numbers::{
    NewtonMatrix, Scalar, Singular,
    nonlinear::{Equations, Evaluate, Matrix, Room, Root, Solved, Unsolved, VECTORS, Way},
    slices::{vector, write},
};
#[cfg(feature = "std")]
use crate::step::cause::explained;
use crate::step::{Momenta, Report, State, StepError, StepKernel};
use crate::system::Quantity;

/// A function of (q, v̄, h).
type OfStep<'f, S, const N: usize, T> = dyn Fn(&SVector<S, N>, &SVector<S, N>, S) -> T + 'f;

/// The mass matrix as a function of (q, v).
type Inertia<'f, S, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>) -> SMatrix<S, N, N> + 'f;

/// The equation of a step as functions of (q, v̄, h), of which `inertia` does not depend on h; behind
/// pointers, so that systems of one size share what asks them.
pub(crate) struct StepEquations<'f, S, M, const N: usize> {
    pub(crate) kernel: &'f OfStep<'f, S, N, StepKernel<S, N, M>>,
    pub(crate) momenta: &'f OfStep<'f, S, N, Momenta<S, N>>,
    pub(crate) inertia: &'f Inertia<'f, S, N>,
    pub(crate) cancelling: &'f OfStep<'f, S, N, SVector<S, N>>,
    /// The cause of numbers that are not finite, where it is known.
    #[cfg(feature = "std")]
    pub(crate) cause: &'f OfStep<'f, S, N, Option<StepError>>,
    pub(crate) state: &'f State<S, N>,
    pub(crate) h: S,
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> StepEquations<'_, S, M, N> {
    /// The solution by this way, from the velocity `v`.
    ///
    /// # Errors
    /// Those of [`at_length`](crate::numbers::nonlinear::AtLength::at_length).
    #[cold]
    #[inline(never)]
    pub(crate) fn solved(&self, way: Way<'_, S>, v: &SVector<S, N>) -> Result<Solution<S, N>, StepError> {
        let mut buffer = room::<S, N>();
        let mut evaluate = Evaluations {
            of: self,
            present: M::zero(),
            before: M::zero(),
            #[cfg(feature = "std")]
            lost: None,
        };
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
            Err(error) => {
                let error = StepError::from(error);
                #[cfg(feature = "std")]
                let error = explained(error, &|| {
                    let (v, h) = evaluate.lost?;
                    (self.cause)(&self.state.q, &v, h)
                });
                return Err(error);
            }
        }
        Ok(solution)
    }
}

/// Room for the vectors of the solver.
pub(super) fn room<S: Scalar, const N: usize>() -> [[S; N]; VECTORS] {
    [[S::zero(); N]; VECTORS]
}

/// A [`StepEquations`] with the matrices that were evaluated last.
struct Evaluations<'f, 'e, S, M, const N: usize> {
    of: &'e StepEquations<'f, S, M, N>,
    present: M,
    before: M,
    /// v̄ and h where a derivative was last no finite number.
    #[cfg(feature = "std")]
    lost: Option<(SVector<S, N>, S)>,
}

/// Writes |Aᵢᵢ| for each i.
fn write_sizes<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(entries: &mut [S], matrix: &M) {
    for (i, entry) in entries.iter_mut().enumerate() {
        *entry = matrix.entry(i, i).abs();
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Evaluate<S> for Evaluations<'_, '_, S, M, N> {
    fn kernel(&mut self, q: &[S], v: &[S], h: S, held: &[S], p0: &mut [S]) {
        let kernel = (self.of.kernel)(&vector(q), &vector(v), h);
        self.present = kernel.matrix;
        #[cfg(feature = "std")]
        for i in 0..N {
            if !kernel.p0[i].is_finite() || !kernel.matrix.row_is_finite(i) {
                self.lost = Some((vector(v), h));
            }
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
            Matrix::Mass { q, v: at } => (self.of.inertia)(&vector(q), &vector(at)).magnitudes(&v),
        };
        write(sums, &found);
    }

    fn diagonal(&self, of: Matrix<'_, S>, entries: &mut [S]) {
        if let Matrix::Mass { q, v } = of {
            let mass = (self.of.inertia)(&vector(q), &vector(v));
            write_sizes(entries, &mass);
        } else {
            write_sizes(entries, if matches!(of, Matrix::Before) { &self.before } else { &self.present });
        }
    }

    fn row_is_finite(&self, row: usize) -> bool {
        self.present.row_is_finite(row)
    }

    fn momenta(&self, q: &[S], v: &[S], h: S, p0: &mut [S], p1: &mut [S]) {
        let momenta = (self.of.momenta)(&vector(q), &vector(v), h);
        write(p0, &momenta.p0);
        write(p1, &momenta.p1);
    }

    fn cancelling(&self, q: &[S], v: &[S], h: S, terms: &mut [S]) {
        write(terms, &(self.of.cancelling)(&vector(q), &vector(v), h));
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
