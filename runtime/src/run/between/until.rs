//! Runs that end at a time.

use crate::run::Trajectory;
use crate::run::between::Restartable;
use crate::step::{Flow, Step, StepError};

/// Ending at a time.
impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// The steps of this run up to `end`, where it then stands: [`Until`].
    ///
    /// ```
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    /// }
    /// let start = State::from_velocity(&Oscillator {}, [1.0], [0.0])?;
    /// let mut run = Oscillator {}.by(Gauss::<6>, 0.5).run(start);
    /// // Three steps of 0.5, and one of 0.2.
    /// assert_eq!(run.until(1.7).filter(|step| step.is_ok()).count(), 4);
    /// assert_eq!(run.time(), 1.7);
    /// assert!((run.state().q[0] - 1.7_f64.cos()).abs() < 1e-13);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    pub fn until(&mut self, end: f64) -> Until<'_, Self, N> {
        Until::of(self, end)
    }
}

/// The steps of a run up to a time: [`Trajectory::until`].
///
/// **The end.** The last step is as long as it takes to the end, up to a thousandth longer than the others,
/// or shorter: an initial value problem's, of the order of the run. Then [`Run::time`](crate::run::Run::time)
/// is the end itself, and the steps that follow are counted from there. Where the end is a node of the grid
/// but for a few roundings (0.1 + 0.2 and 0.3), the last step is one as the others, bit by bit. A run that is
/// there takes no step, nor does one that is past it: it is not taken back.
///
/// **Structure.** A step of another size keeps what each step keeps, momenta and dissipation among them. What
/// holds of steps of one size alone, an energy that errs within bounds for ever, holds between the ends.
///
/// **Errors.** Those of the step, after which the run has ended as by any error; an `end` that is NaN is
/// [`StepError::StepSize`].
pub struct Until<'t, T, const N: usize> {
    run: &'t mut T,
    end: f64,
    has_failed: bool,
}

impl<'t, T: Restartable<N>, const N: usize> Until<'t, T, N> {
    pub(in crate::run) fn of(run: &'t mut T, end: f64) -> Self {
        Self { run, end, has_failed: false }
    }
}

impl<T: Restartable<N>, const N: usize> Iterator for Until<'_, T, N> {
    type Item = Result<Step<T::Scalar, N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.has_failed {
            return None;
        }
        let step = self.run.next_until(self.end)?;
        self.has_failed = step.is_err();
        Some(step.map(|(step, _)| step))
    }
}
