//! The states of a run at times that are given.

use core::fmt;

use crate::numbers::Scalar;
use crate::run::between::{Dense, Divisible, on_clock};
use crate::run::{Sample, Trajectory};
use crate::step::{Flow, StepError};

/// Times beside the grid's.
impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// The states at `times`, in the order of the run, to its own order: [`SampledAt`].
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
    /// // A sensor 30 times a second beside steps of half a second.
    /// for sample in run.sample_at((0..300).map(|k| f64::from(k) / 30.0)) {
    ///     let sample = sample?;
    ///     assert!((sample.state.q[0] - sample.time.cos()).abs() < 1e-13);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sample_at<I>(&mut self, times: I) -> SampledAt<'_, Self, N, I::IntoIter>
    where
        I: IntoIterator<Item = f64>,
    {
        SampledAt::of(self, times)
    }
}

/// The states of a run at given times: [`Trajectory::sample_at`].
///
/// Each is [`Dense::state_at`] that time; on the grid it is the grid's own, and a time that is off the run's
/// clock by no more than a few roundings is on it: 0.1 + 0.2 neither takes another step than 0.3 nor comes
/// too late. (A sum of a thousand periods is off by more: multiply.) The run stands at the end of the step
/// that the last time lies in, bit by bit where it would stand without having been asked. Times follow the
/// run, backwards where h < 0; one may be asked for twice. An error is the last item.
pub struct SampledAt<'t, T: Divisible<N>, const N: usize, I> {
    dense: Dense<'t, T, N>,
    times: I,
    /// The time asked for last.
    asked: f64,
    ended: bool,
}

impl<'t, T: Divisible<N>, const N: usize, I> SampledAt<'t, T, N, I> {
    pub(in crate::run) fn of<A>(run: &'t mut T, times: A) -> Self
    where
        A: IntoIterator<Item = f64, IntoIter = I>,
    {
        let asked = run.time();
        Self { dense: Dense::new(run), times: times.into_iter(), asked, ended: false }
    }

    /// The sample at `time`; `None` where the run has ended before.
    fn sample(&mut self, time: f64) -> Result<Option<Sample<T::Scalar, N>>, TimeError> {
        let backwards = self.dense.run.step_size() < T::Scalar::constant(0.0);
        let on_clock = on_clock(time, self.dense.run.time());
        let is_before = if backwards { on_clock > self.asked } else { on_clock < self.asked };
        if !time.is_finite() || is_before {
            return Err(TimeError::NotSorted { time, after: self.asked });
        }
        self.asked = on_clock;
        let (mut iterations, mut damped, mut worst_residual) = (0, 0, 0.0_f64);
        while !self.dense.has_reached(time) {
            let report = match self.dense.next() {
                Some(step) => step?.report,
                None => return Ok(None),
            };
            iterations += u64::from(report.iterations);
            damped += u64::from(report.damped > 0);
            if report.residual > T::Scalar::constant(0.0) {
                worst_residual = worst_residual.max((report.residual / report.floor).widen());
            }
        }
        let state = self.dense.state_at(time)?;
        let previous = self.dense.start.map_or(state.q, |start| start.state.q);
        let since = self.dense.since();
        Ok(Some(Sample { time, state, previous, iterations, damped, worst_residual, since }))
    }
}

impl<T, const N: usize, I> Iterator for SampledAt<'_, T, N, I>
where
    T: Divisible<N>,
    I: Iterator<Item = f64>,
{
    type Item = Result<Sample<T::Scalar, N>, TimeError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let time = self.times.next()?;
        let sample = self.sample(time).transpose();
        self.ended = !matches!(sample, Some(Ok(_)));
        sample
    }
}

/// Why there is no state at a time.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum TimeError {
    /// The run's own step failed, or the one to the time asked for.
    Step(StepError),
    /// The time is not one of the last step.
    Outside {
        /// The time asked for.
        time: f64,
        /// The start of the last step.
        from: f64,
        /// Its end.
        to: f64,
    },
    /// Times were not given in the order of the run, or one is not finite.
    NotSorted {
        /// The time asked for.
        time: f64,
        /// The one before; at first the time of the run.
        after: f64,
    },
}

impl From<StepError> for TimeError {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl fmt::Display for TimeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(error) => error.fmt(f),
            Self::Outside { time, from, to } => write!(
                f,
                "the time {time} is not one of the last step, from {from} to {to}; take steps until it is"
            ),
            Self::NotSorted { time, after } => write!(
                f,
                "the time {time} does not come after {after}, or is not finite; give finite times in the order of \
                 the run, from its present time on"
            ),
        }
    }
}

debug_by_display!(TimeError);

impl core::error::Error for TimeError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        if let Self::Step(error) = self { Some(error) } else { None }
    }
}
