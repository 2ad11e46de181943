use nalgebra::SVector;

use super::closed_form::{closed_form, discrete_rayleigh};
use super::damped_drift::{ByDrift, DampedDrift};
use super::force_work::taken_by_drift;
use super::{DisplacementRule, JointRayleighRule, JointRule, SelfAdjoint, Trapezoidal};
use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::step::{
    DiscreteForce, DiscreteForceDerivatives, EnergyExchange, Flow, ForceWork, Momenta, Segment, State,
    StepError, StepKernel, equation::Equation,
};
use crate::system::{ActingForce, Rayleigh};

/// The trapezoidal rule, exponentially fitted to linear damping: explicit, and exact where there is no
/// potential.
///
/// For L = ½vᵀMv − V(q) and R = ½vᵀCv with constant M, positive definite, and C. With d = q1 − q0 and Z =
/// ½hM⁻¹C:
///
/// ```text
/// L_d = (1/2h) dᵀ M Z coth(Z) d − (h/2)[V(q0) + V(q1)],   R_d = ¼ dᵀCd
/// p0 = M(Z coth Z + Z) v̄ + (h/2) ∇V(q0),   p1 = M(Z coth Z − Z) v̄ − (h/2) ∇V(q1)
/// ```
///
/// **Derivation.** Strang's splitting: half a kick by −∇V, the damped free motion, exactly, half a kick.
///
/// **Properties.** Self-adjoint, of order 2, falling to 1 where the damping is stiff. One linear solve with a
/// constant matrix. The determinant of the step is e^{−h tr M⁻¹C}, that of the flow, for every V; where C =
/// 2aM, AᵀΩA = e^{−2ah}Ω (conformally symplectic), and an angular momentum falls by e^{−2ah} a step, exactly,
/// where the rotation leaves V and M as they are. Stable for the oscillator iff h²k/m < 4 z coth z.
///
/// In a [`Trajectory`](crate::Trajectory) the functions of Z are worked out once for each step size, and a
/// step costs one gradient and one solve with factors that are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FittedTrapezoidal;

impl ByDrift for FittedTrapezoidal {
    const EQUATION: Equation = Equation::Linear;
    const NODES: &'static [f64] = &[0.0, 1.0];

    #[inline]
    fn kernel<L: Rayleigh<N> + ?Sized, const N: usize>(
        drift: &DampedDrift<L::Scalar, N>,
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N> {
        let impulse = drift.configuration_force(system, &segment.q0) * (segment.h * L::Scalar::constant(0.5));
        let p0 = drift.before * segment.v + drift.shift - impulse;
        StepKernel { p0, matrix: drift.before }
    }

    #[inline]
    fn momenta<L: Rayleigh<N> + ?Sized, const N: usize>(
        drift: &DampedDrift<L::Scalar, N>,
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N> {
        let (v, half) = (&segment.v, segment.h * L::Scalar::constant(0.5));
        let [start, end] = [segment.q0, segment.end()].map(|q| drift.configuration_force(system, &q) * half);
        Momenta { p0: drift.before * v + drift.shift - start, p1: drift.after * v + drift.shift + end }
    }
}

impl JointRule for FittedTrapezoidal {
    #[inline]
    fn discrete_lagrangian<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        let drift = DampedDrift::of(system, &segment.q0, segment.h);
        let Segment { q0, v, h } = segment;
        let (half, rest) = (*h * L::Scalar::constant(0.5), nalgebra::zero());
        v.dot(&(drift.mass() * v)) * half
            + drift.shift.dot(v) * *h
            + (system.lagrangian(q0, &rest) + system.lagrangian(&segment.end(), &rest)) * half
    }

    #[inline]
    fn discrete_lagrangian_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        let drift = DampedDrift::of(system, &segment.q0, segment.h);
        let Segment { q0, v, h } = *segment;
        let half = h * L::Scalar::constant(0.5);
        let (mass, rest) = (drift.mass(), nalgebra::zero());
        let [start, end] = [q0, segment.end()].map(|q| system.lagrangian_derivatives(&q, &rest));
        let (p, inertia) = (mass * v + drift.shift, mass / h);
        Derivatives {
            value: (mass * v).dot(&v) * half + drift.shift.dot(&v) * h + (start.value + end.value) * half,
            d1: start.d1 * half - p,
            d2: end.d1 * half + p,
            d11: start.d11 * half + inertia,
            d12: -inertia,
            d22: end.d11 * half + inertia,
        }
    }

    #[inline]
    fn discrete_force<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N> {
        let r = system.rayleigh_derivatives(&segment.q0, &nalgebra::zero());
        let half = L::Scalar::constant(0.5);
        let force = -(r.d22 * segment.v + r.d2) * (segment.h * half);
        DiscreteForce { minus: force, plus: force }
    }

    #[inline]
    fn discrete_force_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        let drag = system.rayleigh_derivatives(&segment.q0, &nalgebra::zero()).d22 * L::Scalar::constant(0.5);
        let force = Self::discrete_force(system, segment).minus;
        let either = CovectorDerivatives { value: force, d1: drag, d2: -drag };
        DiscreteForceDerivatives { minus: either, plus: either }
    }

    #[inline]
    fn step_kernel<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N> {
        Self::kernel(&DampedDrift::of(system, &segment.q0, segment.h), system, segment)
    }

    #[inline]
    fn momenta<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N> {
        <Self as ByDrift>::momenta(&DampedDrift::of(system, &segment.q0, segment.h), system, segment)
    }

    #[inline]
    fn segment_energy<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        let ends = [segment.q0, segment.end()].map(|q| system.energy(&q, &segment.v));
        (ends[0] + ends[1]) * L::Scalar::constant(0.5)
    }

    fn at_nodes<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        visit: &mut dyn FnMut(&L, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        Trapezoidal::at_nodes(system, segment, visit);
    }
}

impl JointRayleighRule for FittedTrapezoidal {
    #[inline]
    fn discrete_rayleigh<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        let r = system.rayleigh_derivatives(&segment.q0, &nalgebra::zero());
        let d = segment.v * segment.h;
        d.dot(&(r.d22 * d)) * L::Scalar::constant(0.25)
            + d.dot(&r.d2) * (segment.h * L::Scalar::constant(0.5))
    }

    #[inline]
    fn discrete_rayleigh_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        let value = Self::discrete_rayleigh(system, segment);
        Self::discrete_force_derivatives(system, segment).as_of_rayleigh(value)
    }
}

impl SelfAdjoint for FittedTrapezoidal {}

closed_form!([] FittedTrapezoidal, JointRule, Rayleigh);
discrete_rayleigh!([L, const N: usize] FittedTrapezoidal, N, JointRayleighRule);

/// The free damped motion between the two kicks, exactly.
impl<L, const N: usize> ForceWork<FittedTrapezoidal, N> for L
where
    L: Flow<FittedTrapezoidal, N> + ActingForce<N> + Rayleigh<N>,
{
    fn energy_exchange(
        &self,
        from: &State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<EnergyExchange<L::Scalar>, StepError> {
        let drift = DampedDrift::of(self, &from.q, h);
        let v = (to.q - from.q) / h;
        let dissipated = taken_by_drift(self, &drift, (&from.q, &v), &drift.thrust, h)?;
        Ok(EnergyExchange { dissipated, work: L::Scalar::constant(0.0) })
    }
}
