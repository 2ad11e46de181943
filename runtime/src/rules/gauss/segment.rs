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

use super::linearised::{Factored, Local, locals, non_finite};
use super::newton::Iterate;
use super::problem::{Compensated, Problem};
use super::rounding::{at_rounding, worst};
use super::tangent::{ByState, Source, Tangent};
use crate::numbers::{
    Derivatives, LaneVector, NewtonMatrix, Scalar, Singular, determinant_sign,
    lanes::{lane, splat},
};
use crate::step::{
    DiscreteForce, DiscreteForceDerivatives, LegendreDerivatives, Momenta, Quantity, StepError,
    newton::AT_FLOOR,
};
use crate::system::ForcedLagrangian;

/// Iterations of Newton's method for the interior points.
const MAX_ITERATIONS: u32 = 100;

/// A solved segment.
pub(super) struct Segment<'a, L: ForcedLagrangian<N>, const N: usize, const S: usize> {
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

impl<'a, T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize> Segment<'a, L, N, S> {
    /// The segment from q0 to q1, with its arguments looked at.
    pub(super) fn between(
        system: &'a L,
        q0: &SVector<T, N>,
        q1: &SVector<T, N>,
        h: T,
    ) -> Result<Self, StepError> {
        crate::step::require_step_size(h)?;
        StepError::require_finite(q0, Quantity::Configuration)?;
        StepError::require_finite(q1, Quantity::Configuration)?;
        Self::new(system, q0, &((q1 - q0) / h), h)
    }

    /// The segment from q0 with the mean velocity v̄, by Newton's method.
    pub(super) fn new(
        system: &'a L,
        q0: &SVector<T, N>,
        mean: &SVector<T, N>,
        h: T,
    ) -> Result<Self, StepError> {
        let one = T::one();
        let start = Compensated::new(*q0);
        let mut problem = Problem::new(system, start, Compensated::new(nalgebra::zero()), h);
        let guess = Iterate::new(&problem, splat(mean));
        // p0 such that the residuals, here ∂L/∂v − h Σ a_ij G_j, have the mean 0.
        problem.p0.value = problem.sum(&guess.residual) / h;
        let mut last = Iterate::new(&problem, guess.v);
        for iteration in 0..MAX_ITERATIONS {
            if let Some(index) = last.non_finite() {
                return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
            }
            let singular =
                |singular: Singular| StepError::SingularNewtonMatrix { iteration, column: singular.column };
            let factored = Factored::new(&problem, &last.locals).map_err(singular)?;
            let y = factored.solve(&last.residuals());
            let x = factored.solve(&[SMatrix::<T, N, N>::identity(); S]);
            let of_y = y.iter().zip(&problem.steps).fold(SVector::zeros(), |sum, (y, &step)| sum + y * step);
            let of_x = x.iter().zip(&problem.steps).fold(SMatrix::zeros(), |sum, (x, &step)| sum + x * step);
            let dp = -of_x.solve(&of_y).map_err(singular)?;
            let p0 = problem.p0.value;
            let mut share = one;
            let next = loop {
                let mut v = last.v;
                for i in 0..S {
                    let change = (y[i] + x[i] * dp) * share;
                    for a in 0..N {
                        v[a].0[i] -= change[a];
                    }
                }
                problem.p0.value = p0 - dp * share;
                let next = Iterate::new(&problem, v);
                let size = next.size_in(&last.floor);
                let is_lower = size < last.size;
                if is_lower || next.size <= one || (share == one && is_solved(&problem, &last)) {
                    break Some((next, is_lower, size / last.size));
                }
                share = crate::step::newton::shorter(share, last.size, size);
                if share < T::EPSILON.sqrt() {
                    break None;
                }
            };
            let Some((next, is_lower, contraction)) = next else {
                let residual = worst(&last.residual, &last.floor).0.widen();
                return Err(StepError::NoRealSolution { iteration, residual });
            };
            let has_stopped = !is_lower || contraction > T::constant(0.1);
            let is_done = share == one && has_stopped && is_solved(&problem, &next);
            if !is_lower {
                problem.p0.value = p0;
            } else {
                last = next;
            }
            if is_done || last.size == T::zero() {
                let factored = Factored::new(&problem, &last.locals).map_err(singular)?;
                return Ok(Self { problem, v: last.v, locals: last.locals, factored });
            }
        }
        let (residual, floor) = worst(&last.residual, &last.floor);
        Err(StepError::NotConverged {
            iterations: MAX_ITERATIONS,
            residual: residual.widen(),
            floor: floor.widen(),
        })
    }

