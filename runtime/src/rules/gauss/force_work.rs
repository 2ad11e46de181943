//! The energy that forces take and bring over a step, at its stages.

use super::{Gauss, solved};
use crate::numbers::{Scalar, lanes::lane};
use crate::step::{EnergyExchange, ForceWork, State, StepError};
use crate::system::ForcedLagrangian;

/// h Σ bᵢ Vᵢ·∂R/∂v(Qᵢ, Vᵢ) and h Σ bᵢ Vᵢ·f(Qᵢ, Vᵢ).
impl<T, L, const N: usize, const S: usize> ForceWork<Gauss<S>, N> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    fn energy_exchange(
        &self,
        from: &State<T, N>,
        to: &State<T, N>,
        h: T,
    ) -> Result<EnergyExchange<T>, StepError> {
        if !L::IS_FORCED {
            return Ok(EnergyExchange::zero());
        }
        let mean = (to.q - from.q) / h;
        let (problem, solution) = solved::<_, _, N, S>(self, from, h, Some(&mean))
            .or_else(|_| solved::<_, _, N, S>(self, from, h, None))?;
        let q = problem.configurations(&solution.v);
        Ok((0..S).fold(EnergyExchange::zero(), |sum, i| {
            let power = self.later(problem.elapsed(i), |system| {
                EnergyExchange::power(system, &lane(&q, i), &lane(&solution.v, i))
            });
            sum + power * problem.steps[i]
        }))
    }
}
