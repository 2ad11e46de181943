//! Runs without the types of their systems and methods: what a record asks of them.

use dalembert::nalgebra::SVector;
use dalembert::run::events::{EventError, Watched};
use dalembert::run::{DrivenTrajectory, Run};
use dalembert::step::{Flow, Linearizable, Memory};
use dalembert::{Lagrangian, State, StepError};

use dalembert_face::{ByParameters, Described, Reacting, StepMade};

use crate::derivatives::Dependence;
use crate::system::System;

/// A state between the steps, with its velocity and energy.
#[derive(Clone, Copy, Debug)]
pub struct At<const N: usize> {
    /// The state.
    pub state: State<f64, N>,
    /// Its velocity.
    pub v: SVector<f64, N>,
    /// Its energy.
    pub energy: f64,
}

/// A run while it is recorded.
pub trait Motion<const N: usize> {
    /// Takes a step, or goes on to an event of the one that follows. `None` where the run has ended.
    fn advance(&mut self) -> Option<Result<Watched<f64, N>, EventError>>;

    /// The present state.
    fn state(&self) -> &State<f64, N>;

    /// Its time, from 0 at the start.
    fn time(&self) -> f64;

    /// Its velocity and energy.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    fn measured(&self) -> Result<(SVector<f64, N>, f64), StepError>;

    /// The state at a time of the last step; `None` where the run has not come so far, or is not looked into.
    fn at(&self, time: f64) -> Option<Result<At<N>, StepError>> {
        let _ = time;
        None
    }

    /// How it follows the start and the parameters, where that is carried along.
    fn dependence(&self) -> Option<&Dependence<N>> {
        None
    }

    /// λ of the step that led here, of the first one at the start; nothing where it is not asked for.
    ///
    /// # Errors
    /// Those of [`Reacting::reactions`], at the start those of the first step too.
    fn reactions(&self) -> Result<Vec<f64>, StepError> {
        Ok(Vec::new())
    }
}

/// A run on its system.
pub struct Of<'r, 'a, L, T> {
    pub(crate) system: &'a L,
    pub(crate) run: &'r mut T,
}

impl<L, T, const N: usize> Motion<N> for Of<'_, '_, L, T>
where
    L: Lagrangian<N, Scalar = f64>,
    T: Run<N, Scalar = f64>,
{
    fn advance(&mut self) -> Option<Result<Watched<f64, N>, EventError>> {
        self.run.next().map(|step| step.map(Watched::Step).map_err(EventError::from))
    }

    fn state(&self) -> &State<f64, N> {
        self.run.state()
    }

    fn time(&self) -> f64 {
        self.run.time()
    }

    fn measured(&self) -> Result<(SVector<f64, N>, f64), StepError> {
        self.system.later(self.run.time(), |system| measured(system, self.run.state()))
    }
}

/// The velocity and the energy of a state.
///
/// # Errors
/// Those of [`State::velocity`].
pub fn measured<L: Lagrangian<N, Scalar = f64>, const N: usize>(
    system: &L,
    state: &State<f64, N>,
) -> Result<(SVector<f64, N>, f64), StepError> {
    let v = state.velocity(system)?;
    Ok((v, system.energy(&state.q, &v)))
}

/// The inputs of a run, and the time at which it begins.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a> {
    /// u, or one after the other for as many steps.
    pub inputs: &'a [f64],
    /// The time of the system at the start.
    pub time: f64,
}

/// The questions that a run answers along its way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Along {
    /// How it follows start and parameters.
    pub derivatives: bool,
    /// λ of its constraints.
    pub reactions: bool,
}

impl Along {
    /// Whether there are any.
    #[must_use]
    pub fn is_any(self) -> bool {
        self.derivatives || self.reactions
    }
}

/// A run whose input changes from step to step, or that is asked something along.
pub struct StepByStep<'a, S: System<N>, M, const N: usize>
where
    S::View<'static>: Flow<M, N>,
{
    fields: &'a S::Fields,
    given: Given<'a>,
    taken: usize,
    run: DrivenTrajectory<S::View<'static>, M, N>,
    dependence: Option<Dependence<N>>,
    has_reactions: bool,
    /// The last step with its view, where λ is asked for.
    made: Option<(S::View<'a>, StepMade<f64, N>)>,
}

impl<'a, S: System<N>, M, const N: usize> StepByStep<'a, S, M, N>
where
    S::View<'static>: Flow<M, N>,
{
    pub(crate) fn new(
        fields: &'a S::Fields,
        given: Given<'a>,
        h: f64,
        start: State<f64, N>,
        along: Along,
    ) -> Self {
        let dependence = along.derivatives.then(|| Dependence::none(S::Fields::PARAMETERS.len()));
        let (run, has_reactions) = (DrivenTrajectory::new(h, start), along.reactions);
        Self { fields, given, taken: 0, run, dependence, has_reactions, made: None }
    }

    /// The system of the next step, or of the last one where that was the last input.
    fn view(&self) -> S::View<'a> {
        let Given { inputs, time } = self.given;
        let length = S::Fields::INPUTS;
        let last = inputs.len().checked_div(length).unwrap_or(1).saturating_sub(1);
        let first = self.taken.min(last) * length;
        S::view(self.fields, &inputs[first..first + length], time + self.run.time())
    }
}

impl<S, M, K, const N: usize> Motion<N> for StepByStep<'_, S, M, N>
where
    S: System<N>,
    for<'v> S::View<'v>: Linearizable<M, N> + Flow<M, N, RunMemory = K>,
    K: for<'v> Memory<S::View<'v>, M, N>,
    S::Parameters: for<'v> ByParameters<S::View<'v>, M, N>,
    S::Multipliers: for<'v> Reacting<S::View<'v>, M, N>,
{
    fn advance(&mut self) -> Option<Result<Watched<f64, N>, EventError>> {
        let view = self.view();
        let (h, state) = (self.run.step_size(), *self.run.state());
        let step = match &mut self.dependence {
            None => self.run.advance(&view),
            Some(dependence) => self.run.advance_linearized(&view).and_then(|taken| {
                dependence.follow(&taken.by_state()?, S::Parameters::columns(&taken)?.as_ref());
                Ok(*taken.step())
            }),
        };
        self.taken += 1;
        if let (true, Ok(step)) = (self.has_reactions, &step) {
            self.made = Some((view, StepMade { h, state, step: *step }));
        }
        Some(step.map(Watched::Step).map_err(EventError::from))
    }

    fn state(&self) -> &State<f64, N> {
        self.run.state()
    }

    fn time(&self) -> f64 {
        self.run.time()
    }

    fn measured(&self) -> Result<(SVector<f64, N>, f64), StepError> {
        measured(&self.view(), self.run.state())
    }

    fn dependence(&self) -> Option<&Dependence<N>> {
        self.dependence.as_ref()
    }

    fn reactions(&self) -> Result<Vec<f64>, StepError> {
        if !self.has_reactions {
            return Ok(Vec::new());
        }
        if let Some((view, made)) = &self.made {
            return Ok(S::Multipliers::reactions(view, made)?.as_ref().to_vec());
        }
        let (view, h, state) = (self.view(), self.run.step_size(), *self.run.state());
        let step = DrivenTrajectory::<S::View<'static>, M, N>::new(h, state).advance(&view)?;
        Ok(S::Multipliers::reactions(&view, &StepMade { h, state, step })?.as_ref().to_vec())
    }
}
