//! The discrete objects on a segment (q0, q1), its interior points eliminated by the forced equations.
//!
//! The stages and p0 solve the equations of a step with Σ b_i V_i = v̄ for the configuration at the end. The
//! derivatives of a step (`tangent.rs`), with q1 returned to its place by p0, are those of a segment: the
//! total variations of all Q_i and V_i.
//!
//! ```text
//! K01 = ∂p0/∂q1 = (∂q1/∂p0)⁻¹,   K00 = ∂p0/∂q0 = −K01 ∂q1/∂q0
//! D L_d = h Σ b_i (∂L/∂q·DQ_i + ∂L/∂v·DV_i),   f_d = h Σ b_i f_L·DQ_i,   p0 = −D1 L_d − f_d⁻,   p1 = D2 L_d + f_d⁺
//! ```

use core::cmp::Ordering;

use nalgebra::{SMatrix, SVector};

use super::linearised::{Factored, Local, StageVector, locals, non_finite};
use super::newton::Iterate;
use super::problem::Problem;
use super::rounding::{at_rounding, worst};
use super::tangent::{ByState, Source, Tangent};
use crate::numbers::{
    Compensated, LaneVector, NewtonMatrix, Scalar, Singular, determinant_sign,
    lanes::{lane, splat},
};
use crate::step::{DiscreteForce, Segment, StepError, massless::inertia, newton::AT_FLOOR};
use crate::system::ForcedLagrangian;

/// Iterations of Newton's method for the interior points.
const MAX_ITERATIONS: u32 = 100;

/// A solved segment.
pub struct SolvedSegment<'a, L: ForcedLagrangian<N>, const N: usize, const S: usize> {
    pub(super) segment: Segment<L::Scalar, N>,
    pub(super) problem: Problem<'a, L, N, S>,
    pub(super) v: LaneVector<L::Scalar, N, S>,
    pub(super) locals: [Local<L::Scalar, N>; S],
    pub(super) factored: Factored<L::Scalar, N, S>,
}

/// The total derivatives of a segment by q0 and q1.
pub(super) struct Variations<T, const N: usize, const S: usize> {
    /// By q0, at fixed q1.
    pub(super) minus: Tangent<T, N, S, N>,
    /// By q1, at fixed q0.
    pub(super) plus: Tangent<T, N, S, N>,
    pub(super) p0_by_q0: SMatrix<T, N, N>,
    pub(super) p0_by_q1: SMatrix<T, N, N>,
}

