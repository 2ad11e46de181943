//! Runs of every kind, and their samples.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{State, Step, StepError};
use crate::system::Lagrangian;

/// A run of steps, whatever makes them: a [`Trajectory`](crate::Trajectory), or one that carries its error
/// along ([`GuardedTrajectory`](crate::tolerance::GuardedTrajectory)).
pub trait Run<const N: usize>: Iterator<Item = Result<Step<<Self as Run<N>>::Scalar, N>, StepError>> {
    /// `f64` or `f32`.
    type Scalar: Scalar;

    /// The present state: that of the last step that succeeded.
    fn state(&self) -> &State<Self::Scalar, N>;

    /// Its time.
    fn time(&self) -> f64;
}

/// A state recorded on a trajectory.
///
/// It knows its time: [`velocity`](Self::velocity) and [`energy`](Self::energy) are asked of the system that
/// the run was begun with, whatever time that has.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sample<S, const N: usize> {
    /// The time of the state.
    pub time: f64,
    /// The state.
    pub state: State<S, N>,
    /// Configuration one step before; with `state.q` it makes the last segment.
    pub previous: SVector<S, N>,
    /// Newton iterations since the last sample, all steps together.
    pub iterations: u64,
    /// Steps since the last sample whose Newton step had to be shortened.
    pub damped: u64,
    /// Largest residual since the last sample, in units of its round-off floor.
    pub worst_residual: f64,
    /// The time of the run at which its system has its own.
    pub(super) since: f64,
}

impl<S: Scalar, const N: usize> Sample<S, N> {
    /// The velocity. `system` is the one that the run was begun with: a view is asked at the time of the
    /// sample, not at its own.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn velocity<L>(&self, system: &L) -> Result<SVector<S, N>, StepError>
    where
        L: Lagrangian<N, Scalar = S>,
    {
        system.later(S::constant(self.time - self.since), |system| self.state.velocity(system))
    }

    /// The energy. `system` is the one that the run was begun with: a view is asked at the time of the
    /// sample, not at its own.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// struct Growing;
    ///
    /// #[rayleigh_system]
    /// impl Growing {
    ///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
    ///         0.5 * (1.0 + t) * v[0] * v[0]
    ///     }
    /// }
    ///
    /// let view = Growing.at_time(0.0);
    /// let mut run = view.by(Midpoint, 0.1).run(State { q: [0.0].into(), p: [1.0].into() });
    /// for sample in run.sample_every(10).take(3) {
    ///     let sample = sample?;
    ///     assert!((sample.energy(&view)? - 0.5 / (1.0 + sample.time)).abs() < 1e-15);
    /// }
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn energy<L>(&self, system: &L) -> Result<S, StepError>
    where
        L: Lagrangian<N, Scalar = S>,
    {
        system.later(S::constant(self.time - self.since), |system| self.state.energy(system))
    }
}

/// Iterator over every k-th state of a run: [`Trajectory::sample_every`](crate::Trajectory::sample_every).
pub struct Samples<'t, T, const N: usize> {
    run: &'t mut T,
    stride: u64,
}

impl<'t, T, const N: usize> Samples<'t, T, N> {
    pub(crate) fn new(run: &'t mut T, stride: u64) -> Self {
        Self { run, stride: stride.max(1) }
    }
}

impl<T: Run<N>, const N: usize> Iterator for Samples<'_, T, N> {
    type Item = Result<Sample<T::Scalar, N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        let (mut iterations, mut damped, mut worst_residual) = (0, 0, 0.0_f64);
        let mut previous = self.run.state().q;
        for taken in 0..self.stride {
            let before = self.run.state().q;
            let report = match self.run.next() {
                Some(Ok(step)) => step.report,
                Some(Err(error)) => return Some(Err(error)),
                None if taken == 0 => return None,
                None => break,
            };
            previous = before;
            iterations += u64::from(report.iterations);
            damped += u64::from(report.damped > 0);
            if report.residual > T::Scalar::constant(0.0) {
                worst_residual = worst_residual.max((report.residual / report.floor).widen());
            }
        }
        let (time, state) = (self.run.time(), *self.run.state());
        // Runs that are sampled so have the time of their system at 0.
        Some(Ok(Sample { time, state, previous, iterations, damped, worst_residual, since: 0.0 }))
    }
}
