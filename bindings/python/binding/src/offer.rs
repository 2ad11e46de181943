//! Offers of a system: the methods by which it can be stepped, found by what its views implement.

use core::marker::PhantomData;

use dalembert::run::{Discretise, DrivenTrajectory, Stop};
use dalembert::step::{ClosedForm, Discrete, Flow, FlowInLanes, ForceWork, Linearizable, Memory, Step};
use dalembert::tolerance::{OffersMethods, TimedRequest, ToleranceError};
use dalembert::{State, StepError};
use dalembert_ensemble::{OneByOne, Plan, SideBySide, ToError};
use dalembert_face::{ByInput, ByParameters, Column, Reacting};

use crate::checks::{self, Checks};
use crate::derivatives::{column_rows, matrix_rows};
use crate::events::{Events, of_block};
use crate::look::{Look, looked_into, seen};
use crate::motion::{Along, Given, Motion, Of, StepByStep};
use crate::record::Guarded;
use crate::refusal::Refusal;
use crate::system::System;
use crate::together::Together;

/// A method by its name, and what it does with the system; `None` where the system has no step by it.
pub struct Offer<S: System<N>, const N: usize> {
    /// The name of the method, for `rule=`.
    pub name: &'static str,
    /// Its steps.
    pub steps: Option<Box<dyn Steps<S, N>>>,
    /// Steps with inputs of their own, and all derivatives: of rules.
    pub driven: Option<Box<dyn DrivenSteps<S, N>>>,
    /// Checks of its discrete objects: of rules by displacement.
    pub checks: Option<Box<dyn Checks<S, N>>>,
}

/// A system with the methods that it offers.
///
/// [`module!`](crate::module) implements it.
pub trait Offers<const N: usize>: System<N> {
    /// The offers of all methods.
    fn offers() -> Vec<Offer<Self, N>>;

    /// Runs to a tolerance, where the rules offer some.
    fn steps_to_error() -> Option<Box<dyn StepsToError<Self, N>>>;

    /// Runs to a tolerance.
    ///
    /// # Errors
    /// [`Refusal::NoError`].
    fn to_error() -> Result<Box<dyn StepsToError<Self, N>>, Refusal> {
        Self::steps_to_error().ok_or(Refusal::NoError)
    }

    /// The offer of the rule of this name, or of the first.
    ///
    /// # Errors
    /// [`Refusal::Rule`].
    fn offered(rule: Option<&str>) -> Result<Offer<Self, N>, Refusal> {
        let is_asked_for =
            |offer: &Offer<Self, N>| rule.is_none_or(|rule| rule == offer.name) && offer.steps.is_some();
        Self::offers().into_iter().find(is_asked_for).ok_or(Refusal::Rule)
    }
}

/// A function that a run is handed to.
pub type Record<'r, const N: usize> = &'r mut dyn FnMut(&mut dyn Motion<N>);

/// A step's derivatives, row by row.
#[derive(Clone, Debug)]
pub struct StepDerivatives<const N: usize> {
    /// The step.
    pub step: Step<f64, N>,
    /// ∂(q1, p1)/∂(q0, p0).
    pub a: Vec<f64>,
    /// ∂(q1, p1)/∂u.
    pub b: Option<Vec<f64>>,
    /// ∂(q1, p1)/∂θ.
    pub by_parameters: Option<Vec<f64>>,
}

/// Steps by one method.
pub trait Steps<S: System<N>, const N: usize>: Send + Sync {
    /// A run from `start`, with one input held.
    fn run(&self, system: &S::View<'_>, h: f64, start: &State<f64, N>, look: Look<'_>, record: Record<'_, N>);

    /// The runs of many.
    fn together<'a>(&self, plan: Plan<f64>) -> Box<dyn Together<S::View<'a>, N> + 'a>;

    /// A step with A.
    ///
    /// # Errors
    /// A [`StepError`].
    fn linearized(
        &self,
        system: &S::View<'_>,
        h: f64,
        start: &State<f64, N>,
    ) -> Result<StepDerivatives<N>, StepError>;
}

/// Steps by a rule, each with an input of its own and with all its derivatives.
pub trait DrivenSteps<S: System<N>, const N: usize>: Send + Sync {
    /// A run from `start`, with what is asked of it along.
    fn run(
        &self,
        fields: &S::Fields,
        given: Given<'_>,
        h: f64,
        start: &State<f64, N>,
        along: Along,
        record: Record<'_, N>,
    );

