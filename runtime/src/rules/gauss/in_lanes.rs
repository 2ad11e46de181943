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
use super::coefficients::Coefficients;
use super::fixed_point::MAX_ITERATIONS;
use super::history::StageHistory;
use super::problem::{Solver, steps};
use super::slack::{MAX_SWEEPS, Slack};
use crate::numbers::members::{coordinate_by_coordinate, each_stage, member, stage_by_stage, write_member};
use crate::numbers::{Compensated, CompensatedMembers, Mask, MemberVector, Members, Scalar};
use crate::step::in_lanes::clocks::Clocks;
use crate::step::{Memory, State};
use crate::system::ForcedLagrangianInLanes;

/// W members on their way by a Gauss rule.
#[derive(Clone, Copy, Debug)]
pub struct StagesInLanes<T, F, const N: usize, const S: usize, const W: usize> {
    /// Members that have begun and not failed: their q and p equal those of their own run.
    is_sound: Mask<W>,
    /// Members that have not stepped yet.
    is_new: Mask<W>,
    /// Members with velocities that sweeps can start from: the fixed point solved their last step or, before
    /// the first, the velocity of their state is known.
    has_contracted: Mask<W>,
    fields: F,
    h: T,
    /// The velocities V_i of the last step; before the first, the velocity to start from.
    v: [MemberVector<T, N, W>; S],
    q: CompensatedMembers<T, N, W>,
    p: CompensatedMembers<T, N, W>,
    /// Steps that a member has taken alone.
    alone: u64,
    /// The slack that members start with; `None` where stages are solved to rounding.
    slack: Option<Slack<T>>,
    left: SlackOfMembers<T, W>,
    /// Kept where L, R or f takes the time.
    clocks: Clocks<W>,
}

// As many sweeps to an allowance as to rounding.
const _: () = assert!(MAX_SWEEPS == MAX_ITERATIONS);

impl<T: Scalar, F: Copy, const N: usize, const S: usize, const W: usize> StagesInLanes<T, F, N, S, W> {
    const COEFFICIENTS: &'static Coefficients<S> = &Gauss::<S>::COEFFICIENTS;

    /// No member yet.
    pub(crate) fn new(fields: F, h: T) -> Self {
        Self {
            is_sound: Mask::splat(false),
            is_new: Mask::splat(false),
            has_contracted: Mask::splat(false),
            fields,
            h,
            v: [[Members::splat(T::zero()); N]; S],
            q: CompensatedMembers::zero(),
            p: CompensatedMembers::zero(),
            alone: 0,
            slack: None,
            left: SlackOfMembers::none(),
            clocks: Clocks::new(),
        }
    }

    /// Solves the stages of all members, also of those put in later, as far as an error of `error` after so
    /// many steps from their starts needs.
    pub(crate) fn leave(&mut self, error: f64, steps: u64) {
        let slack = Slack::new(error, steps, 0.0);
        self.slack = Some(slack);
        for lane in 0..W {
            self.left.write(lane, slack);
        }
    }

    /// How many steps members have taken alone.
    pub(crate) fn steps_alone(&self) -> u64 {
        self.alone
    }

    /// Takes the fields of the systems that are now in the lanes.
    pub(crate) fn gather(&mut self, fields: F) {
        self.fields = fields;
    }

    /// Puts a member into a lane, at its start; `begins`: whether a run does.
    pub(crate) fn put<L>(&mut self, lane: usize, system: &L, start: &State<T, N>, begins: bool)
    where
        L: ForcedLagrangianInLanes<N, Scalar = T, Fields<W> = F>,
    {
        let velocity =
            begins.then(|| system.later(T::zero(), |system| start.velocity(system)).ok()).flatten();
        self.is_sound.0[lane] = begins;
        self.is_new.0[lane] = true;
        self.clocks.restart(lane);
        self.has_contracted.0[lane] = velocity.is_some();
        for v in &mut self.v {
            write_member(v, lane, &velocity.unwrap_or_else(nalgebra::zero));
        }
        if let Some(slack) = self.slack {
            self.left.write(lane, slack);
        }
        self.q.write(lane, &Compensated::new(start.q));
        self.p.write(lane, &Compensated::new(start.p));
    }

