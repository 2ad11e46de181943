//! Looking into the steps of a guarded run.

use super::{GuardedTrajectory, Methods};
use crate::numbers::Scalar;
use crate::run::between::{Dense, Divisible, LastStep, Moment, SampledAt};
use crate::run::events::Watch;
use crate::system::ActingForce;

/// Between the steps, and events: as of every run, but that it cannot be restarted, since the error that it
/// carries along is that of one motion. Where a motion goes on from an impact, ask for a run of its own
/// there.
impl<'a, L, M, const N: usize> GuardedTrajectory<'a, L, M, N>
where
    L: ActingForce<N> + 'a,
    M: Methods<L, N>,
{
    /// This run as one that answers for all times of its last step: [`Dense`].
    pub fn dense(&mut self) -> Dense<'_, Self, N> {
        Dense::new(self)
    }

    /// The states at `times`, in the order of the run: [`SampledAt`]. Their error is that of the steps.
    pub fn sample_at<I>(&mut self, times: I) -> SampledAt<'_, Self, N, I::IntoIter>
    where
        I: IntoIterator<Item = f64>,
    {
        SampledAt::of(self, times)
    }

    /// Watches this run for the events that the functions `g` vanish: [`Watch`], until it ends.
    ///
    /// ```
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    /// }
    /// let start = State::from_velocity(&Oscillator {}, [1.0], [0.0])?;
    /// let mut run = Oscillator {}.to_error(1e-9).until(100.0).run(start)?;
    /// for (k, zero) in run.watch(|at| [at.q[0]]).enumerate() {
    ///     assert!((zero?.time - (k as f64 + 0.5) * std::f64::consts::PI).abs() < 1e-9);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn watch<G, const K: usize>(&mut self, g: G) -> Watch<'_, Self, G, N, K>
    where
        G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K],
    {
        Watch::new(self, g)
    }
}

impl<'a, L, M, const N: usize> Divisible<N> for GuardedTrajectory<'a, L, M, N>
where
    L: ActingForce<N> + 'a,
    M: Methods<L, N>,
{
    type System = L;

    fn system(&self) -> &L {
        self.choice.system
    }

    fn step_size(&self) -> L::Scalar {
        L::Scalar::constant(self.step_size())
    }

    fn last_step(&self) -> &dyn LastStep<L, N> {
        self.last()
    }
}
