//! Steps by a Gauss rule of several members at once: the operations of each member's own run, in their order.
//!
//! Stage by stage, each over all members; sweeps are made of all until the last member is solved. A step that
//! leaves the usual path (sweeps that do not contract, floors that rise or fall, rounding that has to be
//! measured, Newton's method, numbers that are none) the member takes alone, by the functions of its own run,
//! and comes back to the others. So it does for its first step, which takes more sweeps than the others', unless
//! many take theirs.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use super::Gauss;
use super::coefficients::Coefficients;
use super::fixed_point::{AT_REST, CHANGED, MAX_ITERATIONS, NEAR, SLUGGISH};
use super::history::StageHistory;
use super::problem::{Compensated, Solver, steps};
use super::slack::{MAX_SWEEPS, ROUNDINGS, Slack, remaining};
use crate::numbers::members::{each_coordinate, each_stage, member, stage_by_stage, write_member};
use crate::numbers::{Blank, Mask, MemberVector, Members, Scalar};
use crate::step::in_lanes::clocks::Clocks;
use crate::step::{Memory, State, newton::AT_FLOOR};
use crate::system::{ForcedLagrangianInLanes, Lagrangian};

/// W members on their way by a Gauss rule.
#[derive(Clone, Copy, Debug)]
pub struct StagesInLanes<T, F, const N: usize, const S: usize, const W: usize> {
    /// Whose states are those of their runs.
    is_sound: Mask<W>,
    /// Who has not stepped yet.
    is_new: Mask<W>,
    /// Whose last step was solved by the fixed point, or who has a velocity to start from.
    has_contracted: Mask<W>,
    fields: F,
    h: T,
    /// The velocities V_i of the last step; before the first, the velocity to start from.
    v: [MemberVector<T, N, W>; S],
    q: CompensatedMembers<T, N, W>,
    p: CompensatedMembers<T, N, W>,
    /// Steps that a member has taken alone.
    alone: u64,
    /// What members start with; nothing where stages are solved to rounding.
    slack: Option<Slack<T>>,
    left: SlackOfMembers<T, W>,
    /// Kept where L, R or f takes the time.
    clocks: Clocks<W>,
}

// As many sweeps to an allowance as to rounding.
const _: () = assert!(MAX_SWEEPS == MAX_ITERATIONS);

/// What the next steps of each member may leave unsolved, [`Slack`].
#[derive(Clone, Copy, Debug)]
struct SlackOfMembers<T, const W: usize> {
    steps: [u64; W],
    change: [Members<T, W>; 2],
}

/// What the sweeps of one step may leave, [`Allowance`](super::slack::Allowance), of those whose stages are
/// not solved to rounding.
#[derive(Clone, Copy)]
struct Allowances<T, const W: usize> {
    are_known: Mask<W>,
    per_correction: T,
    per_residual: Members<T, W>,
}

/// [`Compensated`] of each member.
#[derive(Clone, Copy, Debug)]
struct CompensatedMembers<T, const N: usize, const W: usize> {
    value: MemberVector<T, N, W>,
    rest: MemberVector<T, N, W>,
}

impl<T: Scalar, const N: usize, const W: usize> CompensatedMembers<T, N, W> {
    fn zero() -> Self {
        let zero = [Members::splat(T::zero()); N];
        Self { value: zero, rest: zero }
    }

    fn member(&self, lane: usize) -> Compensated<T, N> {
        Compensated { value: member(&self.value, lane), rest: member(&self.rest, lane) }
    }

    fn write(&mut self, lane: usize, of: &Compensated<T, N>) {
        write_member(&mut self.value, lane, &of.value);
        write_member(&mut self.rest, lane, &of.rest);
    }

    /// [`Compensated::plus`] of each.
    #[inline(always)]
    fn plus(&self, change: &MemberVector<T, N, W>) -> Self {
        let mut sum = *self;
        each_coordinate!(a => {
            let (value, change) = (self.value[a], change[a] + self.rest[a]);
            let total = value + change;
            let share = total - value;
            sum.value[a] = total;
            sum.rest[a] = (value - (total - share)) + (change - share);
        });
        sum
    }

    /// Where the condition holds, those of `other`.
    #[inline(always)]
    fn replace(&mut self, only_some: bool, condition: Mask<W>, other: &Self) {
        each_coordinate!(a => {
            self.value[a].replace(only_some, condition, other.value[a]);
            self.rest[a].replace(only_some, condition, other.rest[a]);
        });
    }
}