impl<'a, T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>
    SolvedSegment<'a, L, N, S>
{
    /// The stages of a segment, by Newton's method.
    pub(super) fn new(system: &'a L, segment: &Segment<T, N>) -> Result<Self, StepError> {
        let Segment { q0, v: mean, h } = segment;
        let one = T::one();
        let start = Compensated::new(*q0);
        let mut problem = Problem::new(system, start, Compensated::new(nalgebra::zero()), *h);
        let guess = Iterate::new(&problem, splat(mean));
        // p0 such that the residuals, here ∂L/∂v − h Σ a_ij G_j, have the mean 0.
        problem.p0.value = problem.sum(&guess.residual) / *h;
        let mut last = Iterate::new(&problem, guess.v);
        let mut is_damped = false;
        for iteration in 0..MAX_ITERATIONS {
            if let Some(index) = last.non_finite() {
                return Err(problem.not_finite(index, &last.v));
            }
            let singular =
                |singular: Singular| StepError::SingularNewtonMatrix { iteration, column: singular.column };
            let residual = worst(&last.residual, &last.floor).0.widen();
            let none = StepError::NoRealSolution { iteration, residual };
            let correction = Correction::of(&problem, &last)
                .map_err(|found| if is_damped { none } else { singular(found) })?;
            let p0 = problem.p0.value;
            let mut share = one;
            let next = loop {
                problem.p0.value = p0 - correction.p0 * share;
                let next = Iterate::new(&problem, correction.taken_from(&last.v, share));
                // A coordinate that starts to move only now has no floor to speak of before.
                let floor = last.floor.sup(&next.floor);
                let (size, before) = (next.size_in(&floor), last.size_in(&floor));
                if size < before || next.size <= one {
                    break Some((next, size / before));
                }
                if share == one && size.is_finite() {
                    let is_at_floor = last.size <= T::constant(AT_FLOOR);
                    if !is_at_floor && correction.leads_nearer(&problem, &next, &last) {
                        break Some((next, one));
                    }
                    problem.p0.value = p0;
                    if is_solved(&problem, &last) {
                        return Self::at(segment, problem, last).map_err(singular);
                    }
                }
                share = crate::step::newton::shorter(share, before, size);
                if share < T::EPSILON.sqrt() {
                    break None;
                }
            };
            let Some((next, contraction)) = next else { return Err(none) };
            is_damped |= share < one;
            let has_stopped = share == one && (contraction > T::constant(0.1) || next.size == T::zero());
            last = next;
            if has_stopped && is_solved(&problem, &last) {
                return Self::at(segment, problem, last).map_err(singular);
            }
        }
        let (residual, floor) = worst(&last.residual, &last.floor);
        Err(StepError::NotConverged {
            iterations: MAX_ITERATIONS,
            residual: residual.widen(),
            floor: floor.widen(),
        })
    }

    /// The segment whose stages are those of an iterate.
    fn at(
        segment: &Segment<T, N>,
        problem: Problem<'a, L, N, S>,
        Iterate { v, locals, .. }: Iterate<T, N, S>,
    ) -> Result<Self, Singular> {
        let factored = Factored::new(&problem, &locals)?;
        Ok(Self { segment: *segment, problem, v, locals, factored })
    }

    /// The step whose stages have the velocities `v`.
    pub(super) fn of_stages(
        problem: Problem<'a, L, N, S>,
        v: LaneVector<T, N, S>,
    ) -> Result<Self, StepError> {
        let locals = locals(&problem, &v);
        if let Some(index) = non_finite(&locals) {
            return Err(problem.not_finite(index, &v));
        }
        let factored = Factored::new(&problem, &locals)
            .map_err(|singular| StepError::SingularNewtonMatrix { iteration: 0, column: singular.column })?;
        let segment = Segment { q0: problem.q0.value, v: problem.sum(&v) / problem.h, h: problem.h };
        Ok(Self { segment, problem, v, locals, factored })
    }

    /// How the step follows what `source` moves.
    pub(super) fn tangent<const K: usize>(
        &self,
        source: &Source<T, N, S, K>,
    ) -> Result<Tangent<T, N, S, K>, StepError> {
        source.tangent(&self.problem, &self.locals, &self.factored)
    }

    /// How the step follows q0 and p0.
    pub(super) fn by_state(&self) -> Result<ByState<T, N, S>, StepError> {
        let by_q = Source { q0: SMatrix::identity(), ..Source::none() };
        let by_p = Source { p0: SMatrix::identity(), ..Source::none() };
        Ok(ByState { q: self.tangent(&by_q)?, p: self.tangent(&by_p)? })
    }

    /// Whether the determinant of the stages' equations has the sign that it has for small h, where it is Π
    /// det Mᵢ, with friction for the mass of coordinates that have none.
    pub(super) fn is_on_the_branch_of_the_flow(&self) -> bool {
        let q = self.problem.configurations(&self.v);
        let mut for_small_h = true;
        for i in 0..S {
            let Problem { system, h, .. } = self.problem;
            let at = |system: &L| inertia(system, &lane(&q, i), &lane(&self.v, i), h);
            match determinant_sign(system.later(self.problem.elapsed(i), at)) {
                Ordering::Equal => return false,
                sign => for_small_h ^= sign.is_lt(),
            }
        }
        self.factored.has_positive_determinant() == for_small_h
    }

    /// h Σ b_i of a vector at each stage.
    pub(super) fn weighted(&self, of: impl Fn(&Local<T, N>) -> SVector<T, N>) -> SVector<T, N> {
        let stages = self.locals.iter().zip(&self.problem.steps);
        stages.fold(SVector::zeros(), |sum, (local, &step)| sum + of(local) * step)
    }

    /// How all stages and momenta follow q0 and q1.
    pub(super) fn variations(&self) -> Result<Variations<T, N, S>, StepError> {
        let by = self.by_state()?;
        let p0_by_q1 = crate::step::invert(&by.p.end.q)?;
        let p0_by_q0 = -(p0_by_q1 * by.q.end.q);
        let (minus, plus) = (by.p.carried(&p0_by_q0, Some(&by.q)), by.p.carried(&p0_by_q1, None));
        Ok(Variations { minus, plus, p0_by_q0, p0_by_q1 })
    }

    /// h Σ b_i (∂L/∂q·DQ_i + ∂L/∂v·DV_i).
    pub(super) fn slope(&self, by: &Tangent<T, N, S, N>) -> SVector<T, N> {
        (0..S).fold(SVector::zeros(), |sum, i| {
            let local = &self.locals[i];
            sum + (by.q[i].tr_mul(&local.slope) + by.v[i].tr_mul(&local.momentum)) * self.problem.steps[i]
        })
    }

    /// f_d.
    pub(super) fn force(&self, variations: &Variations<T, N, S>) -> DiscreteForce<T, N> {
        let along = |by: &Tangent<T, N, S, N>| {
            (0..S).fold(SVector::zeros(), |sum, i| {
                sum + by.q[i].tr_mul(&self.locals[i].force) * self.problem.steps[i]
            })
        };
        DiscreteForce { minus: along(&variations.minus), plus: along(&variations.plus) }
    }
}

