//! The guard along the run of a choice.

mod look;
mod schedule;

use nalgebra::SVector;

use super::estimate::{Estimate, Since};
use super::grid::Segment;
use super::hardest::Hardest;
use super::scale::Scale;
use super::twin::Kept;
use super::unresolved::Unresolved;
use super::{
    Breach, Choice, Chosen, LastStep, MethodStep, Methods, OffersMethods, ToleranceError, local_error,
};
use crate::numbers::Scalar;
use crate::numbers::random::Random;
use crate::run::present::at_present;
use crate::run::{Run, Samples};
use crate::step::{State, Step, StepError};
use crate::system::ActingForce;
use schedule::{RESOLVED, ROUGHER, derivatives};

/// The run of a [`Choice`] over its time: an iterator over steps, that ends after the last step or an error.
///
/// It carries an estimate of its error along, in q and p:
///
/// ```text
/// δ_{k+1} = A_k δ_k + d_k
/// ```
///
/// - d_k, the local error, is the difference to two half steps. It is taken at some steps, at no period, for
///   those between as well, and where the motion becomes rougher: by fourth differences of q, of Gauss
///   methods by the last coefficients of the velocity's polynomial, whose squares say what the steps between
///   err by. Runs of fewer than 100 steps are looked at in every step where there are no such coefficients,
///   or where the system takes the time.
/// - A_k is the tangent map of the motion: exp of ∂(q̇, ṗ)/∂(q, p) at the states of the run, and between them
///   where an error turns far in one step. A shift in time stays one, exactly, unless the system changes with
///   time, and an error's energy stays where no force acts. So growth is that of the motion, chaos included.
///   For more than three coordinates where a step costs less than the algebra of its matrices (splittings)
///   two steps of the rule, from the state and from beside it, carry δ instead.
/// - What δ may be besides is carried along as two samples at random, as motions that part leave the
///   direction of δ: by rounding, which is that of the forces in the fastest mode as well, by what local
///   errors and their growth are not known to, and by steps that were not looked at.
/// - Where no force acts and nothing depends on time, the energy says what its part of the error is; more of
///   it than the steps since it was asked for can have made reveals one that erred without being looked at.
/// - Where the system changes with time, the force is asked for between the nodes of a step as well, at the
///   state last looked at, so that a pulse is looked at.
///
/// The run goes on after a [`Breach`], with the same step size. By the clock the guard costs some three times
/// a run of fewer than 100 steps, and of longer ones 0.1 to 4 times, by what a step costs beside the motion's
/// derivative: the page `docs/evidence/tolerance.md`. [`Choice::unguarded`] is the run without it.
pub struct GuardedTrajectory<'a, L, M, const N: usize>
where
    L: ActingForce<N> + 'a,
    M: Methods<L, N>,
{
    pub(super) choice: Choice<'a, L, M, N>,
    step: M::Step,
    half: M::Step,
    twin: Kept<M::Step>,
    guard: Guard<L::Scalar, N>,
    /// The error expected beyond which the run is not gone on with.
    hopeless: f64,
    failed: bool,
}

/// A guarded run as it can be saved: [`GuardedTrajectory::checkpoint`]. With the feature `serde` it can be
/// written and read, in a format that holds infinite numbers where an expected error is one (JSON does not).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GuardedCheckpoint<S: Scalar, const N: usize> {
    chosen: Chosen<S, N>,
    guard: Guard<S, N>,
}

/// Where a guarded run stands, and what its guard knows.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Guard<S: Scalar, const N: usize> {
    state: State<S, N>,
    taken: u64,
    segment: Segment,
    /// Whether it looks at the steps at all.
    is_on: bool,
    scale: Scale<S, N>,
    estimate: Estimate<S, N>,
    /// The average cost of a step, in evaluations.
    evaluations: f64,
    /// The cost of the half steps so far, in evaluations.
    looked: f64,
    /// Steps after which the tangent map was computed last, will be next, and was the time before the last.
    carried: [u64; 3],
    /// Where a twin has carried the error last, and after which step.
    twin: (State<S, N>, u64),
    /// The step looked at last, and next; the size of its local error, and how rough the motion was.
    looks: [u64; 2],
    local: f64,
    roughness: f64,
    recent: [SVector<S, N>; 4],
    /// The largest change of the force with time; of the last step where the longest step was given.
    stroke: f64,
    unresolved: Unresolved<S, N>,
    /// The step after which the energy was asked for.
    energy: u64,
    random: Random,
    hardest: Hardest<S, N>,
    /// The largest error expected so far, where it was looked at.
    largest: f64,
    breach: Option<Breach>,
}