    /// The step whose stages have the velocities `v`.
    pub(super) fn of_stages(
        problem: Problem<'a, L, N, S>,
        v: LaneVector<T, N, S>,
    ) -> Result<Self, StepError> {
        let locals = locals(&problem, &v);
        if let Some(index) = non_finite(&locals) {
            return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
        }
        let factored = Factored::new(&problem, &locals)
            .map_err(|singular| StepError::SingularNewtonMatrix { iteration: 0, column: singular.column })?;
        Ok(Self { problem, v, locals, factored })
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
    /// det Mᵢ.
    pub(super) fn is_on_the_branch_of_the_flow(&self) -> bool {
        let mut for_small_h = true;
        for local in &self.locals {
            match determinant_sign(local.mass) {
                Ordering::Equal => return false,
                sign => for_small_h ^= sign.is_lt(),
            }
        }
        self.factored.has_positive_determinant() == for_small_h
    }

    /// p0 and p1.
    pub(super) fn momenta(&self) -> Momenta<T, N> {
        let p0 = self.problem.p0.value;
        let change = self.weighted(|local| local.rate());
        Momenta { p0, p1: p0 + change }
    }

    /// h Σ b_i of a vector at each stage.
    fn weighted(&self, of: impl Fn(&Local<T, N>) -> SVector<T, N>) -> SVector<T, N> {
        let stages = self.locals.iter().zip(&self.problem.steps);
        stages.fold(SVector::zeros(), |sum, (local, &step)| sum + of(local) * step)
    }

    /// L_d = h Σ b_i L.
    pub(super) fn lagrangian(&self) -> T {
        let stages = self.locals.iter().zip(&self.problem.steps);
        stages.fold(nalgebra::zero(), |sum: T, (local, &step)| sum + local.lagrangian * step)
    }

    /// Σ b_i E_L.
    pub(super) fn energy(&self) -> T {
        let sum = (0..S).fold(nalgebra::zero(), |sum: T, i| {
            let local = &self.locals[i];
            sum + (lane(&self.v, i).dot(&local.momentum) - local.lagrangian) * self.problem.steps[i]
        });
        sum / self.problem.h
    }

    /// How all stages and momenta follow q0 and q1.
    pub(super) fn variations(&self) -> Result<Variations<T, N, S>, StepError> {
        let by = self.by_state()?;
        let p0_by_q1 = crate::step::invert(&by.p.end.q)?;
        let p0_by_q0 = -(p0_by_q1 * by.q.end.q);
        let (minus, plus) = (by.p.carried(&p0_by_q0, Some(&by.q)), by.p.carried(&p0_by_q1, None));
        Ok(Variations { minus, plus, p0_by_q0, p0_by_q1 })
    }

    /// Both momenta with their derivatives by q0 and q1.
    pub(super) fn legendre(&self) -> Result<LegendreDerivatives<T, N>, StepError> {
        let Variations { minus, plus, p0_by_q0, p0_by_q1 } = self.variations()?;
        let (p1_by_q0, p1_by_q1) = (minus.end.p, plus.end.p);
        Ok(LegendreDerivatives { momenta: self.momenta(), p0_by_q0, p0_by_q1, p1_by_q0, p1_by_q1 })
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

    /// L_d with its derivatives, given those of f_d.
    pub(super) fn lagrangian_derivatives(
        &self,
        variations: &Variations<T, N, S>,
        force: &DiscreteForceDerivatives<T, N>,
    ) -> Derivatives<T, N> {
        Derivatives {
            value: self.lagrangian(),
            d1: self.slope(&variations.minus),
            d2: self.slope(&variations.plus),
            d11: -variations.p0_by_q0 - force.minus.d1,
            d12: -variations.p0_by_q1 - force.minus.d2,
            d22: variations.plus.end.p - force.plus.d2,
        }
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