    /// A step with A, B and derivatives by parameters.
    ///
    /// # Errors
    /// A [`StepError`].
    fn linearized(
        &self,
        system: &S::View<'_>,
        h: f64,
        start: &State<f64, N>,
    ) -> Result<StepDerivatives<N>, StepError>;
}

/// A tolerance that a run keeps.
#[derive(Clone, Copy, Debug)]
pub struct ErrorAsked {
    /// The tolerance, in units of q.
    pub tolerance: f64,
    /// The time at the end, from the start.
    pub until: f64,
    /// The limit of its steps; that of the runtime if none is given.
    pub most: Option<u64>,
}

impl ErrorAsked {
    /// The request to `system`.
    fn of<L: OffersMethods<N>, const N: usize>(self, system: &L) -> TimedRequest<'_, L, L::Methods> {
        let request = system.to_error(self.tolerance).until(self.until);
        match self.most {
            Some(most) => request.at_most(most),
            None => request,
        }
    }
}

/// The steps that a run takes.
#[derive(Clone, Copy, Debug)]
pub enum Stepping<'a> {
    /// So many of size h.
    Fixed {
        /// h.
        h: f64,
        /// How many.
        steps: u64,
        /// The time at the end, from the start, where the last of them is as long as it takes to there.
        end: Option<f64>,
        /// By which rule; the first of the system if none is named.
        rule: Option<&'a str>,
    },
    /// The steps that a tolerance needs.
    ToError(ErrorAsked),
}

/// Runs to a tolerance.
#[allow(clippy::too_many_arguments, reason = "a run has so many")]
pub trait StepsToError<S: System<N>, const N: usize>: Send + Sync {
    /// A run from `start`; what became of its error.
    ///
    /// # Errors
    /// A [`ToleranceError`].
    fn run(
        &self,
        system: &S::View<'_>,
        asked: ErrorAsked,
        start: &State<f64, N>,
        look: Look<'_>,
        record: &mut dyn FnMut(&mut dyn Motion<N>, u64),
        stop: Stop<'_>,
    ) -> Result<Guarded, ToleranceError>;

    /// As many runs from `start` as it takes to keep the error, each of them recorded anew; `record` hands on
    /// why steps fail.
    ///
    /// # Errors
    /// A [`ToleranceError`].
    fn tried(
        &self,
        system: &S::View<'_>,
        asked: ErrorAsked,
        start: &State<f64, N>,
        events: Events<'_>,
        record: &mut dyn FnMut(&mut dyn Motion<N>, u64) -> Option<StepError>,
        stop: Stop<'_>,
    ) -> Result<(), ToleranceError>;

    /// The runs of many.
    fn together<'a>(&self, asked: ErrorAsked) -> Box<dyn Together<S::View<'a>, N> + 'a>;
}

/// Asks what a system and a method offer: a function of [`NotOffered`] answers `None` where that of `Probe`
/// itself has bounds that do not hold. It decides for types that are known, as in what
/// [`module!`](crate::module) writes, and there without a word about the methods of a system.
pub struct Probe<S, M, const N: usize> {
    method: M,
    system: PhantomData<fn() -> S>,
}

impl<S, M, const N: usize> Probe<S, M, N> {
    /// Of this method.
    pub fn new(method: M) -> Self {
        Self { method, system: PhantomData }
    }
}

/// The answers of a [`Probe`] where there is no offer.
pub trait NotOffered<S: System<N>, const N: usize> {
    /// `None`: the system is not stepped by the method.
    fn steps(&self) -> Option<Box<dyn Steps<S, N>>> {
        None
    }

    /// `None`: members are not stepped in lanes.
    fn steps_in_lanes(&self) -> Option<Box<dyn Steps<S, N>>> {
        None
    }

    /// `None`: steps are not asked for derivatives where they were taken.
    fn driven_steps(&self) -> Option<Box<dyn DrivenSteps<S, N>>> {
        None
    }

    /// `None`: the method has no discrete objects by formulas.
    fn checks(&self) -> Option<Box<dyn Checks<S, N>>> {
        None
    }

    /// `None`: no error can be asked of the system.
    fn steps_to_error(&self) -> Option<Box<dyn StepsToError<S, N>>> {
        None
    }
}