/// What the sweeps of each step write before they read it: made once for many steps.
struct Sweeps<T, K, A, const N: usize, const S: usize, const W: usize> {
    v: [MemberVector<T, N, W>; S],
    next: [MemberVector<T, N, W>; S],
    rate: [MemberVector<T, N, W>; S],
    /// h b_j V_j, h b_j G_j.
    terms: [[MemberVector<T, N, W>; S]; 2],
    kept: [K; S],
    anchors: [A; S],
}

impl<T: Scalar, K: Blank, A: Blank, const N: usize, const S: usize, const W: usize> Sweeps<T, K, A, N, S, W> {
    #[inline(always)]
    fn new() -> Self {
        let zero = [[Members::splat(T::zero()); N]; S];
        Self {
            v: zero,
            next: zero,
            rate: zero,
            terms: [zero; 2],
            kept: Blank::blank(),
            anchors: Blank::blank(),
        }
    }
}

/// [`Sweeps`] over the stages of a system.
type SweepsOf<L, const N: usize, const S: usize, const W: usize> = Sweeps<
    <L as Lagrangian<N>>::Scalar,
    <L as ForcedLagrangianInLanes<N>>::Kept<W>,
    <L as ForcedLagrangianInLanes<N>>::AnchorsInLanes<W>,
    N,
    S,
    W,
>;

/// What a sweep has seen.
#[derive(Clone, Copy)]
struct Seen<T, const N: usize, const W: usize> {
    /// The largest residual of each coordinate.
    residual: MemberVector<T, N, W>,
    /// The largest correction.
    correction: Members<T, W>,
    /// The sum of all, in which NaN and infinity stay.
    sum: Members<T, W>,
}

impl<T: Scalar, const N: usize, const W: usize> Seen<T, N, W> {
    #[inline(always)]
    fn nothing() -> Self {
        let none = Members::splat(T::zero());
        Self { residual: [none; N], correction: none, sum: none }
    }

    #[inline(always)]
    fn of_both([a, b]: &[Self; 2]) -> Self {
        let mut residual = a.residual;
        each_coordinate!(i => {
            residual[i] = a.residual[i].larger(b.residual[i]);
        });
        Self { residual, correction: a.correction.larger(b.correction), sum: a.sum + b.sum }
    }
}

