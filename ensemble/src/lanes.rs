//! Members many at a time, in the widest instructions that the machine has.

use core::array;
use core::ops::ControlFlow;

use dalembert::State;
use dalembert::run::{InLanes as LanesBy, LaneRuns};
use dalembert::step::MethodOf;
use dalembert::system::Scalar;
use multiversion::multiversion;

use crate::member::{Failure, Record};
use crate::stepping::{Plan, Slot, Stepping};

/// As many members at a time as the machine has lanes for: [`Study::in_lanes`](crate::Study::in_lanes).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InLanes<M, S> {
    pub(crate) method: M,
    pub(crate) plan: Plan<S>,
}

/// All runs on by this many steps, compiled for several instruction sets, of which the machine's is taken when
/// the program runs.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma",
    "x86_64+avx2+fma",
    "aarch64+neon"
))]
fn advance<L, M, const N: usize, const W: usize>(runs: &mut LaneRuns<'_, L, M, N, W>, steps: u64)
where
    L: LanesBy<M, N>,
{
    runs.advance(steps);
}

/// Most bytes of the runs of one group: they stand on the stack, of which a thread may have 2 MiB, and are to
/// stay in the cache.
const MOST_BYTES: usize = 256 * 1024;

/// How many members at a time keep the registers full, as measured by
/// `cargo bench -p dalembert-benches --bench lanes`; fewer where N or the method makes the runs large.
fn lanes<L: LanesBy<M, N>, M, const N: usize>() -> usize {
    #[cfg(target_arch = "x86_64")]
    let widest = match (is_x86_feature_detected!("avx512f"), is_x86_feature_detected!("avx2")) {
        (true, _) => 32,
        (false, true) => 16,
        (false, false) => 8,
    };
    #[cfg(not(target_arch = "x86_64"))]
    let widest = 8;
    let fitting = match () {
        () if size_of::<LaneRuns<'_, L, M, N, 32>>() <= MOST_BYTES => 32,
        () if size_of::<LaneRuns<'_, L, M, N, 16>>() <= MOST_BYTES => 16,
        () => 8,
    };
    fitting.min(widest)
}

/// A member on its way.
struct Lane<'s, L: dalembert::Lagrangian<N>, V, const N: usize> {
    number: u64,
    system: &'s L,
    start: State<L::Scalar, N>,
    value: &'s mut V,
    failure: &'s mut Option<Failure<L::Scalar, N>>,
    /// Records that were observed.
    seen: u64,
    is_on_its_way: bool,
}

impl<L, M, const N: usize> Stepping<L, N> for InLanes<M, L::Scalar>
where
    L: LanesBy<M, N>,
    M: Copy + Sync + MethodOf<L, N>,
{
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
    ) {
        let mut all = Vec::with_capacity(members.len());
        for Slot { number, start, value, failure } in members {
            let number = *number;
            match start {
                Ok((system, start)) => {
                    let (seen, is_on_its_way) = (0, true);
                    all.push(Lane {
                        number,
                        system: &*system,
                        start: *start,
                        value,
                        failure,
                        seen,
                        is_on_its_way,
                    });
                }
                Err(error) => *failure = Some(Failure { number, error: (*error).into(), last: None }),
            }
        }
        match lanes::<L, M, N>() {
            32 => all.chunks_mut(32).for_each(|group| self.advance_group::<L, V, N, 32>(group, observe)),
            16 => all.chunks_mut(16).for_each(|group| self.advance_group::<L, V, N, 16>(group, observe)),
            _ => all.chunks_mut(8).for_each(|group| self.advance_group::<L, V, N, 8>(group, observe)),
        }
    }

    fn description(&self) -> String {
        self.plan.description::<M>()
    }
}

impl<M: Copy, S: Scalar> InLanes<M, S> {
    /// Up to W members; lanes without one run with the last.
    fn advance_group<L, V, const N: usize, const W: usize>(
        &self,
        group: &mut [Lane<'_, L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
    ) where
        L: LanesBy<M, N, Scalar = S>,
        M: MethodOf<L, N>,
    {
        let Some(last) = group.len().checked_sub(1) else { return };
        let systems: [&L; W] = array::from_fn(|lane| group[lane.min(last)].system);
        let starts: [State<S, N>; W] = array::from_fn(|lane| group[lane.min(last)].start);
        let Plan { h, steps: all, every } = self.plan;
        let mut runs = LaneRuns::new(self.method, systems, &starts, h);
        let mut steps = 0;
        let mut look = |runs: &LaneRuns<'_, L, M, N, W>, steps: u64| {
            let time = if steps == 0 { 0.0 } else { h.widen() * steps as f64 };
            for (lane, member) in group.iter_mut().enumerate().filter(|(_, member)| member.is_on_its_way) {
                match runs.state(lane) {
                    Some(state) => {
                        let record =
                            Record { number: member.number, system: member.system, steps, time, state };
                        member.seen += 1;
                        member.is_on_its_way = observe(member.value, &record).is_continue();
                    }
                    None => {
                        member.is_on_its_way = false;
                        *member.failure = self.alone(member, observe).err();
                    }
                }
            }
            group.iter().any(|member| member.is_on_its_way)
        };
        if (every.is_some() || all == 0) && !look(&runs, 0) {
            return;
        }
        let stride = every.unwrap_or(all).max(1);
        while steps < all {
            let part = stride.min(all - steps);
            advance(&mut runs, part);
            steps += part;
            if !look(&runs, steps) {
                break;
            }
        }
    }

    /// What became of a member whose lane does not tell: by its own run, which is the same up to there. What was
    /// observed is not observed again.
    #[cold]
    fn alone<L, V, const N: usize>(
        &self,
        member: &mut Lane<'_, L, V, N>,
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
    ) -> Result<(), Failure<S, N>>
    where
        L: LanesBy<M, N, Scalar = S>,
        M: MethodOf<L, N>,
    {
        let mut records = 0;
        self.plan.run(self.method, member.number, member.system, &member.start, |record| {
            records += 1;
            if records > member.seen { observe(member.value, record) } else { ControlFlow::Continue(()) }
        })
    }
}
