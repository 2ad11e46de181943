//! State at any time, of runs by every method: between the nodes of the grid, without leaving it.

mod moment;
mod times;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::rules::Gauss;
use crate::run::Trajectory;
use crate::step::{Flow, Memory, State, Step, StepError};
pub use moment::Moment;
pub use times::{SampledAt, TimeError};

/// Looking between the steps.
impl<'a, L, M, const N: usize> Trajectory<'a, L, M, N>
where
    L: Flow<M, N>,
{
    /// This run as one that answers for all times of its last step, not only for the ends: [`Dense`].
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
    /// let mut dense = run.dense();
    /// for _ in 0..10 {
    ///     dense.next().unwrap()?;
    /// }
    /// // The last step led from 4.5 to 5.
    /// let state = dense.state_at(4.7)?; // to the order of the run, by a step
    /// assert!((state.q[0] - 4.7_f64.cos()).abs() < 1e-13);
    /// let near = dense.interpolated_at(4.7)?; // for nothing, by the polynomial of the stages
    /// assert!((near.q[0] - 4.7_f64.cos()).abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn dense(&mut self) -> Dense<'_, 'a, L, M, N> {
        Dense { run: self, start: None }
    }
}

/// A run whose last step can be looked into: [`Trajectory::dense`].
///
/// An iterator over the very steps of the run, bit by bit: what is asked between them leaves no trace. Two
/// answers:
///
/// | | order | costs |
/// |---|---|---|
/// | [`state_at`](Self::state_at) | that of the run | a step, from the start of the last one |
/// | [`interpolated_at`](Self::interpolated_at), by a [`Gauss`] rule of S ≥ 3 stages | S + 1 | nothing but a polynomial |
/// | the same by other methods | 4 at most, and that of the run | the velocities at both ends |
///
/// Gauss rules of three stages and more have the collocation polynomial, v = Σ ℓ_j V_j and q = q0 + h Σ V_j ∫ℓ_j,
/// the others the cubic through (q, v) at both ends. Where the run has structure to keep, the state between should be asked of
/// [`state_at`](Self::state_at): a step keeps what steps keep, a polynomial does not.
pub struct Dense<'t, 'a, L, M, const N: usize>
where
    L: Flow<M, N>,
{
    run: &'t mut Trajectory<'a, L, M, N>,
    start: Option<Start<L::Scalar, N>>,
}

/// Where the last step began.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<S, const N: usize> {
    pub(super) state: State<S, N>,
    pub(super) time: f64,
    /// The step's mean velocity.
    pub(super) mean: SVector<S, N>,
}

