//! Members many at a time, in the widest instructions that the machine has.

use core::ops::ControlFlow;

use dalembert::run::{LaneRuns, Stop};
use dalembert::step::{FlowInLanes, MethodOf};
use dalembert::system::Scalar;
use dalembert::{Lagrangian, State};
use multiversion::multiversion;
use multiversion::target::match_target;

use crate::member::{Failure, Record, caught};
use crate::stepping::{Plan, Slot, Started, Stepping, failed};

/// As many members at a time as the machine has lanes for: [`Study::in_lanes`](crate::Study::in_lanes).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideBySide<M, S> {
    pub(crate) method: M,
    pub(crate) plan: Plan<S>,
}

impl<M, S> SideBySide<M, S> {
    /// By this method and plan.
    #[must_use]
    pub const fn new(method: M, plan: Plan<S>) -> Self {
        Self { method, plan }
    }
}

/// Work that is compiled for several instruction sets.
trait Versioned {
    /// Does it, in a set that `MOST` members at a time keep the registers of full; returns `MOST`. To be
    /// inlined.
    fn work<const MOST: usize>(self) -> usize;
}

/// The work in the widest instructions of the machine, found when the program runs. How many members their
/// registers take is as measured by `cargo bench -p dalembert-benches --bench lanes`.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma",
    "x86_64+avx2+fma",
    "aarch64+neon"
))]
fn in_widest<V: Versioned>(versioned: V) -> usize {
    match_target! {
        "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma" => versioned.work::<32>(),
        "x86_64+avx2+fma" => versioned.work::<16>(),
        _ => versioned.work::<8>(),
    }
}

/// The number of members alone.
struct Widest;

impl Versioned for Widest {
    #[inline(always)]
    fn work<const MOST: usize>(self) -> usize {
        MOST
    }
}

/// Runs that go on by so many steps.
struct Advance<'r, 's, L: FlowInLanes<M, N>, M, const N: usize, const W: usize> {
    runs: &'r mut LaneRuns<'s, L, M, N, W>,
    steps: u64,
}

impl<L: FlowInLanes<M, N>, M, const N: usize, const W: usize> Versioned for Advance<'_, '_, L, M, N, W> {
    #[inline(always)]
    fn work<const MOST: usize>(self) -> usize {
        // Compiled for the one set that takes so many at a time.
        if const { W == width::<L, M, N>(MOST) } {
            self.runs.advance(self.steps);
        }
        MOST
    }
}

/// Most bytes of the runs of one group: they stand on the stack, of which a thread may have 2 MiB, and are to
/// stay in the cache.
const MOST_BYTES: usize = 256 * 1024;

/// Steps after which it is asked whether a lane has failed, and whether all are to end, however far the next
/// record is.
const LONG: u64 = 512;

/// Members at a time, of at most so many: 8, or as many more as the method takes while their runs stay small.
const fn width<L: FlowInLanes<M, N>, M, const N: usize>(most: usize) -> usize {
    if most >= 32 && fits::<L, M, N, 32>() {
        32
    } else if most >= 16 && fits::<L, M, N, 16>() {
        16
    } else {
        8
    }
}

/// Whether the method takes W members at a time, and their runs stay small.
const fn fits<L: FlowInLanes<M, N>, M, const N: usize, const W: usize>() -> bool {
    W <= L::MOST_LANES && size_of::<LaneRuns<'_, L, M, N, W>>() <= MOST_BYTES
}

/// A member on its way in a lane, or waiting for one.
pub(crate) trait InLane<'s, L: Lagrangian<N>, const N: usize> {
    fn system(&self) -> &'s L;

    fn start(&self) -> State<L::Scalar, N>;

    /// Steps from its start to where it is first looked at.
    fn first(&self) -> u64;

    /// Looks at the member, which has come to `state`; how many steps on it is looked at again, if it goes
    /// on. Breaks where all end.
    fn look(&mut self, state: State<L::Scalar, N>) -> ControlFlow<(), Option<u64>>;

    /// Makes the run of a member whose lane does not tell, from its start, which has the lane's states up
    /// to there. Records that were observed are not observed again. Breaks where all end.
    fn alone(&mut self, stop: Stop<'_>) -> ControlFlow<()>;
}

