//! The derivatives of a step on constraints.
//!
//! On N a step is (q0, p0) ↦ (q1, p1); it is extended to all of T*Q by the nearest state on N
//! ([`State::nearest`]), so that A is 2N×2N. With κ = (h/2)λ, the derivatives K of the momenta that the rule
//! has on a segment, and the constraints c(q0, q1) = 0 of the step,
//!
//! ```text
//! dp0 = (K00 − κ·∂²g(q0)) dq0 + K01 dq1 − G(q0)ᵀdκ        ∂c/∂q0 dq0 + ∂c/∂q1 dq1 = 0
//! dp1 = K10 dq0 + K11 dq1 + μ·∂²g(q1) dq1 + G(q1)ᵀdμ      dρ(q1, v(q1, p1)) = 0
//! ```
//!
//! An input or a parameter moves the momenta at fixed ends, and parameters the constraints as well: the
//! equations are those, with what they move beside.

use nalgebra::{SMatrix, SVector};

use super::Constraints;
use super::complement::Complement;
use super::independent::Independent;
use super::nearest::{AtPoint, dependence, tangent};
use super::rows::Rows;
use crate::numbers::{Scalar, linear::by_columns};
use crate::step::{
    BorderParameters, ClosedForm, Discrete, LegendreDerivatives, MomentaBy, PhaseMatrix, Segment, State,
    StateBy, StepError, invert,
};
use crate::system::{Constrained, ConstrainedParameters, Parameters, Quantity};

/// The share of M constraints in the equations on the segment of a step.
pub struct Linearized<S: Scalar, const N: usize, const M: usize> {
    /// ∂c/∂q0 and ∂c/∂q1.
    rows: [SMatrix<S, M, N>; 2],
    /// K01⁻¹ G(q0)ᵀ.
    answers: SMatrix<S, N, M>,
    /// ∂c/∂q1 K01⁻¹ G(q0)ᵀ.
    complement: Complement<S, M>,
    kappa: SVector<S, M>,
    /// κ·∂²g(q0) and μ·∂²g(q1).
    bent: [SMatrix<S, N, N>; 2],
    start: Held<S, N, M>,
    end: Held<S, N, M>,
}

/// Constraints at an end of the segment.
struct Held<S: Scalar, const N: usize, const M: usize> {
    at: AtPoint<S, N, M>,
    /// Where there are constraints of velocity, which do not hold q: without them.
    of_configuration: Option<AtPoint<S, N, M>>,
    v: SVector<S, N>,
    /// ∂²L/∂v∂q.
    momentum_by_q: SMatrix<S, N, N>,
    /// ∂/∂q of ρ(q, v(q, p)), at fixed p.
    rate_by_q: SMatrix<S, M, N>,
    /// μ, by which the momentum was moved.
    mu: SVector<S, M>,
}

/// K quantities that move a step beside its state: how they move momenta and constraints.
struct Moved<S, const N: usize, const M: usize, const K: usize> {
    momenta: MomentaBy<S, N, K>,
    /// c, and ρ less what v moves it by, at the end.
    constraints: SMatrix<S, M, K>,
    rates: SMatrix<S, M, K>,
}

impl<S: Scalar, const N: usize, const M: usize> Held<S, N, M> {
    /// At q, where the momentum `p` becomes the one on N.
    fn of<L: Constrained<N, M, Scalar = S>>(
        system: &L,
        q: SVector<S, N>,
        p: SVector<S, N>,
    ) -> Result<Self, StepError> {
        let on = tangent::<L, N, M>(system, &State { q, p })?;
        let v = on.velocity(system)?;
        let at = AtPoint::at(system, &q, &v)?;
        let mu = at.complement.solve(&(at.answers.transpose() * (on.p - p)));
        let momentum_by_q = system.lagrangian_derivatives(&q, &v).d12.transpose();
        let rate_by_q = system.constraint_rates(&q, &v).1 - at.answers.transpose() * momentum_by_q;
        let of_configuration =
            if L::OF_VELOCITY > 0 { Some(AtPoint::of_configuration(system, &q, &v)?) } else { None };
        Ok(Self { at, of_configuration, v, momentum_by_q, rate_by_q, mu })
    }

    /// The derivative of the momentum on N, from those of q, of the momentum before and of ρ.
    fn momentum<const K: usize>(
        &self,
        dq: &SMatrix<S, N, K>,
        dp: SMatrix<S, N, K>,
        rates: &SMatrix<S, M, K>,
    ) -> SMatrix<S, N, K> {
        let left = self.rate_by_q * dq + self.at.answers.transpose() * dp + rates;
        dp - self.at.gradients.transpose() * by_columns(&left, |left| self.at.complement.solve(left))
    }

    /// The derivative of the nearest state on N, where g and ρ move besides.
    fn nearest<const K: usize>(
        &self,
        from: &StateBy<S, N, K>,
        values: &SMatrix<S, M, K>,
        rates: &SMatrix<S, M, K>,
    ) -> StateBy<S, N, K> {
        let of = self.of_configuration.as_ref().unwrap_or(&self.at);
        let left = of.gradients * from.q + values;
        let moved = of.answers * by_columns(&left, |left| of.complement.solve(left));
        let q = from.q - moved;
        // v stays as it is.
        let p = self.momentum(&q, from.p - self.momentum_by_q * moved, rates);
        StateBy { q, p }
    }
}

