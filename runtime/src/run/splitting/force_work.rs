//! The energy exchanged with forces over a step: by friction in the drifts, exactly, and by a general force
//! in the kicks.

use nalgebra::SVector;

use super::coefficients::Part;
use super::{Drift, Prepared, Splitting, Sums};
use crate::numbers::{NewtonMatrix, Scalar};
use crate::run::Explicit;
use crate::step::{EnergyExchange, ForceWork, State, StepError};

/// ```text
/// dissipated = Σ [½ pᵀM⁻¹p before a drift − ½ pᵀM⁻¹p after it] + (q1 − q0)·∂R/∂v(0)
/// work       = Σ bᵢh f(qᵢ)·M⁻¹(p before + p after a kick)/2
/// ```
///
/// with p less ∂L/∂v(0). A drift backwards gives back what friction would have taken on the way.
impl<L, const N: usize, const S: usize, C: Sums> ForceWork<Splitting<S, C>, N> for L
where
    L: Explicit<N>,
{
    fn energy_exchange(
        &self,
        from: &State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<EnergyExchange<L::Scalar>, StepError> {
        if !L::IS_FORCED {
            return Ok(EnergyExchange::zero());
        }
        let prepared = Prepared::<L::Scalar, N, S>::new(self, h)?;
        let rest: SVector<L::Scalar, N> = nalgebra::zero();
        let mass = self.lagrangian_derivatives(&rest, &rest).d22;
        let half = L::Scalar::constant(0.5);
        // What an impulse Δp takes from or brings to ½ pᵀM⁻¹p of which it is a part: Δp·M⁻¹(p + Δp/2).
        let along = |impulse: &SVector<L::Scalar, N>, middle: &SVector<L::Scalar, N>| {
            let v = mass.solve(middle);
            v.map(|v| impulse.dot(&v))
                .map_err(|singular| StepError::MassNotPositiveDefinite { column: singular.column })
        };
        let mut exchange =
            EnergyExchange { dissipated: (to.q - from.q).dot(&prepared.thrust), ..EnergyExchange::zero() };
        let (mut q, mut p) = (from.q, from.p - prepared.shift);
        for part in Splitting::<S>::parts() {
            match part {
                Part::Kick(i, share) => {
                    let kick = prepared.kicks[i];
                    let (acting, force) = self.later(L::Scalar::constant(share) * h, |system| {
                        (system.configuration_force(&q), system.general_force(&q, &rest))
                    });
                    let impulse = (acting - prepared.thrust) * kick;
                    if L::HAS_FORCE {
                        let force = force * kick;
                        exchange.work += along(&force, &(p + impulse * half))?;
                    }
                    p += impulse;
                }
                Part::Drift(i) => {
                    let Drift { displacement, loss } = prepared.drift(i);
                    let lost = loss * p;
                    exchange.dissipated -= along(&lost, &(p + lost * half))?;
                    q += displacement * p;
                    p += lost;
                }
            }
        }
        Ok(exchange)
    }
}