impl<S: System<N>, M, const N: usize> NotOffered<S, N> for Probe<S, M, N> {}

/// A method.
struct By<M>(M);

/// A method that takes many members at a time.
struct ByInLanes<M>(M);

impl<S, M, const N: usize> Probe<S, M, N>
where
    S: System<N>,
    for<'a> S::View<'a>: FlowInLanes<M, N>,
    M: Copy + Send + Sync + 'static,
{
    /// Steps by the method, of many in lanes.
    #[must_use]
    pub fn steps_in_lanes(&self) -> Option<Box<dyn Steps<S, N>>> {
        Some(Box::new(ByInLanes(self.method)))
    }
}

impl<S, M, const N: usize> Steps<S, N> for ByInLanes<M>
where
    S: System<N>,
    for<'a> S::View<'a>: FlowInLanes<M, N>,
    M: Copy + Send + Sync + 'static,
{
    fn run(
        &self,
        system: &S::View<'_>,
        h: f64,
        start: &State<f64, N>,
        look: Look<'_>,
        record: Record<'_, N>,
    ) {
        Steps::<S, N>::run(&By(self.0), system, h, start, look, record);
    }

    fn together<'a>(&self, plan: Plan<f64>) -> Box<dyn Together<S::View<'a>, N> + 'a> {
        Box::new(SideBySide::new(self.0, plan))
    }

    fn linearized(
        &self,
        system: &S::View<'_>,
        h: f64,
        start: &State<f64, N>,
    ) -> Result<StepDerivatives<N>, StepError> {
        Steps::<S, N>::linearized(&By(self.0), system, h, start)
    }
}

impl<S, M, const N: usize> Probe<S, M, N>
where
    S: System<N>,
    for<'a> S::View<'a>: Flow<M, N>,
    M: Copy + Send + Sync + 'static,
{
    /// Steps by the method.
    #[must_use]
    pub fn steps(&self) -> Option<Box<dyn Steps<S, N>>> {
        Some(Box::new(By(self.method)))
    }
}

impl<S, M, const N: usize> Steps<S, N> for By<M>
where
    S: System<N>,
    for<'a> S::View<'a>: Flow<M, N>,
    M: Copy + Send + Sync + 'static,
{
    fn run(
        &self,
        system: &S::View<'_>,
        h: f64,
        start: &State<f64, N>,
        look: Look<'_>,
        record: Record<'_, N>,
    ) {
        let mut run = system.by(self.0, h).run(*start);
        if look.is_any() {
            looked_into(&mut run, look, of_block::<S::Events, _, N>, record);
        } else {
            record(&mut Of { system, run: &mut run });
        }
    }

    fn together<'a>(&self, plan: Plan<f64>) -> Box<dyn Together<S::View<'a>, N> + 'a> {
        Box::new(OneByOne::new(self.0, plan))
    }

    fn linearized(
        &self,
        system: &S::View<'_>,
        h: f64,
        start: &State<f64, N>,
    ) -> Result<StepDerivatives<N>, StepError> {
        let (step, a) = system.by(self.0, h).linearized_step(start)?;
        Ok(StepDerivatives { step, a: matrix_rows(&a), b: None, by_parameters: None })
    }
}

/// A rule, and what its runs keep.
struct ByRule<M, K>(PhantomData<fn() -> (M, K)>);

impl<S, M, K, const N: usize> Probe<S, M, N>
where
    S: System<N>,
    for<'a> S::View<'a>: Linearizable<M, N> + Flow<M, N, RunMemory = K>,
    K: for<'a> Memory<S::View<'a>, M, N> + 'static,
    S::Input: for<'a> ByInput<S::View<'a>, M, N>,
    S::Parameters: for<'a> ByParameters<S::View<'a>, M, N>,
    S::Multipliers: for<'a> Reacting<S::View<'a>, M, N>,
    M: 'static,
{
    /// Steps with inputs of their own and with derivatives.
    #[must_use]
    pub fn driven_steps(&self) -> Option<Box<dyn DrivenSteps<S, N>>> {
        Some(Box::new(ByRule::<M, K>(PhantomData)))
    }
}

