use nalgebra::SVector;

use super::closed_form::{closed_form, discrete_rayleigh};
use super::damped_drift::{ByDrift, DampedDrift};
use super::force_work::taken_by_drift;
use super::{JointRayleighRule, JointRule, SelfAdjoint};
use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::step::{
    DiscreteForce, DiscreteForceDerivatives, EnergyExchange, Flow, ForceWork, Momenta, Segment, State,
    StepError, StepKernel, equation::Equation,
};
use crate::system::{ActingForce, Lagrangian, Rayleigh};

/// The midpoint rule, exponentially fitted to linear damping: stiff damping, however stiff, makes it not
/// ring.
///
/// For L = ½vᵀMv − V(q) and R = ½vᵀCv with constant M, positive definite, and C. With d = q1 − q0, Z = ½hM⁻¹C
/// and the Langevin function ℒ(z) = coth z − 1/z:
///
/// ```text
/// L_d = (1/2h) dᵀ M Z coth(Z) d − h V(q̄)
/// f_d^∓ = −½ C d ∓ (h/2) ℒ(Z)ᵀ ∇V(q̄)
/// p0 = M(Z coth Z + Z) v̄ + (h/2)(I + ℒᵀ) ∇V(q̄)
/// p1 = M(Z coth Z − Z) v̄ − (h/2)(I − ℒᵀ) ∇V(q̄)
/// ```
///
/// **Derivation.** A free mass under m q̈ = −r q̇ goes d = (1 − e^{−2z})(m/r) v0, z = rh/2m, so that p0 = m z
/// (coth z + 1) v̄ and p1 = m z (coth z − 1) v̄: the midpoint's own R_d = (r/4)d² with the mass m z coth z in
/// L_d. A force lasting over the segment acts on the two ends unequally, because momentum is forgotten on the
/// way; under a constant one the exact motion gives the shares (h/2)(1 ± ℒ(z)). Without them q falls to order
/// 1 when the damping is stiff.
///
/// **Properties.** Self-adjoint; L-stable in the damping: a free mass decays by e^{−2z} a step (stiff springs
/// it follows as the midpoint rule does); equilibria and terminal velocities exact; equal to the midpoint
/// rule where C = 0. q is of order 2, uniformly in the stiffness of the damping; p is of order 2, falling to
/// 1 in the stiff limit, where it lags behind by half a step.
///
/// The functions of Z depend on h alone, and cost several times what is left of a step: a
/// [`Trajectory`](crate::Trajectory) works them out once for each step size, a single
/// [`step`](crate::Discretised::step) once.
///
/// Its force has an R_d if and only if CM⁻¹V″(q) is symmetric for all q: R_d = ¼ dᵀCd − h W(q̄) with ∇W =
/// ℒ(Z)ᵀ∇V. For one coordinate, and where C is a multiple of M, W = ℒ(z) V; for coordinates that M, C and V
/// leave uncoupled, as of pendula with different damping, W is the sum of such terms. The attribute writes
/// R_d for one coordinate alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fitted;

fn half<S: Scalar>(h: S) -> S {
    h * S::constant(0.5)
}

fn middle<S: Scalar, const N: usize>(segment: &Segment<S, N>) -> SVector<S, N> {
    segment.at(S::constant(0.5))
}

/// L(q, 0) = −V(q) with its derivatives.
fn at_rest<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Derivatives<L::Scalar, N> {
    system.lagrangian_derivatives(q, &nalgebra::zero())
}

impl ByDrift for Fitted {
    const EQUATION: Equation = Equation::General;
    const NODES: &'static [f64] = &[0.5];

    #[inline]
    fn kernel<L: Rayleigh<N> + ?Sized, const N: usize>(
        drift: &DampedDrift<L::Scalar, N>,
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N> {
        let (v, share) = (&segment.v, half(segment.h));
        let l = at_rest(system, &middle(segment));
        StepKernel {
            p0: drift.before * v + drift.shift - drift.lag_plus * (l.d1 - drift.thrust) * share,
            matrix: drift.before - drift.lag_plus * l.d11 * (share * share),
        }
    }

    #[inline]
    fn momenta<L: Rayleigh<N> + ?Sized, const N: usize>(
        drift: &DampedDrift<L::Scalar, N>,
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N> {
        let (v, share) = (&segment.v, half(segment.h));
        let impulse = drift.configuration_force(system, &middle(segment)) * share;
        Momenta {
            p0: drift.before * v + drift.shift - drift.lag_plus * impulse,
            p1: drift.after * v + drift.shift + drift.lag_minus * impulse,
        }
    }
}

impl JointRule for Fitted {
    #[inline]
    fn discrete_lagrangian<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        let drift = DampedDrift::of(system, &segment.q0, segment.h);
        let Segment { v, h, .. } = segment;
        v.dot(&(drift.mass() * v)) * half(*h)
            + drift.shift.dot(v) * *h
            + system.lagrangian(&middle(segment), &nalgebra::zero()) * *h
    }

    #[inline]
    fn discrete_lagrangian_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        let drift = DampedDrift::of(system, &segment.q0, segment.h);
        let l = at_rest(system, &middle(segment));
        let (mass, v, h) = (drift.mass(), &segment.v, segment.h);
        let (impulse, p) = (l.d1 * half(h), mass * v + drift.shift);
        let (bend, inertia) = (l.d11 * half(half(h)), mass / h);
        Derivatives {
            value: (mass * v).dot(v) * half(h) + drift.shift.dot(v) * h + l.value * h,
            d1: impulse - p,
            d2: impulse + p,
            d11: bend + inertia,
            d12: bend - inertia,
            d22: bend + inertia,
        }
    }

