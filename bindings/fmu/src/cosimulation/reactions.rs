//! Reactions of constraints: λ of the last step.

use dalembert_face::{Interface, StepMade};

use super::{CoSimulation, Run};
use crate::refusal::Refusal;

impl<I: Interface<N>, const N: usize> CoSimulation<I, N> {
    /// λ of the last step; before the first that of the step that would follow now.
    pub(super) fn multipliers(&self) -> Result<Vec<I::Scalar>, Refusal> {
        if !self.reactions.is_empty() {
            return Ok(self.reactions.clone());
        }
        let mut run = Run::<I, N>::new(self.step_size, self.motion()?.0);
        let (time, made) = self.advance(&mut run, self.step_size)?;
        self.reactions_of(time, &made)
    }

    /// Takes a step of `run` of this length with the input as it is; when, and the step.
    pub(super) fn advance(
        &self,
        run: &mut Run<I, N>,
        length: I::Scalar,
    ) -> Result<(f64, StepMade<I::Scalar, N>), Refusal> {
        if length != run.step_size() {
            run.change_step_size(length);
        }
        let time = self.start_time + run.time();
        let (input, now) = Self::given(&self.input, time);
        let (h, state) = (run.step_size(), *run.state());
        let step = run.advance(&I::view(&self.system, input, now));
        Ok((time, StepMade { h, state, step: step.map_err(|error| Refusal::Step { error, time })? }))
    }

    /// λ of the step that was made at this time, with the input as it is.
    pub(super) fn reactions_of(
        &self,
        time: f64,
        made: &StepMade<I::Scalar, N>,
    ) -> Result<Vec<I::Scalar>, Refusal> {
        let (input, now) = Self::given(&self.input, time);
        let view = I::view(&self.system, input, now);
        let reactions = I::reactions(&view, made).map_err(|error| Refusal::Step { error, time })?;
        Ok(reactions.as_ref().to_vec())
    }
}
