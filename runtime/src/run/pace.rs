//! The step sizes of a run that follows a time scale.

use crate::numbers::Scalar;
use crate::run::last_step::LastStep;
use crate::run::{Checkpoint, DrivenTrajectory};
use crate::step::{Flow, State, StepError};
use crate::system::TimeScale;

/// [`Pace::next`] of a system that has a time scale: compiled where a run follows it, and in no other
/// program.
type Next<L, M, const N: usize> =
    fn(&mut Pace<L, M, N>, &L, &mut DrivenTrajectory<L, M, N>) -> Result<(), StepError>;

/// How steps follow a time scale.
pub(super) struct Pace<L: Flow<M, N>, M, const N: usize> {
    next: Next<L, M, N>,
    course: Course<L::Scalar>,
    /// The course and the clock before the step that is being taken: step size, origin, steps.
    before: (Course<L::Scalar>, L::Scalar, f64, u64),
}

/// Step parameter and clock, as the steps so far leave them.
#[derive(Clone, Copy)]
struct Course<S> {
    /// Δτ; 0 while it is not known, of a run resumed.
    parameter_step: S,
    /// Whether the next step is the first, from σ itself.
    is_first: bool,
    /// The time that the clock has lost by rounding.
    rest: f64,
}

impl<L: Flow<M, N>, M, const N: usize> Pace<L, M, N> {
    pub(super) fn new(at: &Checkpoint<L::Scalar, N>) -> Self
    where
        L: TimeScale<N>,
    {
        let is_first = at.steps == 0;
        let parameter_step = if is_first { at.step_size } else { L::Scalar::constant(0.0) };
        let course = Course { parameter_step, is_first, rest: 0.0 };
        let before = (course, at.step_size, at.origin, at.steps);
        Self { next: Self::next_scaled, course, before }
    }

    /// Starts anew with Δτ.
    pub(super) fn begin(&mut self, parameter_step: L::Scalar) {
        self.course.parameter_step = parameter_step;
        self.course.is_first = true;
    }

    /// Starts anew with the same Δτ, if it is known.
    pub(super) fn begin_again(&mut self) {
        self.course.is_first = self.course.parameter_step != L::Scalar::constant(0.0);
    }

    /// Gives `run` the size of its next step, with the present time as the origin of its clock.
    ///
    /// # Errors
    /// [`StepError::TimeScale`]; those of [`State::velocity`].
    pub(super) fn next(&mut self, system: &L, run: &mut DrivenTrajectory<L, M, N>) -> Result<(), StepError> {
        (self.next)(self, system, run)
    }

    fn next_scaled(
        &mut self,
        system: &L,
        DrivenTrajectory { at, memory, .. }: &mut DrivenTrajectory<L, M, N>,
    ) -> Result<(), StepError>
    where
        L: TimeScale<N>,
    {
        let of = L::Scalar::constant;
        let time = at.time();
        let State { q, .. } = &at.state;
        let velocity = memory.velocity(system, time, &at.state)?;
        let (scale, gradient) = system.time_scale_gradient(q);
        let rate = gradient.dot(&velocity) / scale;
        let Course { mut parameter_step, is_first, mut rest } = self.course;
        let before = if is_first { parameter_step * scale } else { at.step_size };
        let density = |share: f64| of(1.0) / before - of(share) * rate;
        let h = of(1.0) / density(if is_first { 0.5 } else { 1.0 });
        let fails = Err(StepError::TimeScale { scale: scale.widen(), h: before.widen() });
        if !(scale > of(0.0) && scale.widen().is_finite()) {
            return fails;
        }
        crate::step::require_step_size(before)?;
        if !h.widen().is_finite() || (h > of(0.0)) != (before > of(0.0)) {
            return fails;
        }
        if parameter_step == of(0.0) {
            parameter_step = of(1.0) / (scale * density(0.5));
        }
        if at.steps == 1 {
            // What rounding took from origin + h (D. E. Knuth's sum of two).
            let h = at.step_size.widen();
            let part = time - at.origin;
            rest += (at.origin - (time - part)) + (h - part);
        }
        let origin = time + rest;
        rest -= origin - time;
        self.before = (self.course, at.step_size, at.origin, at.steps);
        self.course = Course { parameter_step, is_first: false, rest };
        *at = Checkpoint { state: at.state, step_size: h, origin, steps: 0 };
        Ok(())
    }

    /// Forgets what rounding took, as a run that is resumed has to.
    pub(super) fn forget(&mut self) {
        self.course.rest = 0.0;
    }

    /// Takes back what [`next`](Self::next) did: the step was not taken.
    pub(super) fn undo(&mut self, at: &mut Checkpoint<L::Scalar, N>) {
        let (course, step_size, origin, steps) = self.before;
        self.course = course;
        *at = Checkpoint { state: at.state, step_size, origin, steps };
    }
}