    /// q and p of the members, and which members have begun and not failed.
    pub(crate) fn standing(&self) -> (&MemberVector<T, N, W>, &MemberVector<T, N, W>, Mask<W>) {
        (&self.q.value, &self.p.value, self.is_sound)
    }

    /// Advances the members that have begun and not failed by `count` steps.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn advance<L>(&mut self, systems: [&L; W], count: u64)
    where
        L: ForcedLagrangianInLanes<N, Scalar = T, Fields<W> = F>,
    {
        let steps = steps::<T, S>(self.h);
        let zero = [[Members::splat(T::zero()); N]; S];
        let mut sweeps = SweepsOf::<L, N, S, W>::new();
        let mut solved = Solved { is_solved: Mask::splat(false), v: zero, rate: zero };
        for _ in 0..count {
            let mut together = self.is_sound & self.has_contracted;
            // The sweeps that a first step takes more than others cost all lanes as much as a quarter of them
            // alone.
            let new = (together & self.is_new).0.iter().filter(|&&is_new| is_new).count();
            if 4 * new < W {
                together = together & !self.is_new;
            }
            let mut is_alone = self.is_sound;
            if together.0.contains(&true) {
                self.solve::<L>(&steps, together, &mut sweeps, &mut solved);
                let has_stepped = self.follow(&steps, &solved);
                if L::IS_TIMED {
                    self.clocks.follow(has_stepped);
                }
                is_alone = is_alone & !has_stepped;
            }
            if is_alone.0.contains(&true) {
                self.step_alone(systems, is_alone);
            }
        }
    }

    /// Takes the step that was solved for, and returns which members have taken it.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn follow(&mut self, steps: &[T; S], solved: &Solved<T, N, S, W>) -> Mask<W> {
        let zero = [Members::splat(T::zero()); N];
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
        if self.slack.is_some() {
            let steps = [[&self.q.value, &q.value], [&self.p.value, &p.value]];
            self.left.follow(has_stepped, steps);
        }
        self.is_new = self.is_new & !has_stepped;
        let only_some = has_stepped.0.contains(&false);
        self.q.replace(only_some, has_stepped, &q);
        self.p.replace(only_some, has_stepped, &p);
        stage_by_stage!(j => {
            coordinate_by_coordinate!(a => {
                self.v[j][a].replace(only_some, has_stepped, solved.v[j][a]);
            });
        });
        has_stepped
    }

    /// Takes the step of some members, each by the functions of its own run.
    #[cold]
    #[inline(never)]
    fn step_alone<L>(&mut self, systems: [&L; W], is_alone: Mask<W>)
    where
        L: ForcedLagrangianInLanes<N, Scalar = T, Fields<W> = F>,
    {
        for (lane, system) in systems.into_iter().enumerate().filter(|(lane, _)| is_alone.0[*lane]) {
            self.alone += 1;
            let mut history = StageHistory::<T, N, S>::default();
            let (q, p) = (self.q.member(lane), self.p.member(lane));
            let state = State { q: q.value, p: p.value };
            if !self.is_new.0[lane] {
                let v = core::array::from_fn(|j| member(&self.v[j], lane));
                let solver = if self.has_contracted.0[lane] { Solver::FixedPoint } else { Solver::Newton };
                history = StageHistory::of_step(&v, self.h, solver, [q, p]);
            }
            if let Some(slack) = self.slack {
                let [q_change, p_change] = self.left.change;
                let change = [q_change.0[lane], p_change.0[lane]];
                history = history.with_slack(Some(Slack { steps: self.left.steps[lane], change, ..slack }));
            }
            let step = system.later(self.clocks.elapsed_of(lane, self.h), |system| {
                Memory::<L, Gauss<S>, N>::advance(&mut history, system, &state, self.h)
            });
            self.clocks.follow_one(lane);
            self.is_sound.0[lane] = step.is_ok();
            self.is_new.0[lane] = false;
            self.has_contracted.0[lane] = history.solver() == Solver::FixedPoint;
            if let Some(slack) = history.slack() {
                self.left.write(lane, slack);
            }
            let [q, p] = history.ends();
            self.q.write(lane, &q);
            self.p.write(lane, &p);
            each_stage!(j => {
                write_member(&mut self.v[j], lane, &history.velocities()[j]);
            });
        }
    }
}
