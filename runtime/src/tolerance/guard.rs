//! The guard along the run of a choice.

use core::fmt;

use nalgebra::SVector;

use super::{Choice, MethodRun, Methods};
use crate::{Lagrangian, Scalar, State, StepError};

/// Where the estimate no longer held.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Breach {
    /// The time.
    pub time: f64,
    /// The error to be expected at the end if the whole run were like this step.
    pub expected: f64,
    /// The error asked for.
    pub tolerance: f64,
}

/// Steps between two looks of the guard: a look costs three steps.
const LOOK_EVERY: u64 = 32;

/// The run of a [`Choice`] over its time: an iterator over states, that ends after the last step or an error.
///
/// The guard compares one step with two half ones: every 32 steps, and where the fourth differences of q rise to twice what
/// they were so far, which costs nothing to see. Where the step and its halves differ so much more than at the start that the
/// error expected would exceed the tolerance, it notes a [`Breach`]; the run goes on, with the same step size.
pub struct GuardedTrajectory<'a, L, M, const N: usize>
where
    L: Lagrangian<N> + 'a,
    M: Methods<L, N>,
{
    choice: Choice,
    system: &'a L,
    methods: M,
    run: M::Run<'a>,
    taken: u64,
    /// The configurations before the present one, the latest first.
    recent: [SVector<L::Scalar, N>; 4],
    /// The largest fourth difference so far.
    largest: L::Scalar,
    breach: Option<Breach>,
    failed: bool,
}

impl<'a, L, M, const N: usize> GuardedTrajectory<'a, L, M, N>
where
    L: Lagrangian<N>,
    M: Methods<L, N>,
{
    pub(super) fn new(choice: Choice, system: &'a L, methods: M, start: State<L::Scalar, N>) -> Self {
        let run = methods.run(choice.method, system, L::Scalar::constant(choice.step_size), start);
        Self {
            choice,
            system,
            methods,
            run,
            taken: 0,
            recent: [start.q; 4],
            largest: L::Scalar::constant(0.0),
            breach: None,
            failed: false,
        }
    }

    /// The present state.
    pub fn state(&self) -> &State<L::Scalar, N> {
        self.run.state()
    }

    /// The time, h × the number of steps taken.
    pub fn time(&self) -> f64 {
        self.choice.step_size * self.taken as f64
    }

    /// The worst breach of the estimate so far; `None` while it holds.
    pub fn breach(&self) -> Option<&Breach> {
        self.breach.as_ref()
    }

    /// |q after one step − q after two half ones| from `state`, which the run has after `steps` steps.
    pub(super) fn local_error(&self, state: &State<L::Scalar, N>, steps: u64) -> Result<f64, StepError> {
        let (method, h) = (self.choice.method, L::Scalar::constant(self.choice.step_size));
        let elapsed = L::Scalar::constant(self.choice.step_size * steps as f64);
        self.system.later(elapsed, |system| {
            let mut whole = self.methods.run(method, system, h, *state);
            let mut halves = self.methods.run(method, system, h * L::Scalar::constant(0.5), *state);
            whole.advance()?;
            halves.advance()?;
            halves.advance()?;
            Ok((whole.state().q - halves.state().q).amax().widen())
        })
    }

    pub(super) fn advance(&mut self) -> Result<(), StepError> {
        self.run.advance()?;
        self.taken += 1;
        Ok(())
    }

    /// Whether the motion has become twice as rough as it was so far, by the fourth differences of q.
    fn is_rougher(&mut self) -> bool {
        let q = self.state().q;
        let [a, b, c, d] = self.recent;
        let (four, six) = (L::Scalar::constant(4.0), L::Scalar::constant(6.0));
        let difference = ((q + d) - (a + c) * four + b * six).amax();
        self.recent = [q, a, b, c];
        let rougher = self.taken >= 4 && difference > self.largest * L::Scalar::constant(2.0);
        if self.taken >= 4 && difference > self.largest {
            self.largest = difference;
        }
        rougher
    }

    /// Holds the last step, from `state`, against its halves; halves that cannot be taken are a breach too.
    fn look(&mut self, state: &State<L::Scalar, N>) {
        // Differences below rounding compare with nothing.
        let rounding = 16.0 * L::Scalar::EPSILON.widen() * state.q.amax().widen();
        let local = self
            .local_error(state, self.taken - 1)
            .ok()
            .filter(|local| !local.is_nan())
            .unwrap_or(f64::INFINITY);
        let expected = self.choice.expected * (local / self.choice.local.max(rounding));
        let worst = self.breach.map_or(self.choice.tolerance, |breach| breach.expected);
        if expected > worst {
            self.breach = Some(Breach { time: self.time(), expected, tolerance: self.choice.tolerance });
        }
    }
}

impl<L, M, const N: usize> Iterator for GuardedTrajectory<'_, L, M, N>
where
    L: Lagrangian<N>,
    M: Methods<L, N>,
{
    type Item = Result<State<L::Scalar, N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed || self.taken == self.choice.steps {
            return None;
        }
        let before = *self.state();
        let stepped = self.advance();
        self.failed = stepped.is_err();
        if stepped.is_ok() && (self.is_rougher() || self.taken.is_multiple_of(LOOK_EVERY)) {
            self.look(&before);
        }
        Some(stepped.map(|()| *self.state()))
    }
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the estimate made at the start no longer holds at t = {:.4}: {:.1e} to be expected, {:.1e} asked for; ask for less \
             from there, or take a smaller step",
            self.time, self.expected, self.tolerance
        )
    }
}