impl<S: Scalar, const N: usize, const M: usize> Linearized<S, N, M> {
    pub(super) fn of<L, R>(
        system: &L,
        segment: &Segment<S, N>,
        k: &LegendreDerivatives<S, N>,
    ) -> Result<(SMatrix<S, N, N>, Self), StepError>
    where
        L: ClosedForm<R, N> + Discrete<R, N> + Constrained<N, M, Scalar = S>,
    {
        let free = invert(&k.p0_by_q1)?;
        let start = Held::of(system, segment.q0, k.momenta.p0)?;
        let end = system.later(segment.h, |system| Held::of(system, segment.end(), k.momenta.p1))?;
        let directions = start.at.gradients.transpose();
        let answers = free * directions;
        let rows = Rows::at_ends(system, segment);
        let independent = || Independent::of(&rows[1], &directions, &answers);
        let complement = Complement::of(&(rows[1] * answers), independent);
        let complement = complement.ok_or_else(|| dependence::<L, N, M>(system, &segment.q0))?;
        let by_p = by_columns(&free, |column| column - answers * complement.solve(&(rows[1] * column)));
        // p0 = P0 − Gᵀκ, and p0 = P0 + Gᵀμ.
        let kappa = -start.mu;
        let bent = [
            system.constraint_curvature(&segment.q0, &kappa),
            system.later(segment.h, |system| system.constraint_curvature(&segment.end(), &end.mu)),
        ];
        Ok((by_p, Self { rows, answers, complement, kappa, bent, start, end }))
    }

    /// The derivative of the end of the step, from that of a start on N.
    fn end<const K: usize>(
        &self,
        k: &LegendreDerivatives<S, N>,
        q_by_p: &SMatrix<S, N, N>,
        start: &StateBy<S, N, K>,
        moved: &Moved<S, N, M, K>,
    ) -> StateBy<S, N, K> {
        let MomentaBy { p0, p1 } = &moved.momenta;
        let left = start.p - p0 - (k.p0_by_q0 - self.bent[0]) * start.q;
        let off = self.rows[0] * start.q + moved.constraints;
        let q = q_by_p * left - self.answers * by_columns(&off, |off| self.complement.solve(off));
        let p1 = k.p1_by_q0 * start.q + (k.p1_by_q1 + self.bent[1]) * q + p1;
        let p = self.end.momentum(&q, p1, &moved.rates);
        StateBy { q, p }
    }

    pub(super) fn by_state(
        &self,
        k: &LegendreDerivatives<S, N>,
        q_by_p: &SMatrix<S, N, N>,
    ) -> Result<PhaseMatrix<S, N>, StepError> {
        let (one, zero, none) = (SMatrix::identity(), nalgebra::zero(), nalgebra::zero());
        let moved = Moved { momenta: MomentaBy { p0: zero, p1: zero }, constraints: none, rates: none };
        let [by_q, by_p] = [StateBy { q: one, p: zero }, StateBy { q: zero, p: one }].map(|from| {
            let start = self.start.nearest(&from, &none, &none);
            finite(self.end(k, q_by_p, &start, &moved))
        });
        let (by_q, by_p) = (by_q?, by_p?);
        Ok(PhaseMatrix { q_by_q: by_q.q, q_by_p: by_p.q, p_by_q: by_q.p, p_by_p: by_p.p })
    }

    pub(super) fn answer<const P: usize>(
        &self,
        k: &LegendreDerivatives<S, N>,
        q_by_p: &SMatrix<S, N, N>,
        momenta: &MomentaBy<S, N, P>,
    ) -> Result<StateBy<S, N, P>, StepError> {
        let start = StateBy { q: nalgebra::zero(), p: nalgebra::zero() };
        let moved = Moved { momenta: *momenta, constraints: nalgebra::zero(), rates: nalgebra::zero() };
        finite(self.end(k, q_by_p, &start, &moved))
    }
}

fn finite<S: Scalar, const N: usize, const P: usize>(
    by: StateBy<S, N, P>,
) -> Result<StateBy<S, N, P>, StepError> {
    StepError::require_finite(&by.q, Quantity::Derivatives)?;
    StepError::require_finite(&by.p, Quantity::Derivatives)?;
    Ok(by)
}

impl<L, R, const N: usize, const M: usize, const P: usize> BorderParameters<L, R, N, P> for Constraints<M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + ConstrainedParameters<N, M, P> + Parameters<N, P>,
{
    fn answer_parameters(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        at: &Linearized<L::Scalar, N, M>,
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        let by = |system: &L, q: &SVector<L::Scalar, N>, held: &Held<L::Scalar, N, M>, multipliers| {
            let mut by = system.constraints_by_parameters(q, &held.v, multipliers);
            let velocity = system.lagrangian_by_parameters(q, &held.v).d2;
            by.rates -= held.at.answers.transpose() * velocity;
            by
        };
        let first = by(system, &segment.q0, &at.start, &at.kappa);
        let last = system.later(segment.h, |system| by(system, &segment.end(), &at.end, &at.end.mu));
        let none = StateBy { q: nalgebra::zero(), p: nalgebra::zero() };
        // The share of the reaction in p0 belongs to the step, none to the momentum that is on N.
        let start = at.start.nearest(&none, &first.values, &first.rates);
        let constraints = Rows::by_parameters(system, segment, last.values);
        let momenta = MomentaBy { p0: momenta.p0 - first.reaction, p1: momenta.p1 + last.reaction };
        let moved = Moved { momenta, constraints, rates: last.rates };
        finite(at.end(k, q_by_p, &start, &moved))
    }
}
