//! Members on their way, by any method.

use super::clocks::Clocks;
use crate::numbers::{Compensated, CompensatedMembers, Mask, Scalar};
use crate::step::{Flow, State};
use crate::system::Gathered;

/// A system that method `M` steps in lanes.
pub trait FlowInLanes<M, const N: usize>: Sized + Gathered<N> + Flow<M, N> {
    /// Values that the method keeps of W members besides q and p.
    type Kept<const W: usize>: Copy + core::fmt::Debug;

    /// The largest W at which a member's step still got cheaper, on the machines measured.
    const MOST_LANES: usize = 32;

    /// The values kept of no member yet, for steps of size `h`.
    fn kept<const W: usize>(h: Self::Scalar) -> Self::Kept<W>;

    /// Prepares the steps of a member that stands in its lane, at its start; returns whether there are any.
    fn put<const W: usize>(runs: &mut LaneRuns<'_, Self, M, N, W>, lane: usize) -> bool;

    /// From each member's start on, what [`Memory::leave_unsolved`](crate::step::Memory::leave_unsolved)
    /// says.
    fn leave_unsolved<const W: usize>(kept: &mut Self::Kept<W>, error: f64, steps: u64) {
        let _ = (kept, error, steps);
    }

    /// All members on by this many steps. One that leaves the usual path goes by [`alone`](Self::alone).
    fn advance_in_lanes<const W: usize>(runs: &mut LaneRuns<'_, Self, M, N, W>, steps: u64);

    /// The step of one member by the functions of its own run, the time `elapsed` after its start: q and p
    /// at its end. Nothing where it fails, or where the method leaves no member alone.
    fn alone<const W: usize>(
        runs: &mut LaneRuns<'_, Self, M, N, W>,
        lane: usize,
        elapsed: Self::Scalar,
    ) -> Option<Ends<Self::Scalar, N>> {
        let _ = (runs, lane, elapsed);
        None
    }
}

/// q and p at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct Ends<T, const N: usize> {
    pub(crate) q: Compensated<T, N>,
    pub(crate) p: Compensated<T, N>,
}

impl<T: Scalar, const N: usize> From<State<T, N>> for Ends<T, N> {
    fn from(State { q, p }: State<T, N>) -> Self {
        Self { q: Compensated::new(q), p: Compensated::new(p) }
    }
}

/// W runs at once, by method `M` with one step size. Views are systems as well, each with the input that it
/// holds and at its own time: that of the view and of the steps that its run has taken, at which
/// [`velocity`](Self::velocity) and [`energy`](Self::energy) ask it.
///
/// A member that fails leaves the others as they are, and has no state from then on: its own run,
/// `system.by(method, h).run(start)`, says why.
///
/// ```
/// use dalembert::run::LaneRuns;
/// use dalembert::{Discretise, Splitting, State, rayleigh_system};
///
/// #[rayleigh_system(rule = trapezoidal, lanes = explicit)]
/// fn pendulum(q: [f64; 1], v: [f64; 1], length: f64, r: f64) -> (f64, f64) {
///     (0.5 * length * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
///
/// let pendulums = [1.0, 1.1, 1.2, 1.3].map(|length| Pendulum { length, r: 0.1 });
/// let systems = pendulums.each_ref();
/// let start = State { q: [1.0].into(), p: [0.0].into() };
/// let mut runs = LaneRuns::new(Splitting::blanes_moan_6(), systems, &[start; 4], 0.5);
/// runs.advance(1000);
/// for (lane, system) in systems.into_iter().enumerate() {
///     let alone = system.by(Splitting::blanes_moan_6(), 0.5).run(start).nth(999).unwrap()?.state;
///     assert_eq!(runs.state(lane), Some(alone));
/// }
/// # Ok::<(), dalembert::StepError>(())
/// ```
pub struct LaneRuns<'a, L, M, const N: usize, const W: usize>
where
    L: FlowInLanes<M, N>,
{
    pub(crate) systems: [&'a L; W],
    pub(crate) fields: L::Fields<'a, W>,
    pub(crate) h: L::Scalar,
    /// Members that have begun and not failed: their q and p equal those of their own runs.
    pub(crate) is_sound: Mask<W>,
    /// Members that take their first step next.
    pub(crate) is_new: Mask<W>,
    pub(crate) clocks: Clocks<W>,
    /// With rests where the method sums without loss.
    pub(crate) q: CompensatedMembers<L::Scalar, N, W>,
    pub(crate) p: CompensatedMembers<L::Scalar, N, W>,
    pub(crate) kept: L::Kept<W>,
    /// Steps that a member has taken alone.
    pub(crate) alone: u64,
}

impl<L: FlowInLanes<M, N>, M, const N: usize, const W: usize> Clone for LaneRuns<'_, L, M, N, W> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: FlowInLanes<M, N>, M, const N: usize, const W: usize> Copy for LaneRuns<'_, L, M, N, W> {}

impl<'a, L: FlowInLanes<M, N>, M, const N: usize, const W: usize> LaneRuns<'a, L, M, N, W> {
    /// No member yet.
    pub(crate) fn empty(systems: [&'a L; W], h: L::Scalar) -> Self {
        Self {
            systems,
            fields: L::fields(systems),
            h,
            is_sound: Mask::splat(false),
            is_new: Mask::splat(false),
            clocks: Clocks::new(),
            q: CompensatedMembers::zero(),
            p: CompensatedMembers::zero(),
            kept: L::kept(h),
            alone: 0,
        }
    }

    /// Puts the system of a lane there, at its start; `begins`: whether a run does.
    pub(crate) fn put(&mut self, lane: usize, start: &State<L::Scalar, N>, begins: bool) {
        self.write(lane, &Ends::from(*start));
        self.is_new.0[lane] = true;
        self.clocks.restart(lane);
        self.is_sound.0[lane] = begins && L::put(self, lane);
    }

    fn write(&mut self, lane: usize, Ends { q, p }: &Ends<L::Scalar, N>) {
        self.q.write(lane, q);
        self.p.write(lane, p);
    }

    /// Takes the step of some members, so many steps into the call, each by the functions of its own run.
    #[cold]
    #[inline(never)]
    pub(crate) fn step_alone(&mut self, whose: Mask<W>, steps: u64) {
        let elapsed = self.clocks.elapsed(steps, self.h);
        for lane in (0..W).filter(|&lane| whose.0[lane]) {
            let ends = L::alone(self, lane, elapsed.0[lane]);
            self.alone += 1;
            self.is_new.0[lane] = false;
            self.is_sound.0[lane] = ends.is_some();
            if let Some(ends) = ends {
                self.write(lane, &ends);
            }
        }
    }

    /// q and p in a lane, of whatever member.
    pub(crate) fn values(&self, lane: usize) -> State<L::Scalar, N> {
        State { q: self.q.member(lane).value, p: self.p.member(lane).value }
    }
}