/// The stages of a step, of those that were solved.
struct Solved<T, const N: usize, const S: usize, const W: usize> {
    is_solved: Mask<W>,
    v: [MemberVector<T, N, W>; S],
    rate: [MemberVector<T, N, W>; S],
}

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
            left: SlackOfMembers { steps: [0; W], change: [Members::splat(T::zero()); 2] },
            clocks: Clocks::new(),
        }
    }

    /// Solves the stages of all members, and of those who are put in later, as far as an error of `error` after
    /// so many steps from their starts needs.
    pub(crate) fn leave(&mut self, error: f64, steps: u64) {
        let slack = Slack::new(error, steps, 0.0);
        self.slack = Some(slack);
        for lane in 0..W {
            self.write_slack(lane, slack);
        }
    }

    fn write_slack(&mut self, lane: usize, slack: Slack<T>) {
        self.left.steps[lane] = slack.steps;
        for (change, of_member) in self.left.change.iter_mut().zip(slack.change) {
            change.0[lane] = of_member;
        }
    }

    /// [`Slack::allowance`] of each.
    #[inline(always)]
    fn allowances(&self) -> Allowances<T, W> {
        let of_step = self.slack.map_or_else(T::one, |slack| slack.of_step);
        let [q_change, p_change] = self.left.change;
        let mut largest = Members::splat(T::zero());
        each_coordinate!(a => {
            largest = largest.larger(self.p.value[a].abs());
        });
        let rounding = largest * (T::EPSILON * T::constant(ROUNDINGS)) * q_change;
        let mut are_known = Mask(self.left.steps.map(|steps| steps > 0));
        are_known = are_known & Members::splat(T::zero()).less(q_change) & rounding.less(p_change * of_step);
        Allowances {
            are_known,
            per_correction: self.h.abs() / of_step,
            per_residual: q_change / (p_change * of_step),
        }
    }

    /// How many steps members have taken alone.
    pub(crate) fn steps_alone(&self) -> u64 {
        self.alone
    }

    /// The fields of other systems, some of whose members are new.
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
            self.write_slack(lane, slack);
        }
        self.q.write(lane, &Compensated::new(start.q));
        self.p.write(lane, &Compensated::new(start.p));
    }

    /// Where members are, and whose states are those of their runs.
    pub(crate) fn standing(&self) -> (&MemberVector<T, N, W>, &MemberVector<T, N, W>, Mask<W>) {
        (&self.q.value, &self.p.value, self.is_sound)
    }

    /// All members on by so many steps.
    #[inline(always)]
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

    /// The step that was solved for; who has taken it.
    #[inline(always)]
    fn follow(&mut self, steps: &[T; S], solved: &Solved<T, N, S, W>) -> Mask<W> {
        let zero = [Members::splat(T::zero()); N];
        let (mut displacement, mut impulse) = (zero, zero);
        stage_by_stage!(j => {
            each_coordinate!(a => {
                displacement[a] = displacement[a] + solved.v[j][a] * steps[j];
                impulse[a] = impulse[a] + solved.rate[j][a] * steps[j];
            });
        });
        let (q, p) = (self.q.plus(&displacement), self.p.plus(&impulse));
        let mut has_stepped = solved.is_solved;
        each_coordinate!(a => {
            let velocity = displacement[a] / self.h;
            let is_finite = q.value[a].is_finite() & p.value[a].is_finite() & velocity.is_finite();
            has_stepped = has_stepped & is_finite;
        });
        if self.slack.is_some() {
            for (change, (to, from)) in
                self.left.change.iter_mut().zip([(&q.value, &self.q.value), (&p.value, &self.p.value)])
            {
                let mut largest = *change;
                each_coordinate!(a => {
                    largest = largest.larger((to[a] - from[a]).abs());
                });
                change.replace(true, has_stepped, largest);
            }
            for lane in 0..W {
                let taken = u64::from(has_stepped.0[lane]);
                self.left.steps[lane] = self.left.steps[lane].saturating_sub(taken);
            }
        }
        self.is_new = self.is_new & !has_stepped;
        let only_some = has_stepped.0.contains(&false);
        self.q.replace(only_some, has_stepped, &q);
        self.p.replace(only_some, has_stepped, &p);
        stage_by_stage!(j => {
            each_coordinate!(a => {
                self.v[j][a].replace(only_some, has_stepped, solved.v[j][a]);
            });
        });
        has_stepped
    }

    /// The velocities of the last step, one step on; of who has not stepped yet, those to start from.
    #[inline(always)]
    fn extrapolate(&self, extrapolated: &mut [MemberVector<T, N, W>; S]) {
        let columns = &Self::COEFFICIENTS.extrapolation;
        stage_by_stage!(i => {
            each_coordinate!(a => {
                let mut sums = [Members::splat(T::zero()); 2];
                each_stage!(j => {
                    sums[j % 2] = self.v[j][a].times_plus(T::constant(columns[j][i]), sums[j % 2]);
                });
                extrapolated[i][a] = sums[0] + sums[1];
            });
        });
        if self.is_new.0.contains(&true) {
            stage_by_stage!(i => {
                each_coordinate!(a => {
                    extrapolated[i][a] = Members::select(self.is_new, self.v[i][a], extrapolated[i][a]);
                });
            });
        }
    }

    /// start + Σ_j μ_ij (h b_j x_j) at the stage i, the `terms` being h b_j x_j.
    #[inline(always)]
    fn at_stage(
        start: &CompensatedMembers<T, N, W>,
        terms: &[MemberVector<T, N, W>; S],
        i: usize,
    ) -> MemberVector<T, N, W> {
        let columns = &Self::COEFFICIENTS.shares;
        let mut at = start.value;
        each_coordinate!(a => {
            let mut sums = [start.rest[a], Members::splat(T::zero())];
            each_stage!(j => {
                sums[j % 2] = terms[j][a].times_plus(T::constant(columns[j][i]), sums[j % 2]);
            });
            at[a] = (sums[0] + sums[1]) + start.value[a];
        });
        at
    }

    /// The stages of those who step together, as far as sweeps of the usual kind solve for them:
    /// [`iterate`](super::fixed_point::iterate) of each.
    #[inline(always)]
    fn solve<L>(
        &self,
        steps: &[T; S],
        together: Mask<W>,
        sweeps: &mut SweepsOf<L, N, S, W>,
        solved: &mut Solved<T, N, S, W>,
    ) where
        L: ForcedLagrangianInLanes<N, Scalar = T, Fields<W> = F>,
    {
        let constant = T::constant;
        let mut fields = self.fields;
        if L::IS_TIMED {
            fields = L::later_in_lanes(&fields, &self.clocks.elapsed(self.h));
        }
        let Sweeps { v, next, rate, terms: [of_v, of_rate], kept, anchors } = sweeps;
        let (mut v, mut next) = (v, next);
        *anchors = Blank::blank();
        self.extrapolate(v);
        stage_by_stage!(j => {
            each_coordinate!(a => {
                of_v[j][a] = v[j][a] * steps[j];
            });
        });
        solved.is_solved = Mask::splat(false);
        let mut is_open = together;
        let none = Members::splat(T::zero());
        let zero = [none; N];
        let (mut floor, mut per_floor) = (zero, zero);
        let (mut before, mut last) = (Members::splat(T::one()), Members::splat(T::one()));
        let allowances = self.allowances();
        let is_loose = allowances.are_known & Mask::splat(self.slack.is_some());
        let some_loose = is_loose.0.contains(&true);
        let some_strict = (together & !is_loose).0.contains(&true);
        let (mut loose_before, mut loose_last) = (none, none);
        for iterations in 1..=MAX_ITERATIONS {
            stage_by_stage!(i => {
                let q = Self::at_stage(&self.q, of_v, i);
                // One call for both, which is inlined.
                let in_time;
                let mut at_stage = &fields;
                if L::IS_TIMED {
                    let elapsed = Members::<T, W>::splat(constant(Self::COEFFICIENTS.nodes[i]) * self.h);
                    in_time = L::later_in_lanes(&fields, &elapsed);
                    at_stage = &in_time;
                }
                (rate[i], kept[i]) = L::rates_in_lanes(at_stage, &mut anchors[i], &q, &v[i]);
                each_coordinate!(a => {
                    of_rate[i][a] = rate[i][a] * steps[i];
                });
            });
            // Of every other stage, by an index that LLVM does not know: as variables, not in memory, they would
            // become vectors of numbers that do not belong together.
            let mut seen = [Seen::nothing(); 2];
            stage_by_stage!(i => {
                let p = Self::at_stage(&self.p, of_rate, i);
                let [residual, correction] = L::corrections_in_lanes(&fields, &kept[i], &v[i], &p);
                let mut now = seen[i % 2];
                each_coordinate!(a => {
                    next[i][a] = v[i][a] + correction[a];
                    of_v[i][a] = next[i][a] * steps[i];
                    let (residual, correction) = (residual[a].abs(), correction[a].abs());
                    now.residual[a] = now.residual[a].larger(residual);
                    now.correction = now.correction.larger(correction);
                    now.sum = now.sum + (residual + correction);
                });
                seen[i % 2] = now;
            });
            let Seen { residual: largest, correction, sum } = Seen::of_both(&seen);
            let (mut is_done, mut is_at_rest) = (Mask::splat(false), Mask::splat(false));
            let mut size = last;
            if some_strict {
                if iterations == 1 {
                    floor = self.floor(rate, &largest);
                    per_floor = reciprocals(&floor);
                }
                size = in_units(&largest, &per_floor);
                if iterations == 1 {
                    last = size;
                } else {
                    let grows = is_open & !is_loose & !size.less(last);
                    if grows.0.contains(&true) {
                        let now = self.floor(rate, &largest);
                        let mut has_risen = Mask::splat(false);
                        each_coordinate!(a => {
                            has_risen = has_risen | (floor[a] * constant(CHANGED)).less(now[a]);
                            is_open = is_open & (!grows | now[a].is_finite());
                        });
                        let has_risen = grows & has_risen;
                        each_coordinate!(a => {
                            floor[a] = Members::select(has_risen, floor[a].larger(now[a]), floor[a]);
                        });
                        per_floor = reciprocals(&floor);
                        size = in_units(&largest, &per_floor);
                        before = Members::select(has_risen, size * constant(4.0), before);
                        last = Members::select(has_risen, size, last);
                    }
                }
                // As many of these in a sum would still be finite.
                is_open = is_open & (is_loose | ((sum + size) * constant(256.0)).is_finite());

                let small = Members::splat(constant(AT_REST));
                is_at_rest = (size * size).less_or_equal(small * last)
                    & if iterations > 2 {
                        (size * last).less_or_equal(small * before)
                    } else if !L::STRUCTURE.constant_mass_matrix {
                        size.less_or_equal(small)
                    } else if N > 1 {
                        size.less_or_equal(Members::splat(constant(NEAR)))
                    } else {
                        Mask::splat(true)
                    };
                let mut has_stopped = Mask::splat(false);
                if iterations > 1 {
                    has_stopped = (last * constant(SLUGGISH)).less_or_equal(size);
                }
                let at_floor = size.less_or_equal(Members::splat(constant(AT_FLOOR)));
                is_done = is_open & !is_loose & (is_at_rest | (has_stopped & at_floor));
                if iterations > 1 && is_done.0.contains(&true) {
                    let now = self.floor(rate, &largest);
                    let mut has_fallen = Mask::splat(false);
                    each_coordinate!(a => {
                        has_fallen = has_fallen | (now[a] * constant(CHANGED)).less(floor[a]);
                    });
                    let has_fallen = is_done & has_fallen;
                    is_done = is_done & !has_fallen;
                    each_coordinate!(a => {
                        floor[a] = Members::select(has_fallen, now[a], floor[a]);
                    });
                    per_floor = reciprocals(&floor);
                    size = in_units(&largest, &per_floor);
                    before = Members::select(has_fallen, size * constant(4.0), before);
                    last = Members::select(has_fallen, size, last);
                }
                if iterations > 2 {
                    // Rounding has to be measured, or Newton's method takes over.
                    is_open = is_open & (is_done | is_loose | size.less(before * constant(SLUGGISH)));
                }
            }

            // What is left, where an allowance says how much may be.
            if some_loose {
                let mut loose = correction * allowances.per_correction;
                each_coordinate!(a => {
                    loose = loose.larger(largest[a] * allowances.per_residual);
                });
                is_open = is_open & (!is_loose | ((sum + loose) * constant(256.0)).is_finite());
                if iterations > 2 {
                    let mut share = loose;
                    for lane in 0..W {
                        share.0[lane] = remaining([loose_before.0[lane], loose_last.0[lane], loose.0[lane]]);
                    }
                    let is_within = is_loose & (loose * share).less_or_equal(Members::splat(T::one()));
                    is_open = is_open & !(is_loose & !is_within & !share.is_finite());
                    is_done = is_done | (is_open & is_within);
                }
                (loose_before, loose_last) = (loose_last, loose);
            }
            let is_moved = is_at_rest | is_loose;
            if is_done.0.contains(&true) {
                // The first overwrite what is of no step.
                let some_solved = solved.is_solved.0.contains(&true);
                let all_moved = !is_moved.0.contains(&false);
                stage_by_stage!(i => {
                    each_coordinate!(a => {
                        let mut end = next[i][a];
                        if !all_moved {
                            end = Members::select(is_moved, end, v[i][a]);
                        }
                        solved.v[i][a].replace(some_solved, is_done, end);
                        solved.rate[i][a].replace(some_solved, is_done, rate[i][a]);
                    });
                });
                solved.is_solved = solved.is_solved | is_done;
                is_open = is_open & !is_done;
            }
            if !is_open.0.contains(&true) {
                break;
            }
            core::mem::swap(&mut v, &mut next);
            (before, last) = (last, size);
        }
    }

    /// [`Problem::floor`](super::problem::Problem::floor) of each, with the `largest` residual of each
    /// coordinate.
    #[inline(always)]
    fn floor(
        &self,
        rate: &[MemberVector<T, N, W>; S],
        largest: &MemberVector<T, N, W>,
    ) -> MemberVector<T, N, W> {
        let unit = T::EPSILON * T::constant(4.0);
        let of_rate = (self.h * unit).abs();
        let mut floor = *largest;
        each_coordinate!(a => {
            let mut largest_rate = rate[0][a].abs();
            for i in 1..S {
                largest_rate = largest_rate.larger(rate[i][a].abs());
            }
            let terms = self.p.value[a].abs() + largest[a];
            // Not a number where the largest would not be that of a finite sum.
            let poison = largest_rate * T::constant(256.0) * T::zero();
            floor[a] = terms * unit + largest_rate * of_rate + T::SMALLEST_NORMAL + poison;
        });
        floor
    }

    /// The step of some members, by each member's own run.
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
                self.write_slack(lane, slack);
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

/// [`reciprocals`](super::problem::reciprocals) of each.
#[inline(always)]
fn reciprocals<T: Scalar, const N: usize, const W: usize>(
    floor: &MemberVector<T, N, W>,
) -> MemberVector<T, N, W> {
    let mut reciprocals = *floor;
    each_coordinate!(a => {
        reciprocals[a] = Members::splat(T::one()) / floor[a] + floor[a] * T::zero();
    });
    reciprocals
}

/// [`in_units`](super::problem::in_units) of each, of the `largest` residual of each coordinate; not finite
/// where a floor is none.
#[inline(always)]
fn in_units<T: Scalar, const N: usize, const W: usize>(
    largest: &MemberVector<T, N, W>,
    per_floor: &MemberVector<T, N, W>,
) -> Members<T, W> {
    let (mut size, mut poison) = (Members::splat(T::zero()), Members::splat(T::zero()));
    each_coordinate!(a => {
        let units = largest[a] * per_floor[a];
        size = size.larger(units);
        poison = poison + units * T::zero();
    });
    size + poison
}
