use nalgebra::SVector;

use super::force_work::along_the_line;
use super::parts::Parts;
use super::{DisplacementRule, Midpoint};
use crate::numbers::Derivatives;
use crate::step::{
    BorderParameters, ClosedForm, DiscreteDriven, DiscreteForce, DiscreteForceDerivatives, DiscreteObjects,
    DiscreteParameters, EnergyExchange, ForceWork, Fused, LinearizedSegment, Momenta, Segment,
    SolvedForVelocity, State, StateBy, StepError,
};
use crate::system::{Driven, Parameters, SmoothRayleigh};

/// The midpoint rule with the kinks of R implicit at both ends of the step: dry friction that holds.
///
/// ```text
/// R = R_s + R_k,   R_k = Σₖ Fₖ(q) |uₖ(q, v)|,   u linear in v,   Fₖ ≥ 0
/// p0 ∈ −D1(L_d + R_d) − f_d⁻ + (h/2) ∂R_k(q̄, v̄)
/// w  = D2(L_d − R_d) + f_d⁺                     L_d, f_d and R_d = (h²/2) R_s(q̄, v̄) of the midpoint rule
/// w  ∈ ∂L/∂v(q1, v1) + (h/2) ∂R_k(q̄, v1)
/// p1 = ∂L/∂v(q1, v1)
/// ```
///
/// ```
/// use dalembert::{Discretise, Proximal, State, rayleigh_system};
///
/// struct Block;
///
/// #[rayleigh_system(rule = proximal)]
/// impl Block {
///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
///     }
///     fn rayleigh(&self, v: [f64; 1]) -> f64 {
///         0.2 * v[0].abs()
///     }
/// }
///
/// // It stops at 5.878, where the spring pulls by less than the friction holds.
/// let start = State::from_velocity(&Block, [0.9], [-0.3])?;
/// let mut run = Block.by(Proximal, 0.01).run(start);
/// let stopped = run.nth(599).unwrap()?.state;
/// assert!(stopped.p[0] == 0.0 && (stopped.q[0] - 0.161577310586).abs() < 1e-5);
/// assert_eq!(run.nth(9_999).unwrap()?.state, stopped);
/// # Ok::<(), dalembert::StepError>(())
/// ```
///
/// **What is a kink.** `abs`, `max`, `min`, `hypot` and `sqrt` of a sum of squares with positive factors, in
/// R, of what is linear in v; v times its sign, and `if v > 0.0` between two multiples of v; in front of it a
/// factor of fields, q and the time. |v|³ and v²|v| are none, since their force has no jump. Where |u| stands
/// in another function, as in μ|v| − A e^(−|v|/b) for friction that falls with the velocity, Fₖ is the force
/// at rest, and the rest of R counts as R_s.
///
/// **Derivation.** −∂R_k/∂v is a set where a slip u is 0: any force of size at most Fₖ along ∂u/∂v. Half of
/// its impulse goes to either momentum, as of every force by the midpoint rule. The first line is the least
/// of a convex function of v̄ where L = ½vᵀMv − V(q) and h is not too long, so that v̄ is one: with u = 0 as
/// long as the force that holds is within its limit. Then v̄, and with all slips 0 q1 = q0, have no error at
/// all. The second line is the Legendre transform at q1 with the friction in it: of the same kind, for v1. At
/// rest p1 is 0.
///
/// **While it slides** by constant directions both lines have the same force, and the step is that of the
/// midpoint rule with R_d = (h²/2) R, of order 2; in a run, where every |u| keeps its sign, it is solved as
/// one, at about its cost. Where it stops within a step, or a length turns, the step is of order 1: its
/// error is half that of a rule with all of the friction at one end. Across such a step there is no R_d in
/// general for two coordinates or more: checkers but for `dissipation` and `ledger` refuse kinks.
///
/// L_d and f_d, where they are asked for, are without the kinks: these hold the motion beside f_d, as
/// reactions of constraints do. Limits and slips are those at q̄ in both lines, so that F(q) does not take
/// from the order.
///
/// **Without mass.** Where L does not hold the velocity of a coordinate, p1 is 0. Where R_s or f does, the
/// other forces at the end balance friction in the second line. Where the kinks alone do, as at the end of a
/// spring on a Coulomb slider, the balance is that of the middle, and q1 the place, from q̄ on, at which
/// friction bears the forces of the end: the law of a spring and a slider in series to rounding, as long as
/// the stretch goes one way in each half step, and what has mass moves with order 2. Its velocity is 0 where
/// the force is within its limit; where it slides, that by which the force stays there.
///
/// Not self-adjoint. A, B and derivatives by parameters are those of what sticks and what slides; at the
/// limit of the two there is none ([`StepError::AtLimitOfFriction`]). When each element comes to stick and
/// begins to slip is told by [`stick_slip`](crate::Trajectory::stick_slip).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Proximal;

