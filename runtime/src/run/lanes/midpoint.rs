//! Steps by the midpoint rule of several members at once.
//!
//! All members start from the guesses of their own runs and are solved together, by Newton's method or by the
//! matrices that they keep. A step that leaves the usual path (the first of a run, one whose matrix is
//! renewed or whose rounding has to be measured, a guess that leads nowhere) the member takes alone, by the
//! functions of its own run, and comes back to the others.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use crate::numbers::members::{coordinate_by_coordinate, each_coordinate, member, write_member};
use crate::numbers::{Mask, MatricesOfMembers, MemberVector, Members, Scalar};
use crate::rules::Midpoint;
use crate::run::memory::in_lanes::{by_kept_matrices, by_linear_matrices};
use crate::step::in_lanes::newton::{MatricesOf, Roots, quick_in_lanes};
use crate::step::{
    DiscreteInLanes, Ends, FlowInLanes, Fused, LaneRuns, Memory, MemoryInLanes, State, VelocityHistory,
};
use crate::system::Lagrangian;

/// Values kept of W members on their way by steps that are solved for v̄.
#[derive(Clone, Copy, Debug)]
pub struct MemoriesInLanes<T, M, A, const N: usize, const W: usize> {
    /// Members that take the next step by Newton's method, and by the matrix kept; others take it alone.
    is_by_newton: Mask<W>,
    is_by_matrix: Mask<W>,
    /// The latest mean velocities, newest first, and how many of them are known.
    velocities: [MemberVector<T, N, W>; 4],
    known: [usize; W],
    /// All else that runs keep.
    memories: [M; W],
    matrices: A,
}

/// [`MemoriesInLanes`] of the system type `L`.
type Of<L, const N: usize, const W: usize> = MemoriesInLanes<
    <L as Lagrangian<N>>::Scalar,
    <L as Fused<Midpoint, N>>::Memory,
    MatricesOf<L, Midpoint, N, W>,
    N,
    W,
>;

impl<T: Scalar, M, A, const N: usize, const W: usize> MemoriesInLanes<T, M, A, N, W> {
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
}

impl<L: DiscreteInLanes<Midpoint, N>, const N: usize, const W: usize> LaneRuns<'_, L, Midpoint, N, W> {
    /// Takes the steps to these roots, and returns the members that have taken them.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn follow(&mut self, roots: &Roots<L::Scalar, N, W>) -> Mask<W> {
        let (mut q, mut p) = (self.q.value, self.p.value);
        let mut has_stepped = roots.is_solved;
        coordinate_by_coordinate!(a => {
            q[a] = q[a] + roots.v[a] * self.h;
            p[a] = p[a] + (roots.momenta[1][a] - roots.momenta[0][a]);
            has_stepped = has_stepped & q[a].is_finite() & p[a].is_finite();
        });
        let MemoriesInLanes { velocities, known, .. } = &mut self.kept;
        coordinate_by_coordinate!(a => {
            self.q.value[a] = Members::select(has_stepped, q[a], self.q.value[a]);
            self.p.value[a] = Members::select(has_stepped, p[a], self.p.value[a]);
            for age in (1..4).rev() {
                velocities[age][a] = Members::select(has_stepped, velocities[age - 1][a], velocities[age][a]);
            }
            velocities[0][a] = Members::select(has_stepped, roots.v[a], velocities[0][a]);
        });
        for lane in 0..W {
            known[lane] = (known[lane] + usize::from(has_stepped.0[lane])).min(4);
        }
        has_stepped
    }

    /// Takes in steps by Newton's method.
    fn pause(&mut self, has_stepped: Mask<W>) {
        for lane in (0..W).filter(|&lane| has_stepped.0[lane]) {
            let memory = &mut self.kept.memories[lane];
            memory.has_paused();
            if !memory.is_by_newton() {
                self.look_ahead(lane);
            }
        }
    }

    /// Takes in steps by the matrices kept, so many steps into the call, from q = `before`, each in so many
    /// corrections.
    fn serve(
        &mut self,
        has_stepped: Mask<W>,
        steps: u64,
        before: &MemberVector<L::Scalar, N, W>,
        corrections: &[u32; W],
    ) {
        let elapsed = self.clocks.elapsed(steps, self.h);
        for lane in (0..W).filter(|&lane| has_stepped.0[lane]) {
            let (system, memory) = (self.systems[lane], &mut self.kept.memories[lane]);
            let state = State { q: member(before, lane), p: member(&self.p.value, lane) };
            let step = (member(&self.kept.velocities[0], lane), self.h);
            let is_another = system
                .later(elapsed.0[lane], |system| memory.has_served(system, &state, step, corrections[lane]));
            if is_another {
                self.look_ahead(lane);
            }
        }
    }

    /// Decides how the next step of a member is taken.
    fn look_ahead(&mut self, lane: usize) {
        let MemoriesInLanes { is_by_newton, is_by_matrix, memories, matrices, .. } = &mut self.kept;
        let memory = &memories[lane];
        is_by_newton.0[lane] = memory.is_by_newton();
        is_by_matrix.0[lane] = false;
        if let Some((matrix, factored)) = memory.kept(self.h) {
            is_by_matrix.0[lane] = true;
            matrices.write(lane, matrix, factored);
        }
    }
}