/// Newton's step for the stages and p0, along which Σ b_i V_i stays: it is v̄ from the guess on.
struct Correction<T, const N: usize, const S: usize> {
    stages: StageVector<T, N, S>,
    p0: SVector<T, N>,
}

impl<T: Scalar, const N: usize, const S: usize> Correction<T, N, S> {
    fn of<L: ForcedLagrangian<N, Scalar = T>>(
        problem: &Problem<'_, L, N, S>,
        at: &Iterate<T, N, S>,
    ) -> Result<Self, Singular> {
        let factored = Factored::new(problem, &at.locals)?;
        let y = factored.solve(&at.residuals());
        let x = factored.solve(&[SMatrix::<T, N, N>::identity(); S]);
        let of_y = y.iter().zip(&problem.steps).fold(SVector::zeros(), |sum, (y, &step)| sum + y * step);
        let of_x = SMatrix::<T, N, N>::from_fn(|a, b| {
            let terms = x.iter().zip(&problem.steps).map(|(x, &step)| x[(a, b)] * step);
            let (sum, size) = terms.fold((T::zero(), T::zero()), |(sum, size), x| (sum + x, size + x.abs()));
            // What rounding leaves of a sum is none: q0 and q1 are conjugate, and p0 is not told by them.
            if sum.abs() > size * T::constant(4.0 * S as f64) * T::EPSILON { sum } else { T::zero() }
        });
        let p0 = -of_x.solve(&of_y)?;
        Ok(Self { stages: core::array::from_fn(|i| y[i] + x[i] * p0), p0 })
    }

    /// The velocities after this share of it.
    fn taken_from(&self, v: &LaneVector<T, N, S>, share: T) -> LaneVector<T, N, S> {
        let mut next = *v;
        for (i, change) in self.stages.iter().enumerate() {
            for a in 0..N {
                next[a].0[i] -= change[a] * share;
            }
        }
        next
    }

    /// Whether `next`, where the residual is no lower, is nearer to the root than `last` all the same.
    #[cold]
    fn leads_nearer<L: ForcedLagrangian<N, Scalar = T>>(
        &self,
        problem: &Problem<'_, L, N, S>,
        next: &Iterate<T, N, S>,
        last: &Iterate<T, N, S>,
    ) -> bool {
        !next.has_grown(problem, last)
            && Self::of(problem, next).is_ok_and(|after| last.is_half_as_long(&after.stages, &self.stages))
    }
}

/// Whether the residual of `at` is at its floor, estimated or measured.
#[cold]
fn is_solved<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    at: &Iterate<T, N, S>,
) -> bool {
    at.size <= T::constant(AT_FLOOR) || at_rounding(problem, &at.v, &at.residual, at.floor).is_some()
}
