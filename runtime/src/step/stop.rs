//! How a caller ends what takes long.

use core::fmt;

/// How a caller ends what takes long: a function that is asked from time to time whether to end.
///
/// It is asked often: it reads a flag, say, or looks at the clock. Once it has said yes it has to keep to it.
/// No step asks; what takes many does, between steps, and then says in its result that it was stopped.
///
/// ```
/// use std::time::{Duration, Instant};
///
/// use dalembert::run::Stop;
/// use dalembert::tolerance::ToleranceError;
/// use dalembert::{Discretise, State, rayleigh_system};
///
/// #[rayleigh_system(rule = [trapezoidal, gauss])]
/// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
/// }
/// let start = State::from_velocity(&Oscillator {}, [1.0], [0.0])?;
/// let begun = Instant::now();
/// let is_late = || begun.elapsed() > Duration::from_millis(50);
/// let request = Oscillator {}.to_error(1e-9).until(1e8).at_most(1 << 40);
/// let stopped = request.stopped_by(Stop::when(&is_late)).end(&start);
/// assert_eq!(stopped.unwrap_err(), ToleranceError::Stopped);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Default)]
pub struct Stop<'s>(Option<&'s (dyn Fn() -> bool + Sync)>);

impl<'s> Stop<'s> {
    /// Steps from one time that it is asked to the next, where a run takes many.
    pub const STRIDE: u64 = 64;

    /// Goes on to the end.
    pub(crate) const fn never() -> Self {
        Self(None)
    }

    /// Ends as soon as `is_asked` says so.
    #[must_use]
    pub const fn when(is_asked: &'s (dyn Fn() -> bool + Sync)) -> Self {
        Self(Some(is_asked))
    }

    /// Whether to end.
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.0.is_some_and(|is_asked| is_asked())
    }
}

impl fmt::Debug for Stop<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Stop::when(…)" } else { "Stop::never()" })
    }
}