impl<L: DiscreteInLanes<Midpoint, N>, const N: usize> FlowInLanes<Midpoint, N> for L {
    type Kept<const W: usize> = Of<L, N, W>;

    /// Iterations go on until the last member is solved: the more there are, the more wait.
    const MOST_LANES: usize = 16;

    fn kept<const W: usize>(_h: L::Scalar) -> Self::Kept<W> {
        MemoriesInLanes {
            is_by_newton: Mask::splat(false),
            is_by_matrix: Mask::splat(false),
            velocities: [[Members::splat(nalgebra::zero()); N]; 4],
            known: [0; W],
            memories: [L::Memory::default(); W],
            matrices: MatricesOfMembers::zero(),
        }
    }

    fn put<const W: usize>(runs: &mut LaneRuns<'_, L, Midpoint, N, W>, lane: usize) -> bool {
        runs.kept.is_by_newton.0[lane] = false;
        runs.kept.is_by_matrix.0[lane] = false;
        runs.kept.known[lane] = 0;
        runs.kept.memories[lane] = L::Memory::default();
        true
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance_in_lanes<const W: usize>(runs: &mut LaneRuns<'_, L, Midpoint, N, W>, steps: u64) {
        for step in 0..steps {
            let mut fields = runs.fields;
            if L::IS_TIMED {
                fields = L::later_in_lanes(&fields, &runs.clocks.elapsed(step, runs.h));
            }
            let guess = runs.kept.extrapolation();
            let mut is_alone = runs.is_sound;
            let by_newton = runs.is_sound & runs.kept.is_by_newton;
            let by_matrix = runs.is_sound & runs.kept.is_by_matrix;
            if by_newton.0.contains(&true) {
                let at = [&runs.q.value, &runs.p.value];
                let roots = quick_in_lanes::<L, Midpoint, N, W>(&fields, at, runs.h, &guess, by_newton);
                let has_stepped = runs.follow(&roots);
                is_alone = is_alone & !has_stepped;
                if L::Memory::KEEPS {
                    runs.pause(has_stepped);
                }
            }
            if L::Memory::KEEPS && by_matrix.0.contains(&true) {
                let (matrices, fields, h) = (&runs.kept.matrices, &fields, runs.h);
                let at = [&runs.q.value, &runs.p.value];
                let (roots, corrections) = if L::LINEAR {
                    by_linear_matrices::<L, Midpoint, N, W>(matrices, fields, at, h, &guess, by_matrix)
                } else {
                    by_kept_matrices::<L, Midpoint, N, W>(matrices, fields, at, h, &guess, by_matrix)
                };
                let before = runs.q.value;
                let has_stepped = runs.follow(&roots);
                is_alone = is_alone & !has_stepped;
                runs.serve(has_stepped, step, &before, &corrections);
            }
            if is_alone.0.contains(&true) {
                runs.step_alone(is_alone, step);
            }
        }
    }

    fn alone<const W: usize>(
        runs: &mut LaneRuns<'_, L, Midpoint, N, W>,
        lane: usize,
        elapsed: L::Scalar,
    ) -> Option<Ends<L::Scalar, N>> {
        let (system, state, h) = (runs.systems[lane], runs.values(lane), runs.h);
        let kept = &mut runs.kept;
        let velocities = core::array::from_fn(|age| member(&kept.velocities[age], lane));
        let memory = &mut kept.memories[lane];
        *memory.history() = VelocityHistory::of(velocities, kept.known[lane], h);
        let step = system.later(elapsed, |system| memory.advance(system, &state, h)).ok()?;
        let (velocities, known) = memory.history().velocities();
        for (all, own) in kept.velocities.iter_mut().zip(velocities) {
            write_member(all, lane, own);
        }
        kept.known[lane] = known;
        runs.look_ahead(lane);
        Some(step.state.into())
    }
}