impl<'a, L, M, const N: usize> GuardedTrajectory<'a, L, M, N>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    pub(super) fn new(choice: Choice<'a, L, M, N>, [step, half]: [M::Step; 2], is_on: bool) -> Self {
        let Choice { system, methods, chosen } = choice;
        let (start, scale) = (chosen.start, Scale::new(&chosen.start));
        let is_coarse = N > RESOLVED && derivatives(N) > chosen.evaluations_per_step;
        let mut estimate = Estimate::new(system, is_coarse);
        let ahead = chosen.time;
        let none = Since {
            steps: 0.0,
            roundings: 0.0,
            passed: (State { q: SVector::zeros(), p: SVector::zeros() }, 0.0),
            foreseen: 0.0,
            affordable: 0.0,
            is_energy: true,
            ahead,
        };
        estimate.carry((system, methods), &start, 0.0, &scale, &none);
        let segment = chosen.first_segment();
        let guard = Guard {
            estimate,
            state: start,
            taken: 0,
            segment,
            is_on,
            scale,
            evaluations: 0.0,
            looked: 0.0,
            carried: [0; 3],
            twin: (start, 0),
            looks: [0, 1],
            local: chosen.local,
            roughness: 0.0,
            recent: [start.q; 4],
            stroke: 0.0,
            unresolved: Unresolved::new(),
            energy: 0,
            random: Random::new(0x9e37_79b9_7f4a_7c15),
            hardest: Hardest::new(start, segment.step_size()),
            largest: 0.0,
            breach: None,
        };
        let mut guarded =
            Self { choice, step, half, twin: None, guard, hopeless: f64::INFINITY, failed: false };
        guarded.schedule_derivatives();
        guarded
    }

    /// All that is needed to go on from here, in this process or another ([`GuardedTrajectory::resume`]): the
    /// run, and what its guard knows of its error.
    ///
    /// The run forgets what its method remembers of earlier steps, as one that is resumed has to: both go on
    /// bit by bit alike.
    ///
    /// ```
    /// use dalembert::tolerance::GuardedTrajectory;
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] + q[0].cos()
    /// }
    /// let start = State::from_velocity(&Pendulum {}, [1.0], [0.0])?;
    /// let mut run = Pendulum {}.to_error(1e-9).until(100.0).run(start)?;
    /// run.by_ref().take(20).for_each(|step| assert!(step.is_ok()));
    /// let checkpoint = run.checkpoint();
    /// let mut resumed = GuardedTrajectory::resume(&Pendulum {}, &checkpoint)?;
    /// assert!(resumed.by_ref().eq(run.by_ref()) && resumed.expected() == run.expected());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn checkpoint(&mut self) -> GuardedCheckpoint<L::Scalar, N> {
        if let Some(fresh) = self.choice.fresh_steps(self.step_size()) {
            [self.step, self.half] = fresh;
        }
        self.twin = None;
        GuardedCheckpoint { chosen: self.choice.chosen, guard: self.guard }
    }

    /// The run that `checkpoint` was taken of.
    ///
    /// # Errors
    /// [`ToleranceError::NotOffered`] where the system does not offer the method of the run.
    pub fn resume(system: &'a L, checkpoint: &GuardedCheckpoint<L::Scalar, N>) -> Result<Self, ToleranceError>
    where
        L: OffersMethods<N, Methods = M>,
        M: Default,
    {
        let GuardedCheckpoint { chosen, guard } = *checkpoint;
        let choice = Choice { system, methods: M::default(), chosen };
        let steps = choice
            .fresh_steps(guard.segment.step_size())
            .ok_or(ToleranceError::NotOffered { method: chosen.method })?;
        let [step, half] = steps;
        Ok(Self { choice, step, half, twin: None, guard, hopeless: f64::INFINITY, failed: false })
    }

    /// Every `stride`-th step only, with what the steps between reported: long runs in constant memory.
    ///
    /// A stride of 0 counts as 1; the last sample is of the last step, however many lie before it. An error
    /// on any step is returned at once.
    pub fn sample_every(&mut self, stride: u64) -> Samples<'_, Self, N> {
        Samples::new(self, stride)
    }

    /// This run, which ends where the error expected comes to as much.
    pub(super) fn given_up_beyond(self, hopeless: f64) -> Self {
        Self { hopeless, ..self }
    }

    /// The choice of which this is the run.
    pub fn choice(&self) -> &Choice<'a, L, M, N> {
        &self.choice
    }

    /// The present state.
    pub fn state(&self) -> &State<L::Scalar, N> {
        &self.guard.state
    }

    /// The time: where nothing breaks on the way, h × the number of steps taken.
    pub fn time(&self) -> f64 {
        self.guard.segment.time(self.guard.taken)
    }

    at_present!(run => run.choice.system, 0.0);

    /// The size of the last step: one where nothing breaks on the way.
    pub(super) fn step_size(&self) -> f64 {
        self.guard.segment.step_size()
    }

    /// The error expected of the state, in the norm of [the promise](super); NaN where the guard is off
    /// ([`Choice::unguarded`]).
    pub fn expected(&self) -> f64 {
        if !self.guard.is_on {
            return f64::NAN;
        }
        let unseen = (self.guard.taken - self.guard.looks[0]) as f64;
        self.guard.estimate.size(&self.guard.scale) + unseen * self.guard.local
    }

    /// Where the error expected has first passed the tolerance; `None` while it has not.
    pub fn breach(&self) -> Option<&Breach> {
        self.guard.breach.as_ref()
    }

    /// The largest error expected on the way, where it was looked at.
    pub(super) fn largest(&self) -> f64 {
        self.guard.largest
    }

    /// How many steps were taken.
    pub(super) fn taken(&self) -> u64 {
        self.guard.taken
    }

    /// The step that erred most of those looked at.
    pub(super) fn hardest(&self) -> &Hardest<L::Scalar, N> {
        &self.guard.hardest
    }

    /// The last step.
    pub(super) fn last(&self) -> &dyn LastStep<L, N> {
        self.step.last()
    }

    /// The cost of the steps taken, in evaluations of the forces, and that of the guard beside them.
    pub fn evaluations(&self) -> (f64, f64) {
        (
            self.guard.evaluations * self.guard.taken as f64,
            self.guard.looked + self.guard.estimate.evaluations,
        )
    }

    fn is_in_last_segment(&self) -> bool {
        self.guard.segment.steps[1] == self.choice.chosen.steps
    }

    /// Goes on behind a time at which the system breaks: nothing of the motion before tells of that after it.
    #[cold]
    fn begin_segment(&mut self) {
        let Chosen { time, step_size, breaks, .. } = self.choice.chosen;
        let Some(next) = self.guard.segment.next(time, step_size, &breaks) else { return };
        self.guard.segment = next;
        if let Some(fresh) = self.choice.fresh_steps(next.step_size()) {
            [self.step, self.half] = fresh;
        }
        if !self.guard.is_on {
            return;
        }
        self.guard.estimate.resume((self.choice.system, self.choice.methods), &self.guard.state, next.from());
        self.guard.roughness = 0.0;
        self.guard.stroke = 0.0;
        self.guard.unresolved = Unresolved::new();
        self.guard.recent = [self.guard.state.q; 4];
        self.guard.twin = (self.guard.state, self.guard.taken);
        self.guard.carried = [self.guard.taken, self.guard.taken + 1, self.guard.taken];
        self.guard.looks[1] = self.guard.taken + 1;
    }
}

