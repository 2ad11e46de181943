//! The step of a run, its equations linearised at the stages that were solved for.

use super::problem::Problem;
use super::segment::Segment;
use super::{Gauss, StageHistory};
use crate::numbers::{Compensated, Scalar};
use crate::step::{
    DiscreteDriven, DiscreteParameters, Linearizable, PhaseMatrix, State, StateBy, Step, StepError,
};
use crate::system::ForcedLagrangian;

/// The equations of a step's stages, linearised and factored.
pub struct LinearizedStages<'a, L: ForcedLagrangian<N>, const N: usize, const S: usize>(Segment<'a, L, N, S>);

impl<T, L, const N: usize, const S: usize> Linearizable<Gauss<S>, N> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    type Linearized<'a>
        = LinearizedStages<'a, L, N, S>
    where
        L: 'a;

    fn linearized<'a>(
        &'a self,
        memory: &StageHistory<T, N, S>,
        state: &State<T, N>,
        _: &Step<T, N>,
        h: T,
    ) -> Result<LinearizedStages<'a, L, N, S>, StepError> {
        let (q0, p0) = (Compensated::new(state.q), Compensated::new(state.p));
        Segment::of_stages(Problem::new(self, q0, p0, h), memory.v).map(LinearizedStages)
    }

    fn by_state(at: &LinearizedStages<'_, L, N, S>) -> Result<PhaseMatrix<T, N>, StepError> {
        Ok(at.0.by_state()?.matrix())
    }

    fn by_input<const U: usize>(at: &LinearizedStages<'_, L, N, S>) -> Result<StateBy<T, N, U>, StepError>
    where
        L: DiscreteDriven<Gauss<S>, N, U>,
    {
        Ok(at.0.by_input()?.end)
    }

    fn by_parameters<const P: usize>(
        at: &LinearizedStages<'_, L, N, S>,
    ) -> Result<StateBy<T, N, P>, StepError>
    where
        L: DiscreteParameters<Gauss<S>, N, P>,
    {
        Ok(at.0.by_parameters()?.end)
    }
}