/// `observe` for a run that is made again from its start: the first records were `seen`, and are not observed
/// again.
pub(crate) fn unseen<L: Lagrangian<N>, const N: usize>(
    seen: u64,
    mut observe: impl FnMut(&Record<'_, L, N>) -> ControlFlow<()>,
) -> impl FnMut(&Record<'_, L, N>) -> ControlFlow<()> {
    let mut records = 0;
    move |record: &Record<'_, L, N>| {
        records += 1;
        if records > seen { observe(record) } else { ControlFlow::Continue(()) }
    }
}

/// A member that is observed at its records.
struct OnItsWay<'s, 'p, L: Lagrangian<N>, M, V, O, const N: usize> {
    by: &'p SideBySide<M, L::Scalar>,
    observe: &'p O,
    number: u64,
    system: &'s L,
    start: State<L::Scalar, N>,
    value: &'s mut V,
    failure: &'s mut Option<Failure<L::Scalar, N>>,
    /// Records that were observed.
    seen: u64,
    /// Steps at its next record.
    next: u64,
}

impl<'s, L, M, V, O, const N: usize> InLane<'s, L, N> for OnItsWay<'s, '_, L, M, V, O, N>
where
    L: FlowInLanes<M, N>,
    M: Copy + MethodOf<L, N>,
    O: Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
{
    fn system(&self) -> &'s L {
        self.system
    }

    fn start(&self) -> State<L::Scalar, N> {
        self.start
    }

    fn first(&self) -> u64 {
        self.next
    }

    fn look(&mut self, state: State<L::Scalar, N>) -> ControlFlow<(), Option<u64>> {
        let Plan { h, steps: all, every, .. } = self.by.plan;
        let (number, system, steps) = (self.number, self.system, self.next);
        let time = if steps == 0 { 0.0 } else { h.widen() * steps as f64 };
        let record = Record { number, system, steps, time, state, event: None };
        let observed = (self.observe)(self.value, &record);
        self.seen += 1;
        if observed.is_break() || steps == all {
            return ControlFlow::Continue(None);
        }
        self.next = all.min(steps.saturating_add(every.unwrap_or(all).max(1)));
        ControlFlow::Continue(Some(self.next - steps))
    }

    #[cold]
    fn alone(&mut self, stop: Stop<'_>) -> ControlFlow<()> {
        let SideBySide { method, plan } = self.by;
        let observe = unseen(self.seen, |record: &Record<'_, L, N>| (self.observe)(self.value, record));
        *self.failure = failed(plan.run(*method, (self.number, self.system, &self.start), observe, stop))?;
        ControlFlow::Continue(())
    }
}

impl<L, M, const N: usize> Stepping<L, N> for SideBySide<M, L::Scalar>
where
    L: FlowInLanes<M, N>,
    M: Copy + Sync + MethodOf<L, N>,
{
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        let Plan { steps, every, .. } = self.plan;
        let next = if every.is_some() { 0 } else { steps };
        let waiting = members.iter_mut().filter_map(Slot::started).map(|member| {
            let Started { number, system, start, value, failure } = member;
            OnItsWay { by: self, observe, number, system, start, value, failure, seen: 0, next }
        });
        self.advance_in_lanes(waiting, stop)
    }

    fn description(&self) -> String {
        self.plan.description::<M>()
    }

    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        self.plan.first_step(self.method, system, start)
    }
}