impl SolvedForVelocity for Proximal {
    const TAKES_MASSLESS: bool = true;
}

/// L_d and f_d of the midpoint rule, without the kinks: their forces hold the motion beside f_d, as reactions
/// of constraints do.
impl<L, const N: usize> ClosedForm<Proximal, N> for L
where
    L: Fused<Proximal, N> + SmoothRayleigh<N>,
{
    fn discrete_lagrangian(&self, segment: &Segment<L::Scalar, N>) -> L::Scalar {
        Midpoint::discrete_lagrangian(self, segment)
    }

    fn discrete_lagrangian_derivatives(&self, segment: &Segment<L::Scalar, N>) -> Derivatives<L::Scalar, N> {
        Midpoint::discrete_lagrangian_derivatives(self, segment)
    }

    fn discrete_force(&self, segment: &Segment<L::Scalar, N>) -> DiscreteForce<L::Scalar, N> {
        Midpoint::discrete_force(&Parts::smooth(self), segment)
    }

    fn discrete_force_derivatives(
        &self,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        Midpoint::discrete_force_derivatives(&Parts::smooth(self), segment)
    }

    fn segment_energy(&self, segment: &Segment<L::Scalar, N>) -> L::Scalar {
        Midpoint::segment_energy(self, segment)
    }

    fn at_nodes(
        &self,
        segment: &Segment<L::Scalar, N>,
        visit: &mut dyn FnMut(&Self, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        Midpoint::at_nodes(self, segment, visit);
    }
}

/// Friction takes v̄·(D s + D s1), with its impulses as the momenta tell them: none is asked for at a kink.
impl<L, const N: usize> ForceWork<Proximal, N> for L
where
    L: Fused<Proximal, N> + SmoothRayleigh<N>,
{
    fn energy_exchange(
        &self,
        from: &State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<EnergyExchange<L::Scalar>, StepError> {
        let segment = Segment { q0: from.q, v: (to.q - from.q) / h, h };
        let Momenta { p0, p1 } = self.momenta(&segment);
        let dissipated = segment.v.dot(&(from.p - p0 + p1 - to.p));
        let smooth = along_the_line::<Midpoint, _, N>(&Parts::smooth(self), from, to, h);
        Ok(smooth + EnergyExchange { dissipated, work: nalgebra::zero() })
    }
}

impl<L, const N: usize, const M: usize> DiscreteDriven<Proximal, N, M> for L
where
    L: Fused<Proximal, N> + SmoothRayleigh<N> + Driven<N, M>,
{
    fn by_input(at: &LinearizedSegment<'_, L, Proximal, N>) -> Result<StateBy<L::Scalar, N, M>, StepError> {
        let (system, segment) = (at.on.system, at.on.segment());
        let momenta = Midpoint::force_by_input(segment, system, L::force_by_input);
        at.answer_input(&momenta, |q, v| system.later(segment.h, |system| system.force_by_input(q, v)))
    }
}

impl<L, const N: usize, const P: usize> DiscreteParameters<Proximal, N, P> for L
where
    L: Fused<Proximal, N, Border: BorderParameters<L, Proximal, N, P>> + SmoothRayleigh<N> + Parameters<N, P>,
{
    fn by_parameters(
        at: &LinearizedSegment<'_, L, Proximal, N>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        let (system, segment) = (at.on.system, at.on.segment());
        let mut by = Midpoint::lagrangian_by_parameters(system, segment);
        if L::HAS_SMOOTH {
            by = by + Midpoint::rayleigh_by_parameters(system, segment);
        }
        if L::HAS_FORCE {
            by = by + Midpoint::force_by_parameters(system, segment);
        }
        at.answer_parameters(&by)
    }
}