impl<'a, L, M, const N: usize> Dense<'_, 'a, L, M, N>
where
    L: Flow<M, N>,
{
    /// Whether the method has a polynomial of its own that is better than the cubic through both ends.
    pub(super) const COLLOCATED: bool = <L::RunMemory as Memory<L, M, N>>::NODES.len() > 2;

    /// Shares of a step at which it is looked at between its ends.
    pub(super) const NODES: &'static [f64] =
        if Self::COLLOCATED { <L::RunMemory as Memory<L, M, N>>::NODES } else { &Gauss::<2>::NODES };

    /// The run, at the end of the last step.
    #[must_use]
    pub fn run(&self) -> &Trajectory<'a, L, M, N> {
        self.run
    }

    /// The times of the last step's start and end; `None` before the first.
    #[must_use]
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.start.map(|start| [start.time, self.run.time()])
    }

    /// The state at a time of the last step, to the order of the run: by a step from where the last one
    /// began. At the ends it is that of the grid, bit by bit.
    ///
    /// # Errors
    /// [`TimeError::Outside`]; [`TimeError::Step`] where a shorter step has no solution although the whole one
    /// has.
    pub fn state_at(&self, time: f64) -> Result<State<L::Scalar, N>, TimeError> {
        let start = self.start_before(time)?;
        if time == self.run.time() {
            return Ok(*self.run.state());
        }
        Ok(self.partial(&start, L::Scalar::constant(time - start.time))?)
    }

    /// (q, v) at a time of the last step, by a polynomial.
    ///
    /// # Errors
    /// [`TimeError::Outside`]; those of [`State::velocity`], as [`TimeError::Step`].
    pub fn interpolated_at(&self, time: f64) -> Result<Moment<'a, L, N>, TimeError> {
        let start = self.start_before(time)?;
        let share = (time - start.time) / self.run.step_size().widen();
        let of_method = if Self::COLLOCATED {
            self.run.memory.between(&start.state.q, self.run.step_size(), share)
        } else {
            None
        };
        let [q, v] = match of_method {
            Some(at) => at,
            None => {
                let at_start = self.velocity(start.time, &start.state)?;
                let at_end = self.velocity(self.run.time(), self.run.state())?;
                cubic(&start, self.run.step_size(), &[at_start, at_end], share)
            }
        };
        Ok(Moment::interpolated(self.run.system, time, q, v))
    }

    fn start_before(&self, time: f64) -> Result<Start<L::Scalar, N>, TimeError> {
        let now = self.run.time();
        match self.start {
            Some(start) if start.time.min(now) <= time && time <= start.time.max(now) => Ok(start),
            start => Err(TimeError::Outside { time, from: start.map_or(now, |start| start.time), to: now }),
        }
    }

    /// The system.
    pub(super) fn system(&self) -> &'a L {
        self.run.system
    }

    pub(super) fn start(&self) -> Option<&Start<L::Scalar, N>> {
        self.start.as_ref()
    }

    /// Leaves the grid: the run goes on from `state` at `time`.
    pub(super) fn restart_at(&mut self, time: f64, state: State<L::Scalar, N>) {
        self.run.restart_at(time, state);
        self.start = None;
    }

    /// The state `elapsed` after the start of the last step.
    pub(super) fn partial(
        &self,
        start: &Start<L::Scalar, N>,
        elapsed: L::Scalar,
    ) -> Result<State<L::Scalar, N>, StepError> {
        if elapsed == L::Scalar::constant(0.0) {
            return Ok(start.state);
        }
        let step = |system: &L| system.step(&start.state, elapsed, Some(&start.mean));
        self.run.system.later(L::Scalar::constant(start.time), step).map(|step| step.state)
    }

    /// The velocity of a state of the run.
    #[inline]
    pub(super) fn velocity(
        &self,
        time: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<SVector<L::Scalar, N>, StepError> {
        match self.run.memory.velocity(state) {
            Some(velocity) => Ok(velocity),
            None => self.run.system.later(L::Scalar::constant(time), |system| state.velocity(system)),
        }
    }

    /// Calls `visit` with the last step's moments at [`NODES`](Self::NODES); `ends` are the velocities there,
    /// asked for where the method has no polynomial.
    #[inline(always)]
    pub(super) fn at_nodes(
        &self,
        start: &Start<L::Scalar, N>,
        ends: &[SVector<L::Scalar, N>; 2],
        mut visit: impl FnMut(usize, &Moment<'a, L, N>),
    ) {
        let (system, h) = (self.run.system, self.run.step_size());
        let time = |share: f64| start.time + share * h.widen();
        if Self::COLLOCATED {
            self.run.memory.at_nodes(&start.state.q, h, |i, q, v| {
                let share = Self::NODES.get(i).copied().unwrap_or(1.0);
                visit(i, &Moment::interpolated(system, time(share), *q, *v));
            });
        } else {
            for (i, &share) in Self::NODES.iter().enumerate() {
                let [q, v] = cubic(start, h, ends, share);
                visit(i, &Moment::interpolated(system, time(share), q, v));
            }
        }
    }
}

/// (q, v) at a share τ of a step, by the cubic with q and v at both ends.
#[inline(always)]
fn cubic<S: Scalar, const N: usize>(
    start: &Start<S, N>,
    h: S,
    [v0, v1]: &[SVector<S, N>; 2],
    share: f64,
) -> [SVector<S, N>; 2] {
    let of = S::constant;
    let rest = 1.0 - share;
    let (mean, bend) = (start.mean, share * rest);
    // q0 + τh [v̄ + (1 − τ)((1 − τ)(v0 − v̄) − τ (v1 − v̄))], and its derivative.
    let (at_start, at_end) = (v0 - mean, v1 - mean);
    let q = mean * of(share) + at_start * of(bend * rest) - at_end * of(bend * share);
    let v = mean + at_start * of(rest * (1.0 - 3.0 * share)) + at_end * of(share * (3.0 * share - 2.0));
    [start.state.q + q * h, v]
}

impl<L, M, const N: usize> Iterator for Dense<'_, '_, L, M, N>
where
    L: Flow<M, N>,
{
    type Item = Result<Step<L::Scalar, N>, StepError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let (state, time) = (*self.run.state(), self.run.time());
        let step = self.run.next();
        if let Some(Ok(step)) = &step {
            self.start = Some(Start { state, time, mean: step.velocity });
        }
        step
    }
}
