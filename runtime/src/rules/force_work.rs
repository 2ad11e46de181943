//! The energy that forces take and bring over a step, by each rule.

use nalgebra::SVector;

use super::DisplacementRule;
use super::damped_drift::DampedDrift;
use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::{EnergyExchange, State, StepError};
use crate::system::{ActingForce, Rayleigh};

/// h Σ bᵢ v̄·∂R/∂v(qᵢ, v̄) and h Σ bᵢ v̄·f(qᵢ, v̄).
pub(super) fn along_the_line<Q: DisplacementRule, L: ActingForce<N>, const N: usize>(
    system: &L,
    from: &State<L::Scalar, N>,
    to: &State<L::Scalar, N>,
    h: L::Scalar,
) -> EnergyExchange<L::Scalar> {
    let d = to.q - from.q;
    let v = d / h;
    Q::NODES.iter().fold(EnergyExchange::zero(), |sum, node| {
        let position = L::Scalar::constant(node.position);
        let q = from.q + d * position;
        let power = system.later(h * position, |system| EnergyExchange::power(system, &q, &v));
        sum + power * (h * L::Scalar::constant(node.weight))
    })
}

/// [`ForceWork`](crate::step::ForceWork) of a rule that sees forces at these nodes.
macro_rules! by_nodes {
    ([$($parameter:tt)*] $rule:ty, of $nodes:ty) => {
        impl<L, $($parameter)* const N: usize> crate::step::ForceWork<$rule, N> for L
        where
            L: crate::step::Flow<$rule, N> + crate::system::ActingForce<N>,
        {
            fn energy_exchange(
                &self,
                from: &crate::step::State<L::Scalar, N>,
                to: &crate::step::State<L::Scalar, N>,
                h: L::Scalar,
            ) -> Result<crate::step::EnergyExchange<L::Scalar>, crate::step::StepError> {
                Ok(super::force_work::along_the_line::<$nodes, _, N>(self, from, to, h))
            }
        }
    };
}

pub(super) use by_nodes;

/// The energy that friction takes over the motion that is damped and free but for a constant force, from q0
/// with the mean velocity v̄.
///
/// ```text
/// p0 + p1 = 2 M u,   p0 − p1 = h (C v̄ − g)      without the terms of first degree, g = `force` − ∂R/∂v(0)
/// ½ p0ᵀM⁻¹p0 − ½ p1ᵀM⁻¹p1 + h v̄·`force` = h [v̄ᵀC u − g·(u − v̄) + v̄·∂R/∂v(0)]
/// ```
pub(super) fn taken_by_drift<L: Rayleigh<N>, const N: usize>(
    system: &L,
    drift: &DampedDrift<L::Scalar, N>,
    (q0, v): (&SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    force: &SVector<L::Scalar, N>,
    h: L::Scalar,
) -> Result<L::Scalar, StepError> {
    let rest = nalgebra::zero();
    let mass = system.lagrangian_derivatives(q0, &rest).d22;
    let damping = system.rayleigh_derivatives(q0, &rest).d22;
    let net = force - drift.thrust;
    // ℒᵀ, half the difference of the two shares.
    let lag = (drift.lag_plus - drift.lag_minus) * L::Scalar::constant(0.5);
    let momentum = drift.mass() * v - lag * net * (h * L::Scalar::constant(0.5));
    let u = mass
        .solve(&momentum)
        .map_err(|singular| StepError::MassNotPositiveDefinite { column: singular.column })?;
    Ok((v.dot(&(damping * u)) - net.dot(&(u - v)) + v.dot(&drift.thrust)) * h)
}
