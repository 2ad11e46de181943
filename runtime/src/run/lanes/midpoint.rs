//! Steps by the midpoint rule of several members at once.
//!
//! All members start from the guesses of their own runs and are solved together, by Newton's method or by the
//! matrices that they keep. A step that leaves the usual path (the first of a run, one whose matrix is
//! renewed or whose rounding has to be measured, a guess that leads nowhere) the member takes alone, by the
//! functions of its own run, and comes back to the others.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use super::{begins, state_if_sound};
use crate::numbers::members::{coordinate_by_coordinate, each_coordinate, member, write_member};
use crate::numbers::{Mask, MatricesOfMembers, MemberVector, Members, Scalar};
use crate::rules::Midpoint;
use crate::run::memory::in_lanes::{by_kept_matrices, by_linear_matrices};
use crate::run::{FlowInLanes, LaneRuns};
use crate::step::in_lanes::clocks::Clocks;
use crate::step::in_lanes::newton::{MatricesOf, Roots, quick_in_lanes};
use crate::step::{DiscreteInLanes, Fused, Memory, MemoryInLanes, State, VelocityHistory};
use crate::system::Lagrangian;

/// W members on their way by steps that are solved for v̄.
#[derive(Clone, Copy, Debug)]
pub struct StepsInLanes<T, F, M, A, const N: usize, const W: usize> {
    /// Members that have not failed: their q and p equal those of their own runs.
    is_sound: Mask<W>,
    /// Members that take the next step by Newton's method, and by the matrix kept; the others take it alone.
    is_by_newton: Mask<W>,
    is_by_matrix: Mask<W>,
    fields: F,
    h: T,
    q: MemberVector<T, N, W>,
    p: MemberVector<T, N, W>,
    /// The latest mean velocities, newest first, and how many of them are known.
    velocities: [MemberVector<T, N, W>; 4],
    known: [usize; W],
    clocks: Clocks<W>,
    /// All else that runs keep.
    memories: [M; W],
    matrices: A,
    /// Steps that a member has taken alone.
    alone: u64,
}

/// [`StepsInLanes`] of the system type `L`.
type Of<L, const N: usize, const W: usize> = StepsInLanes<
    <L as Lagrangian<N>>::Scalar,
    <L as DiscreteInLanes<Midpoint, N>>::Fields<W>,
    <L as Fused<Midpoint, N>>::Memory,
    MatricesOf<L, Midpoint, N, W>,
    N,
    W,
>;

impl<T, F, M, A, const N: usize, const W: usize> StepsInLanes<T, F, M, A, N, W>
where
    T: Scalar,
    F: Copy,
    M: Copy + Default,
    A: MatricesOfMembers<T, N, W>,
{
    /// No member yet.
    fn new(fields: F, h: T) -> Self {
        let zero = [Members::splat(T::zero()); N];
        Self {
            is_sound: Mask::splat(false),
            is_by_newton: Mask::splat(false),
            is_by_matrix: Mask::splat(false),
            fields,
            h,
            q: zero,
            p: zero,
            velocities: [zero; 4],
            known: [0; W],
            clocks: Clocks::new(),
            memories: [M::default(); W],
            matrices: A::zero(),
            alone: 0,
        }
    }

    /// Puts a member into a lane, at its start; `begins`: whether a run does.
    fn put(&mut self, lane: usize, start: &State<T, N>, begins: bool) {
        self.is_sound.0[lane] = begins;
        self.is_by_newton.0[lane] = false;
        self.is_by_matrix.0[lane] = false;
        self.known[lane] = 0;
        self.clocks.restart(lane);
        self.memories[lane] = M::default();
        write_member(&mut self.q, lane, &start.q);
        write_member(&mut self.p, lane, &start.p);
    }

    /// [`VelocityHistory::extrapolation`] of each that has a velocity.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn extrapolation(&self) -> MemberVector<T, N, W> {
        let [a, b, c, d] = &self.velocities;
        let (two, three, four, six) =
            (T::constant(2.0), T::constant(3.0), T::constant(4.0), T::constant(6.0));
        let mut guess = *a;
        each_coordinate!(i => {
            guess[i] = (a[i] + c[i]) * four - b[i] * six - d[i];
        });
        if self.known.iter().any(|&known| known < 4) {
            let [is_first, is_second, is_third] =
                [1, 2, 3].map(|count| Mask(self.known.map(|known| known == count)));
            coordinate_by_coordinate!(i => {
                guess[i] = Members::select(is_third, (a[i] - b[i]) * three + c[i], guess[i]);
                guess[i] = Members::select(is_second, a[i] * two - b[i], guess[i]);
                guess[i] = Members::select(is_first, a[i], guess[i]);
            });
        }
        guess
    }

    /// Takes the steps to these roots, and returns the members that have taken them.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn follow(&mut self, roots: &Roots<T, N, W>) -> Mask<W> {
        let (mut q, mut p) = (self.q, self.p);
        let mut has_stepped = roots.is_solved;
        coordinate_by_coordinate!(a => {
            q[a] = q[a] + roots.v[a] * self.h;
            p[a] = p[a] + (roots.momenta[1][a] - roots.momenta[0][a]);
            has_stepped = has_stepped & q[a].is_finite() & p[a].is_finite();
        });
        coordinate_by_coordinate!(a => {
            self.q[a] = Members::select(has_stepped, q[a], self.q[a]);
            self.p[a] = Members::select(has_stepped, p[a], self.p[a]);
            for age in (1..4).rev() {
                self.velocities[age][a] =
                    Members::select(has_stepped, self.velocities[age - 1][a], self.velocities[age][a]);
            }
            self.velocities[0][a] = Members::select(has_stepped, roots.v[a], self.velocities[0][a]);
        });
        for lane in 0..W {
            let known = (self.known[lane] + usize::from(has_stepped.0[lane])).min(4);
            self.known[lane] = known;
        }
        self.clocks.follow(has_stepped);
        has_stepped
    }
}