    #[inline]
    fn discrete_force<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N> {
        let force = Self::discrete_force_derivatives(system, segment);
        DiscreteForce { minus: force.minus.value, plus: force.plus.value }
    }

    #[inline]
    fn discrete_force_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        let drift = DampedDrift::of(system, &segment.q0, segment.h);
        let l = at_rest(system, &middle(segment));
        let share = half(segment.h);
        // ℒᵀ, half the difference of the two shares.
        let lag = (drift.lag_plus - drift.lag_minus) * L::Scalar::constant(0.5);
        let drag = system.rayleigh_derivatives(&segment.q0, &nalgebra::zero()).d22 * L::Scalar::constant(0.5);
        let (impulse, bend) = (lag * l.d1 * share, lag * l.d11 * half(share));
        let d = segment.v * segment.h;
        DiscreteForceDerivatives {
            minus: CovectorDerivatives {
                value: impulse - drag * d - drift.lag_plus * drift.thrust * share,
                d1: bend + drag,
                d2: bend - drag,
            },
            plus: CovectorDerivatives {
                value: -impulse - drag * d - drift.lag_minus * drift.thrust * share,
                d1: drag - bend,
                d2: -drag - bend,
            },
        }
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

    #[cold]
    fn cancelling_terms<L: ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        // I + ℒ is at most 2; the drag is in `before`.
        system.cancelling_terms(&middle(segment), &nalgebra::zero()).rate
            * nalgebra::ComplexField::abs(segment.h)
    }

    #[inline]
    fn segment_energy<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        system.energy(&middle(segment), &segment.v)
    }
}

/// For N = 1, or C a multiple of M: R_d = ¼ dᵀCd − h ℒ(z) V(q̄).
impl JointRayleighRule for Fitted {
    #[inline]
    fn discrete_rayleigh<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        Self::discrete_rayleigh_derivatives(system, segment).value
    }

    #[inline]
    fn discrete_rayleigh_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        let drift = DampedDrift::of(system, &segment.q0, segment.h);
        let l = at_rest(system, &middle(segment));
        let lag = (drift.lag_plus - drift.lag_minus)[(0, 0)] * L::Scalar::constant(0.5);
        let force = Self::discrete_force_derivatives(system, segment);
        let d = segment.v * segment.h;
        let thrust = (d - (segment.q0 + segment.end()) * lag).dot(&drift.thrust) * half(segment.h);
        let damping = system.rayleigh_derivatives(&segment.q0, &nalgebra::zero()).d22;
        let value = d.dot(&(damping * d)) * L::Scalar::constant(0.25) + l.value * (lag * segment.h) + thrust;
        force.as_of_rayleigh(value)
    }
}

impl SelfAdjoint for Fitted {}

closed_form!([] Fitted, JointRule, Rayleigh);
discrete_rayleigh!([L] Fitted, 1, JointRayleighRule);

/// The motion under the constant force −∇V(q̄), exactly: what is left of the energy is the quadrature of V
/// alone.
impl<L, const N: usize> ForceWork<Fitted, N> for L
where
    L: Flow<Fitted, N> + ActingForce<N> + Rayleigh<N>,
{
    fn energy_exchange(
        &self,
        from: &State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<EnergyExchange<L::Scalar>, StepError> {
        let drift = DampedDrift::of(self, &from.q, h);
        let v = (to.q - from.q) / h;
        let middle = (from.q + to.q) * L::Scalar::constant(0.5);
        let force = drift.configuration_force(self, &middle) + drift.thrust;
        let dissipated = taken_by_drift(self, &drift, (&from.q, &v), &force, h)?;
        Ok(EnergyExchange { dissipated, work: L::Scalar::constant(0.0) })
    }
}
