//! Steps by a Gauss rule of several members at once: the operations of each member's own run, in their order.
//!
//! Stage by stage, each over all members; sweeps are made of all until the last member is solved. A step that
//! leaves the usual path (sweeps that do not contract, floors that rise or fall, rounding that has to be
//! measured, Newton's method, numbers that are not finite) the member takes alone, by the functions of its
//! own run, and comes back to the others. Its first step, which takes more sweeps than the others', it takes
//! alone too, unless many members take theirs.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

mod allowances;
mod floors;
mod seen;
mod sweeps;

use allowances::SlackOfMembers;
use sweeps::{Solved, SweepsOf};

use super::Gauss;
use super::fixed_point::MAX_ITERATIONS;
use super::history::StageHistory;
use super::problem::{Solver, steps};
use super::slack::{MAX_SWEEPS, Slack};
use crate::numbers::members::{coordinate_by_coordinate, each_stage, member, stage_by_stage, write_member};
use crate::numbers::{Mask, MemberVector, Members};
use crate::step::{Ends, FlowInLanes, LaneRuns, Memory};
use crate::system::ForcedLagrangianInLanes;

/// Values kept of W members on their way by a Gauss rule.
#[derive(Clone, Copy, Debug)]
pub struct StagesInLanes<T, const N: usize, const S: usize, const W: usize> {
    /// Members with velocities that sweeps can start from: the fixed point solved their last step or, before
    /// the first, the velocity of their state is known.
    has_contracted: Mask<W>,
    /// The velocities V_i of the last step; before the first, the velocity to start from.
    v: [MemberVector<T, N, W>; S],
    /// The slack that members start with; `None` where stages are solved to rounding.
    slack: Option<Slack<T>>,
    left: SlackOfMembers<T, W>,
}

// As many sweeps to an allowance as to rounding.
const _: () = assert!(MAX_SWEEPS == MAX_ITERATIONS);

impl<L: ForcedLagrangianInLanes<N>, const N: usize, const S: usize> FlowInLanes<Gauss<S>, N> for L {
    type Kept<const W: usize> = StagesInLanes<L::Scalar, N, S, W>;

    /// Sweeps go on until the last member is solved: the more there are, the more wait.
    const MOST_LANES: usize = 16;

    fn kept<const W: usize>(_h: L::Scalar) -> Self::Kept<W> {
        StagesInLanes {
            has_contracted: Mask::splat(false),
            v: [[Members::splat(nalgebra::zero()); N]; S],
            slack: None,
            left: SlackOfMembers::none(),
        }
    }

    fn put<const W: usize>(runs: &mut LaneRuns<'_, L, Gauss<S>, N, W>, lane: usize) -> bool {
        let (system, start) = (runs.systems[lane], runs.values(lane));
        let velocity = system.later(nalgebra::zero(), |system| start.velocity(system)).ok();
        let StagesInLanes { has_contracted, v, slack, left } = &mut runs.kept;
        has_contracted.0[lane] = velocity.is_some();
        for v in v {
            write_member(v, lane, &velocity.unwrap_or_else(nalgebra::zero));
        }
        if let Some(slack) = *slack {
            left.write(lane, slack);
        }
        true
    }