/// All members on by so many steps.
#[cfg_attr(not(debug_assertions), inline(always))]
fn advance<L, const N: usize, const W: usize>(steps: &mut Of<L, N, W>, systems: [&L; W], count: u64)
where
    L: DiscreteInLanes<Midpoint, N>,
{
    for _ in 0..count {
        let mut fields = steps.fields;
        if <L as DiscreteInLanes<Midpoint, N>>::IS_TIMED {
            fields = L::later_in_lanes(&fields, &steps.clocks.elapsed(steps.h));
        }
        let guess = steps.extrapolation();
        let mut is_alone = steps.is_sound;
        let by_newton = steps.is_sound & steps.is_by_newton;
        let by_matrix = steps.is_sound & steps.is_by_matrix;
        if by_newton.0.contains(&true) {
            let at = [&steps.q, &steps.p];
            let roots = quick_in_lanes::<L, Midpoint, N, W>(&fields, at, steps.h, &guess, by_newton);
            let has_stepped = steps.follow(&roots);
            is_alone = is_alone & !has_stepped;
            if L::Memory::KEEPS {
                pause::<L, N, W>(steps, has_stepped);
            }
        }
        if L::Memory::KEEPS && by_matrix.0.contains(&true) {
            let (matrices, fields, at) = (&steps.matrices, &fields, [&steps.q, &steps.p]);
            let (roots, corrections) = if L::LINEAR {
                by_linear_matrices::<L, Midpoint, N, W>(matrices, fields, at, steps.h, &guess, by_matrix)
            } else {
                by_kept_matrices::<L, Midpoint, N, W>(matrices, fields, at, steps.h, &guess, by_matrix)
            };
            let before = steps.q;
            let has_stepped = steps.follow(&roots);
            is_alone = is_alone & !has_stepped;
            serve(steps, systems, &before, has_stepped, &corrections);
        }
        if is_alone.0.contains(&true) {
            step_alone(steps, systems, is_alone);
        }
    }
}

/// Steps by Newton's method have been taken.
fn pause<L, const N: usize, const W: usize>(steps: &mut Of<L, N, W>, has_stepped: Mask<W>)
where
    L: DiscreteInLanes<Midpoint, N>,
{
    for lane in 0..W {
        if has_stepped.0[lane] {
            steps.memories[lane].has_paused();
            if !steps.memories[lane].is_by_newton() {
                look_ahead::<L, N, W>(steps, lane);
            }
        }
    }
}

/// Steps by the matrices kept have been taken, from `before`.
fn serve<L, const N: usize, const W: usize>(
    steps: &mut Of<L, N, W>,
    systems: [&L; W],
    before: &MemberVector<L::Scalar, N, W>,
    has_stepped: Mask<W>,
    corrections: &[u32; W],
) where
    L: DiscreteInLanes<Midpoint, N>,
{
    for lane in 0..W {
        if has_stepped.0[lane] {
            let state = State { q: member(before, lane), p: member(&steps.p, lane) };
            let step = (member(&steps.velocities[0], lane), steps.h);
            let elapsed = steps.clocks.elapsed_before(lane, steps.h);
            let memory = &mut steps.memories[lane];
            let is_another = systems[lane]
                .later(elapsed, |system| memory.has_served(system, &state, step, corrections[lane]));
            if is_another {
                look_ahead::<L, N, W>(steps, lane);
            }
        }
    }
}