impl<L, M, const N: usize> Iterator for GuardedTrajectory<'_, L, M, N>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    type Item = Result<Step<L::Scalar, N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        let is_over = self.guard.taken == self.choice.chosen.steps;
        if self.failed || is_over || self.guard.largest > self.hopeless {
            return None;
        }
        if self.guard.taken == self.guard.segment.steps[1] {
            self.begin_segment();
        }
        let before = self.guard.state;
        let taken = match self.step.advance(self.choice.system, self.time(), &before) {
            Ok(taken) => taken,
            Err(error) => {
                self.failed = true;
                return Some(Err(error));
            }
        };
        self.guard.state = taken.step.state;
        self.guard.taken += 1;
        self.guard.evaluations += (taken.evaluations - self.guard.evaluations) / self.guard.taken as f64;
        if !self.guard.is_on {
            return Some(Ok(taken.step));
        }
        self.guard.scale.follow(&before, &taken.step.state);
        let difference = self.fourth_difference();
        let roughness = taken.unresolved.map_or(difference, |[before, last]| before.max(last));
        // Fourth differences take five states, coefficients are known of the first step.
        let first = if taken.unresolved.is_some() { 1 } else { 5 };
        let within = self.guard.taken - self.guard.segment.steps[0];
        let is_rougher = roughness > ROUGHER * self.guard.roughness && within > first;
        let is_last = self.guard.taken == self.guard.segment.steps[1] && !self.is_in_last_segment();
        let is_due = is_last || self.guard.taken >= self.guard.looks[1];
        let is_struck = self.is_struck();
        let looks = is_struck || is_rougher || is_due;
        if self.guard.roughness == 0.0 && within <= first {
            self.guard.roughness = roughness;
        }
        let carries =
            self.guard.taken >= self.guard.carried[1] || (looks && !self.guard.estimate.is_coarse());
        if self.guard.estimate.is_coarse() {
            self.carry_by_twin(looks || carries);
        }
        if carries {
            self.carry();
        }
        if looks {
            self.guard.roughness = if is_rougher { roughness } else { self.guard.roughness.max(roughness) };
            self.look(&before, taken.unresolved, is_struck);
        } else if let Some(unresolved) = taken.unresolved {
            self.guard.unresolved.pass(unresolved);
        }
        if looks || self.guard.carried[0] == self.guard.taken {
            let expected = self.expected();
            self.report(expected);
        }
        Some(Ok(taken.step))
    }
}

impl<'a, L, M, const N: usize> Run<N> for GuardedTrajectory<'a, L, M, N>
where
    L: ActingForce<N> + 'a,
    M: Methods<L, N>,
{
    type Scalar = L::Scalar;

    fn state(&self) -> &State<L::Scalar, N> {
        self.state()
    }

    fn time(&self) -> f64 {
        self.time()
    }
}
