mod both_ends;
mod end;

use nalgebra::SVector;

use super::closed_form::closed_form;
use super::force_work::along_the_line;
use super::parts::Parts;
use super::{DisplacementRule, JointRule, Midpoint};
use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::step::{
    ClosedForm, Discrete, DiscreteDriven, DiscreteForce, DiscreteForceDerivatives, DiscreteObjects,
    DiscreteParameters, EnergyExchange, ForceWork, Fused, LinearizedSegment, Momenta, MomentaBy, Segment,
    SolvedForVelocity, State, StateBy, StepError, StepKernel,
};
use crate::system::{ActingForce, Driven, Parameters, Rayleigh};
pub use both_ends::BothEnds;
use end::{End, LinearizedEnd};

/// The midpoint rule with the damping implicit at both ends of the step: L-stable in the damping for every
/// convex R, of order 1.
///
/// ```text
/// p0 = −D1 L_d − f_d⁻ + (h/2) ∂R/∂v(q̄, v̄)      L_d and f_d of the midpoint rule, f_d without R
/// w  = D2 L_d + f_d⁺
/// w  = ∂L/∂v(q1, v1) + (h/2) ∂R/∂v(q̄, v1)
/// p1 = ∂L/∂v(q1, v1)
/// ```
///
/// **Derivation.** A step of the midpoint rule is a push by half of the forces, a drift, and a push by the
/// other half. Here either half of the damping is implicit in the velocity behind it, v̄ and v1, as in
/// [`Proximal`](crate::Proximal), with the same q̄ in both lines: that rule takes the kinks of R so, this one
/// all of R. The third line is the Legendre transform at q1 of L + (h/2) R, which is convex in v with R, so
/// that v1 is one where L = ½vᵀMv − V(q).
///
/// A damped free mass slows down by 1/(1 + hr/2m)² a step. Where damping and forces are in balance, p is what
/// the balance says, at any h: a mass with drag r under a force F has p1 → mF/r as hr/m grows, from any
/// start. Stiff springs it follows as the midpoint rule does.
///
/// **f_d.** Half of the damping is in f_d⁻, half in f_d⁺, which is solved for: p1 = D2 L_d + f_d⁺ as of every
/// rule. For two coordinates or more there is in general no R_d, for any L_d: p1 has a factor
/// M (M + (h/2) ∂²R/∂v²)⁻¹ that p0 has not, M = ∂²L/∂v². What friction takes is told by v̄ and v1,
/// (h/2) (v̄·∂R/∂v(q̄, v̄) + v1·∂R/∂v(q̄, v1)), never less than 0 for a convex R that is least at rest.
///
/// Not self-adjoint: for stiff damping alone, where [`Fitted`](crate::Fitted) does not take it. R is to be
/// convex in v, which nothing checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OneSided;

impl SolvedForVelocity for OneSided {
    const TAKES_MASSLESS: bool = true;
}

/// (h/2) ∂R/∂v(q̄, v).
fn half_drag<L: Rayleigh<N>, const N: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> SVector<L::Scalar, N> {
    let half = L::Scalar::constant(0.5);
    let middle = segment.at(half);
    system.later(segment.h * half, |system| system.rayleigh_gradient(&middle, v)).d2 * (segment.h * half)
}

/// p0, and w in place of p1.
fn without_end<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
) -> Momenta<L::Scalar, N> {
    let mut momenta = Midpoint::lagrangian_momenta(system, segment);
    if L::HAS_FORCE {
        momenta = momenta + Midpoint::force_momenta(&Parts::of(system), segment);
    }
    momenta.p0 += half_drag(system, segment, &segment.v);
    momenta
}

/// p1, no number where the end has no velocity.
fn momentum_at_end<L: Rayleigh<N>, const N: usize>(
    end: &End<'_, L, N>,
    w: &SVector<L::Scalar, N>,
) -> SVector<L::Scalar, N> {
    let v1 = end.velocity(w);
    v1.map_or_else(|_| SVector::repeat(L::Scalar::constant(f64::NAN)), |v1| end.momentum(&v1))
}