/// How the next step of a member is taken.
fn look_ahead<L, const N: usize, const W: usize>(steps: &mut Of<L, N, W>, lane: usize)
where
    L: DiscreteInLanes<Midpoint, N>,
{
    let memory = &steps.memories[lane];
    steps.is_by_newton.0[lane] = memory.is_by_newton();
    steps.is_by_matrix.0[lane] = false;
    if let Some((matrix, factored)) = memory.kept(steps.h) {
        steps.is_by_matrix.0[lane] = true;
        steps.matrices.write(lane, matrix, factored);
    }
}

/// The step of some members, by each member's own run.
#[cold]
#[inline(never)]
fn step_alone<L, const N: usize, const W: usize>(steps: &mut Of<L, N, W>, systems: [&L; W], is_alone: Mask<W>)
where
    L: DiscreteInLanes<Midpoint, N>,
{
    for (lane, system) in systems.into_iter().enumerate().filter(|(lane, _)| is_alone.0[*lane]) {
        steps.alone += 1;
        let state = State { q: member(&steps.q, lane), p: member(&steps.p, lane) };
        let velocities = core::array::from_fn(|age| member(&steps.velocities[age], lane));
        let (elapsed, h) = (steps.clocks.elapsed_of(lane, steps.h), steps.h);
        let memory = &mut steps.memories[lane];
        *memory.history() = VelocityHistory::of(velocities, steps.known[lane], h);
        let Ok(step) = system.later(elapsed, |system| memory.advance(system, &state, h)) else {
            steps.is_sound.0[lane] = false;
            continue;
        };
        let (velocities, known) = memory.history().velocities();
        for (all, own) in steps.velocities.iter_mut().zip(velocities) {
            write_member(all, lane, own);
        }
        steps.known[lane] = known;
        steps.clocks.follow_one(lane);
        write_member(&mut steps.q, lane, &step.state.q);
        write_member(&mut steps.p, lane, &step.state.p);
        look_ahead::<L, N, W>(steps, lane);
    }
}
impl<L, const N: usize> FlowInLanes<Midpoint, N> for L
where
    L: DiscreteInLanes<Midpoint, N>,
{
    type Lanes<const W: usize> = Of<L, N, W>;

    /// Iterations go on until the last member is solved: the more there are, the more wait.
    const MOST_LANES: usize = 16;

    fn in_lanes<const W: usize>(
        systems: [&Self; W],
        starts: &[State<L::Scalar, N>; W],
        h: L::Scalar,
    ) -> Self::Lanes<W> {
        let mut lanes = Of::<L, N, W>::new(L::fields(systems), h);
        for (lane, (system, start)) in systems.into_iter().zip(starts).enumerate() {
            lanes.put(lane, start, begins(lane, system, start, h));
        }
        lanes
    }

    fn refill_lanes<const W: usize>(
        lanes: &mut Self::Lanes<W>,
        systems: [&Self; W],
        starts: &[Option<State<L::Scalar, N>>; W],
        h: L::Scalar,
    ) {
        lanes.fields = L::fields(systems);
        for (lane, (system, start)) in systems.into_iter().zip(starts).enumerate() {
            if let Some(start) = start {
                lanes.put(lane, start, begins(lane, system, start, h));
            }
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance_in_lanes<const W: usize>(lanes: &mut Self::Lanes<W>, systems: [&Self; W], steps: u64) {
        advance(lanes, systems, steps);
    }

    #[inline]
    fn state_of_lane<const W: usize>(lanes: &Self::Lanes<W>, lane: usize) -> Option<State<L::Scalar, N>> {
        state_if_sound(&lanes.q, &lanes.p, lanes.is_sound, lane)
    }
}

impl<L, const N: usize, const W: usize> LaneRuns<'_, L, Midpoint, N, W>
where
    L: DiscreteInLanes<Midpoint, N>,
{
    /// How many steps members have taken by their own runs, of all members together: the first of each, and
    /// those that leave the usual path. Where they are many, lanes gain little.
    #[must_use]
    pub fn steps_alone(&self) -> u64 {
        self.lanes.alone
    }
}