impl<M: Copy, S: Scalar> SideBySide<M, S> {
    /// Members that wait for lanes, as many at a time as the machine has.
    pub(crate) fn advance_in_lanes<'s, L, T, const N: usize>(
        &self,
        waiting: impl Iterator<Item = T>,
        stop: Stop<'_>,
    ) -> ControlFlow<()>
    where
        L: FlowInLanes<M, N, Scalar = S> + 's,
        M: MethodOf<L, N>,
        T: InLane<'s, L, N>,
    {
        // Known when compiled, but for the machine, so that what never runs is not.
        let widest = in_widest(Widest);
        if const { width::<L, M, N>(32) == 32 } && widest >= 32 {
            self.advance_all::<L, T, N, 32>(waiting, stop)
        } else if const { width::<L, M, N>(16) == 16 } && widest >= 16 {
            self.advance_all::<L, T, N, 16>(waiting, stop)
        } else {
            self.advance_all::<L, T, N, 8>(waiting, stop)
        }
    }

    /// W members at a time. Where one of those in the lanes panics, nobody says which: each then goes alone,
    /// and W others that wait follow.
    fn advance_all<'s, L, T, const N: usize, const W: usize>(
        &self,
        mut waiting: impl Iterator<Item = T>,
        stop: Stop<'_>,
    ) -> ControlFlow<()>
    where
        L: FlowInLanes<M, N, Scalar = S> + 's,
        M: MethodOf<L, N>,
        T: InLane<'s, L, N>,
    {
        loop {
            let mut lanes: [Option<T>; W] = [const { None }; W];
            lanes.iter_mut().for_each(|lane| *lane = waiting.next());
            // A panic of `observe` comes again below, where it is not caught.
            if let Ok(done) = caught(|| self.advance_lanes(&mut lanes, &mut waiting, stop)) {
                return done;
            }
            for member in lanes.iter_mut().flatten() {
                member.alone(stop)?;
            }
        }
    }

    /// The members in `lanes`; the lane of one that is done is given to the next that waits. Where none waits
    /// it runs on unseen.
    fn advance_lanes<'s, L, T, const N: usize, const W: usize>(
        &self,
        lanes: &mut [Option<T>; W],
        waiting: &mut impl Iterator<Item = T>,
        stop: Stop<'_>,
    ) -> ControlFlow<()>
    where
        L: FlowInLanes<M, N, Scalar = S> + 's,
        M: MethodOf<L, N>,
        T: InLane<'s, L, N>,
    {
        let Some(first) = &lanes[0] else { return ControlFlow::Continue(()) };
        let (mut systems, mut starts) = ([first.system(); W], [first.start(); W]);
        // Steps until the next look at each lane, where it has a member.
        let mut left = [0; W];
        for (lane, member) in lanes.iter().enumerate() {
            let Some(member) = member else { continue };
            (systems[lane], starts[lane], left[lane]) = (member.system(), member.start(), member.first());
        }
        let mut runs = LaneRuns::new(self.method, systems, &starts, self.plan.h);
        if let Some(error) = self.plan.error {
            runs = runs.solved_for(error, self.plan.time());
        }
        // Whether records are so far away that a lane may have failed long before.
        let mut is_long = false;
        loop {
            if stop.is_asked() {
                return ControlFlow::Break(());
            }
            let mut arriving = [None; W];
            for lane in 0..W {
                if left[lane] > 0 && !(is_long && runs.state(lane).is_none()) {
                    continue;
                }
                let Some(member) = &mut lanes[lane] else { continue };
                let further = match runs.state(lane) {
                    Some(state) => member.look(state)?,
                    None => {
                        member.alone(stop)?;
                        None
                    }
                };
                if let Some(steps) = further {
                    left[lane] = steps;
                    continue;
                }
                lanes[lane] = waiting.next();
                left[lane] = 0;
                if let Some(next) = &lanes[lane] {
                    (arriving[lane], starts[lane], left[lane]) =
                        (Some(next.system()), next.start(), next.first());
                }
            }
            if arriving.iter().any(Option::is_some) {
                runs.refill(arriving, &starts);
            }
            let taken =
                lanes.iter().zip(&left).filter_map(|(member, &left)| member.is_some().then_some(left));
            let Some(next) = taken.min() else { return ControlFlow::Continue(()) };
            is_long = next > LONG;
            let part = next.min(LONG);
            if part > 0 {
                in_widest(Advance { runs: &mut runs, steps: part });
                left.iter_mut().for_each(|left| *left = left.saturating_sub(part));
            }
        }
    }
}
