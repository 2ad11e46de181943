//! Runs by steps of several parts, of one size.

use crate::run::{Checkpoint, Course};
use crate::step::{State, StepError};
use crate::system::Lagrangian;

/// A step that is made of several, with what it keeps for the next: substeps of a
/// [`Composition`](crate::Composition), kicks and drifts of a [`Splitting`](crate::Splitting).
pub trait ComposedStep<L: Lagrangian<N>, const N: usize> {
    /// The step from `state`, `elapsed` after the time of `system`.
    ///
    /// # Errors
    /// Those of its parts.
    fn advance(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<State<L::Scalar, N>, StepError>;

    /// Lets go of what it has kept of the steps before.
    fn forget(&mut self);
}

/// The trajectory of a system by a [`Composition`](crate::Composition) or a [`Splitting`](crate::Splitting),
/// one whole step at a time.
///
/// An iterator over states. After an error it ends, its state being the last good one.
pub struct ComposedTrajectory<'a, L, C, const N: usize>
where
    L: Lagrangian<N>,
{
    system: &'a L,
    step: C,
    at: Checkpoint<L::Scalar, N>,
    course: Course,
}

impl<'a, L, C, const N: usize> ComposedTrajectory<'a, L, C, N>
where
    L: Lagrangian<N>,
    C: ComposedStep<L, N>,
{
    /// From where `checkpoint` was taken.
    pub(crate) fn new(system: &'a L, step: C, checkpoint: Checkpoint<L::Scalar, N>) -> Self {
        Self { system, step, at: checkpoint, course: Course::Starting }
    }

    /// The present state: that of the last step that succeeded.
    pub fn state(&self) -> &State<L::Scalar, N> {
        &self.at.state
    }

    /// The step size h, of all parts together.
    pub fn step_size(&self) -> L::Scalar {
        self.at.step_size
    }

    /// The time, h × the number of steps taken (and where a run that was resumed began).
    pub fn time(&self) -> f64 {
        self.at.time()
    }

    /// All that is needed to go on from here, in this process or another
    /// ([`Composition::resume`](crate::Composition::resume),
    /// [`Splitting::resume`](crate::Splitting::resume)).
    ///
    /// The run forgets what its parts remember, as one that is resumed has to: both go on bit by bit alike.
    ///
    /// ```
    /// use dalembert::{Composition, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] + q[0].cos()
    /// }
    /// let start = State::from_velocity(&Pendulum {}, [1.0], [0.0])?;
    /// let method = Composition::kahan_li_6(Midpoint);
    /// let mut run = method.trajectory(&Pendulum {}, 0.2, start);
    /// run.by_ref().take(100).for_each(|state| assert!(state.is_ok()));
    /// let resumed = method.resume(&Pendulum {}, run.checkpoint());
    /// assert!(resumed.time() == run.time() && resumed.take(100).eq(run.take(100)));
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    pub fn checkpoint(&mut self) -> Checkpoint<L::Scalar, N> {
        self.step.forget();
        self.at
    }
}

impl<L, C, const N: usize> Iterator for ComposedTrajectory<'_, L, C, N>
where
    L: Lagrangian<N>,
    C: ComposedStep<L, N>,
{
    type Item = Result<State<L::Scalar, N>, StepError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if let Some(stop) = self.course.stop(self.system, &self.at) {
            return stop.map(Err);
        }
        let state = self.step.advance(self.system, self.time(), &self.at.state);
        match &state {
            Ok(state) => self.at.follow(state),
            Err(_) => self.course = Course::Ended,
        }
        Some(state)
    }
}