impl JointRule for OneSided {
    #[inline]
    fn discrete_lagrangian<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        Midpoint::discrete_lagrangian(system, segment)
    }

    #[inline]
    fn discrete_lagrangian_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        Midpoint::discrete_lagrangian_derivatives(system, segment)
    }

    fn discrete_force<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N> {
        let w = without_end(system, segment).p1;
        let mut force = DiscreteForce::zero();
        if L::HAS_FORCE {
            force = Midpoint::general_force(&Parts::of(system), segment);
        }
        let end = End::of(system, segment);
        force.minus -= half_drag(system, segment, &segment.v);
        force.plus += momentum_at_end(&end, &w) - w;
        force
    }

    fn discrete_force_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        let half = L::Scalar::constant(0.5);
        let mut force = DiscreteForceDerivatives::zero();
        if L::HAS_FORCE {
            force = Midpoint::general_force_derivatives(&Parts::of(system), segment);
        }
        let l = Midpoint::discrete_lagrangian_derivatives(system, segment);
        let middle = segment.at(half);
        let drag = system.later(segment.h * half, |system| system.rayleigh_derivatives(&middle, &segment.v))
            * (segment.h * half);
        let by_v = drag.d22 / segment.h;
        let by_q = drag.d12.transpose() * half;
        let w = l.d2 + force.plus.value;
        let (w_by_q0, w_by_q1) = (l.d12.transpose() + force.plus.d1, l.d22 + force.plus.d2);
        force.minus =
            force.minus + CovectorDerivatives { value: -drag.d2, d1: by_v - by_q, d2: -by_v - by_q };
        let end = End::of(system, segment);
        let linearized = end.velocity(&w).and_then(|v1| Ok((end.linearized(&v1)?, end.momentum(&v1))));
        let plus = linearized.map(|(linearized, p1)| CovectorDerivatives {
            value: p1 - w,
            d1: linearized.momentum_by_q0(&w_by_q0) - w_by_q0,
            d2: linearized.momentum_by_q1(&w_by_q1) - w_by_q1,
        });
        let unknown = || CovectorDerivatives::zero() * L::Scalar::constant(f64::NAN);
        force.plus = force.plus + plus.unwrap_or_else(|_| unknown());
        force
    }

    #[inline]
    fn step_kernel<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N> {
        let half = L::Scalar::constant(0.5);
        let (middle, half) = (segment.at(half), segment.h * half);
        let r = system.later(half, |system| system.rayleigh_derivatives(&middle, &segment.v));
        let drag = StepKernel { p0: r.d2, matrix: r.d12.transpose() * half + r.d22 };
        let mut kernel = Midpoint::lagrangian_kernel(system, segment) + drag * half;
        if L::HAS_FORCE {
            kernel = kernel + Midpoint::force_kernel(&Parts::of(system), segment);
        }
        kernel
    }

    fn momenta<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N> {
        let Momenta { p0, p1: w } = without_end(system, segment);
        Momenta { p0, p1: momentum_at_end(&End::of(system, segment), &w) }
    }

    #[cold]
    fn cancelling_terms<L: ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        Midpoint::cancelling_terms(system, segment)
    }

    #[inline]
    fn segment_energy<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        Midpoint::segment_energy(system, segment)
    }
}

closed_form!([] OneSided, JointRule, Rayleigh);

/// Friction takes (h/2) (v̄·∂R/∂v(q̄, v̄) + v1·∂R/∂v(q̄, v1)); what f brings is told by the middle.
impl<L, const N: usize> ForceWork<OneSided, N> for L
where
    L: Fused<OneSided, N> + Rayleigh<N>,
{
    fn energy_exchange(
        &self,
        from: &State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<EnergyExchange<L::Scalar>, StepError> {
        let segment = Segment { q0: from.q, v: (to.q - from.q) / h, h };
        let v1 = self.later(h, |system| to.velocity(system))?;
        let taken = |v: &SVector<L::Scalar, N>| v.dot(&half_drag(self, &segment, v));
        let dissipated = taken(&segment.v) + taken(&v1);
        let work = along_the_line::<Midpoint, _, N>(self, from, to, h).work;
        Ok(EnergyExchange { dissipated, work })
    }
}

/// The end of the segment of a step, at its solution.
fn end_of<L, const N: usize>(
    at: &LinearizedSegment<'_, L, OneSided, N>,
) -> Result<LinearizedEnd<L::Scalar, N>, StepError>
where
    L: ClosedForm<OneSided, N> + Discrete<OneSided, N> + Rayleigh<N> + ActingForce<N>,
{
    let (system, segment) = (at.on.system, at.on.segment());
    let end = End::of(system, segment);
    let v1 = end.velocity(&without_end(system, segment).p1)?;
    end.linearized(&v1)
}

/// The input moves w, and p1 with it.
impl<L, const N: usize, const M: usize> DiscreteDriven<OneSided, N, M> for L
where
    L: Fused<OneSided, N> + Rayleigh<N> + Driven<N, M>,
{
    fn by_input(at: &LinearizedSegment<'_, L, OneSided, N>) -> Result<StateBy<L::Scalar, N, M>, StepError> {
        let MomentaBy { p0, p1: w } =
            Midpoint::force_by_input(at.on.segment(), at.on.system, L::force_by_input);
        let still = nalgebra::zero();
        let p1 = end_of(at)?.momentum_by(&w, &still, &still);
        at.answer(&MomentaBy { p0, p1 })
    }
}

impl<L, const N: usize, const P: usize> DiscreteParameters<OneSided, N, P> for L
where
    L: Fused<OneSided, N> + Rayleigh<N> + Parameters<N, P>,
{
    fn by_parameters(
        at: &LinearizedSegment<'_, L, OneSided, N>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        let (system, segment) = (at.on.system, at.on.segment());
        let (h, half) = (segment.h, segment.h * L::Scalar::constant(0.5));
        let mut by = Midpoint::lagrangian_by_parameters(system, segment);
        if L::HAS_FORCE {
            by = by + Midpoint::force_by_parameters(system, segment);
        }
        let middle = segment.at(L::Scalar::constant(0.5));
        let drag = |v: &SVector<L::Scalar, N>| {
            system.later(half, |system| system.rayleigh_by_parameters(&middle, v)).d2 * half
        };
        let end = end_of(at)?;
        let q1 = segment.q0 + segment.v * h;
        let momentum = system.later(h, |system| system.lagrangian_by_parameters(&q1, &end.velocity)).d2;
        let p1 = end.momentum_by(&by.p1, &momentum, &drag(&end.velocity));
        at.answer(&MomentaBy { p0: by.p0 + drag(&segment.v), p1 })
    }
}
