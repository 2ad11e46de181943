//! The step of a run, its equations linearised at the stages that were solved for.

use super::problem::Problem;
use super::segment::SolvedSegment;
use super::{Gauss, StageHistory};
use crate::numbers::{Compensated, Scalar};
use crate::step::{Linearizable, PhaseMatrix, State, Step, StepError};
use crate::system::ForcedLagrangian;

impl<T, L, const N: usize, const S: usize> Linearizable<Gauss<S>, N> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    type Linearized<'a>
        = SolvedSegment<'a, L, N, S>
    where
        L: 'a;

    fn linearized<'a>(
        &'a self,
        memory: &StageHistory<T, N, S>,
        state: &State<T, N>,
        _: &Step<T, N>,
        h: T,
    ) -> Result<SolvedSegment<'a, L, N, S>, StepError> {
        let (q0, p0) = (Compensated::new(state.q), Compensated::new(state.p));
        SolvedSegment::of_stages(Problem::new(self, q0, p0, h), memory.v)
    }

    fn linearized_on<'a>(on: SolvedSegment<'a, L, N, S>) -> Result<SolvedSegment<'a, L, N, S>, StepError>
    where
        L: 'a,
    {
        Ok(on)
    }

    fn by_state(at: &SolvedSegment<'_, L, N, S>) -> Result<PhaseMatrix<T, N>, StepError> {
        Ok(at.by_state()?.matrix())
    }
}