    fn leave_unsolved<const W: usize>(kept: &mut Self::Kept<W>, error: f64, steps: u64) {
        let slack = Slack::new(error, steps, 0.0);
        kept.slack = Some(slack);
        for lane in 0..W {
            kept.left.write(lane, slack);
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance_in_lanes<const W: usize>(runs: &mut LaneRuns<'_, L, Gauss<S>, N, W>, count: u64) {
        let steps = steps::<L::Scalar, S>(runs.h);
        let zero = [[Members::splat(nalgebra::zero()); N]; S];
        let mut sweeps = SweepsOf::<L, N, S, W>::new();
        let mut solved = Solved { is_solved: Mask::splat(false), v: zero, rate: zero };
        for step in 0..count {
            let mut together = runs.is_sound & runs.kept.has_contracted;
            // The sweeps that a first step takes more than others cost all lanes as much as a quarter of them
            // alone.
            let new = (together & runs.is_new).0.iter().filter(|&&is_new| is_new).count();
            if 4 * new < W {
                together = together & !runs.is_new;
            }
            let mut is_alone = runs.is_sound;
            if together.0.contains(&true) {
                runs.solve(step, &steps, together, &mut sweeps, &mut solved);
                is_alone = is_alone & !runs.follow(&steps, &solved);
            }
            if is_alone.0.contains(&true) {
                runs.step_alone(is_alone, step);
            }
        }
    }

    fn alone<const W: usize>(
        runs: &mut LaneRuns<'_, L, Gauss<S>, N, W>,
        lane: usize,
        elapsed: L::Scalar,
    ) -> Option<Ends<L::Scalar, N>> {
        let (system, state, h) = (runs.systems[lane], runs.values(lane), runs.h);
        let kept = &mut runs.kept;
        let mut history = StageHistory::<L::Scalar, N, S>::default();
        if !runs.is_new.0[lane] {
            let v = core::array::from_fn(|j| member(&kept.v[j], lane));
            let solver = if kept.has_contracted.0[lane] { Solver::FixedPoint } else { Solver::Newton };
            history = StageHistory::of_step(&v, h, solver, [runs.q.member(lane), runs.p.member(lane)]);
        }
        if let Some(slack) = kept.slack {
            let [q_change, p_change] = kept.left.change;
            let change = [q_change.0[lane], p_change.0[lane]];
            history = history.with_slack(Some(Slack { steps: kept.left.steps[lane], change, ..slack }));
        }
        let step = system
            .later(elapsed, |system| Memory::<L, Gauss<S>, N>::advance(&mut history, system, &state, h));
        step.ok()?;
        kept.has_contracted.0[lane] = history.solver() == Solver::FixedPoint;
        if let Some(slack) = history.slack() {
            kept.left.write(lane, slack);
        }
        each_stage!(j => {
            write_member(&mut kept.v[j], lane, &history.velocities()[j]);
        });
        let [q, p] = history.ends();
        Some(Ends { q, p })
    }
}

impl<L: ForcedLagrangianInLanes<N>, const N: usize, const S: usize, const W: usize>
    LaneRuns<'_, L, Gauss<S>, N, W>
{
    /// Takes the step that was solved for, and returns which members have taken it.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn follow(&mut self, steps: &[L::Scalar; S], solved: &Solved<L::Scalar, N, S, W>) -> Mask<W> {
        let zero = [Members::splat(nalgebra::zero()); N];
        let (mut displacement, mut impulse) = (zero, zero);
        stage_by_stage!(j => {
            coordinate_by_coordinate!(a => {
                displacement[a] = displacement[a] + solved.v[j][a] * steps[j];
                impulse[a] = impulse[a] + solved.rate[j][a] * steps[j];
            });
        });
        let (q, p) = (self.q.plus(&displacement), self.p.plus(&impulse));
        let mut has_stepped = solved.is_solved;
        coordinate_by_coordinate!(a => {
            let velocity = displacement[a] / self.h;
            let is_finite = q.value[a].is_finite() & p.value[a].is_finite() & velocity.is_finite();
            has_stepped = has_stepped & is_finite;
        });
        if self.kept.slack.is_some() {
            let steps = [[&self.q.value, &q.value], [&self.p.value, &p.value]];
            self.kept.left.follow(has_stepped, steps);
        }
        self.is_new = self.is_new & !has_stepped;
        let only_some = has_stepped.0.contains(&false);
        self.q.replace(only_some, has_stepped, &q);
        self.p.replace(only_some, has_stepped, &p);
        stage_by_stage!(j => {
            coordinate_by_coordinate!(a => {
                self.kept.v[j][a].replace(only_some, has_stepped, solved.v[j][a]);
            });
        });
        has_stepped
    }
}