impl<S, M, K, const N: usize> DrivenSteps<S, N> for ByRule<M, K>
where
    S: System<N>,
    for<'a> S::View<'a>: Linearizable<M, N> + Flow<M, N, RunMemory = K>,
    K: for<'a> Memory<S::View<'a>, M, N> + 'static,
    S::Input: for<'a> ByInput<S::View<'a>, M, N>,
    S::Parameters: for<'a> ByParameters<S::View<'a>, M, N>,
    S::Multipliers: for<'a> Reacting<S::View<'a>, M, N>,
    M: 'static,
{
    fn run(
        &self,
        fields: &S::Fields,
        given: Given<'_>,
        h: f64,
        start: &State<f64, N>,
        along: Along,
        record: Record<'_, N>,
    ) {
        record(&mut StepByStep::<S, M, N>::new(fields, given, h, *start, along));
    }

    fn linearized(
        &self,
        system: &S::View<'_>,
        h: f64,
        start: &State<f64, N>,
    ) -> Result<StepDerivatives<N>, StepError> {
        let mut run = DrivenTrajectory::<S::View<'static>, M, N>::new(h, *start);
        let taken = run.advance_linearized(system)?;
        let rows = |columns: &[Column<f64, N>]| (!columns.is_empty()).then(|| column_rows(columns));
        Ok(StepDerivatives {
            step: *taken.step(),
            a: matrix_rows(&taken.by_state()?),
            b: rows(S::Input::columns(&taken)?.as_ref()),
            by_parameters: rows(S::Parameters::columns(&taken)?.as_ref()),
        })
    }
}

impl<S, M, const N: usize> Probe<S, M, N>
where
    S: System<N>,
    for<'a> S::View<'a>: ClosedForm<M, N> + Discrete<M, N> + ForceWork<M, N>,
    M: Copy + Send + Sync + 'static,
{
    /// The checks of its discrete objects.
    #[must_use]
    pub fn checks(&self) -> Option<Box<dyn Checks<S, N>>> {
        Some(Box::new(checks::ByRule(self.method)))
    }
}

/// The methods that the rules of a system stand for.
struct Offered;

impl<S, M, const N: usize> Probe<S, M, N>
where
    S: System<N>,
    for<'a> S::View<'a>: OffersMethods<N>,
{
    /// Runs to a tolerance.
    #[must_use]
    pub fn steps_to_error(&self) -> Option<Box<dyn StepsToError<S, N>>> {
        Some(Box::new(Offered))
    }
}

impl<S, const N: usize> StepsToError<S, N> for Offered
where
    S: System<N>,
    for<'a> S::View<'a>: OffersMethods<N>,
{
    fn run(
        &self,
        system: &S::View<'_>,
        asked: ErrorAsked,
        start: &State<f64, N>,
        look: Look<'_>,
        record: &mut dyn FnMut(&mut dyn Motion<N>, u64),
        stop: Stop<'_>,
    ) -> Result<Guarded, ToleranceError> {
        let choice = asked.of(system).stopped_by(stop).choice(start)?;
        let mut run = choice.trajectory();
        let steps = choice.steps();
        if look.is_any() {
            seen(&mut run, look.events, of_block::<S::Events, _, N>, &mut |motion| record(motion, steps));
        } else {
            record(&mut Of { system, run: &mut run }, steps);
        }
        Ok(Guarded {
            method: choice.method().to_string(),
            h: choice.step_size(),
            expected: run.expected(),
            breach: run.breach().copied(),
        })
    }

    fn tried(
        &self,
        system: &S::View<'_>,
        asked: ErrorAsked,
        start: &State<f64, N>,
        events: Events<'_>,
        record: &mut dyn FnMut(&mut dyn Motion<N>, u64) -> Option<StepError>,
        stop: Stop<'_>,
    ) -> Result<(), ToleranceError> {
        let reached = asked.of(system).stopped_by(stop).end_followed(start, |run| {
            let (steps, mut failure) = (run.choice().steps(), None);
            seen(run, Some(events), of_block::<S::Events, _, N>, &mut |motion| {
                failure = record(motion, steps);
            });
            failure.map_or(Ok(()), Err)
        });
        reached.map(drop)
    }

    fn together<'a>(&self, asked: ErrorAsked) -> Box<dyn Together<S::View<'a>, N> + 'a> {
        Box::new(ToError::new(asked.tolerance, asked.until))
    }
}
