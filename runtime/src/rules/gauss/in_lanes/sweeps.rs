//! The sweeps over the stages of several members.

use super::allowances::Allowances;
use super::floors::{Floors, Terms, Verdict};
use super::seen::Seen;
use crate::numbers::members::{coordinate_by_coordinate, each_stage, stage_by_stage};
use crate::numbers::{Blank, CompensatedMembers, Mask, MemberVector, Members, Scalar};
use crate::rules::gauss::Gauss;
use crate::rules::gauss::coefficients::Coefficients;
use crate::rules::gauss::fixed_point::MAX_ITERATIONS;
use crate::step::LaneRuns;
use crate::system::{ForcedLagrangianInLanes, Lagrangian};

/// The arrays that the sweeps of each step write before they read them: made once for many steps.
pub(super) struct Sweeps<T, K, A, const N: usize, const S: usize, const W: usize> {
    v: [MemberVector<T, N, W>; S],
    next: [MemberVector<T, N, W>; S],
    rate: [MemberVector<T, N, W>; S],
    /// h b_j V_j, h b_j G_j.
    terms: [[MemberVector<T, N, W>; S]; 2],
    kept: [K; S],
    anchors: [A; S],
}

impl<T: Scalar, K: Blank, A: Blank, const N: usize, const S: usize, const W: usize> Sweeps<T, K, A, N, S, W> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn new() -> Self {
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
pub(super) type SweepsOf<L, const N: usize, const S: usize, const W: usize> = Sweeps<
    <L as Lagrangian<N>>::Scalar,
    <L as ForcedLagrangianInLanes<N>>::Kept<W>,
    <L as ForcedLagrangianInLanes<N>>::AnchorsInLanes<W>,
    N,
    S,
    W,
>;

/// The stages of a step, for the members that are solved.
pub(super) struct Solved<T, const N: usize, const S: usize, const W: usize> {
    pub(super) is_solved: Mask<W>,
    pub(super) v: [MemberVector<T, N, W>; S],
    pub(super) rate: [MemberVector<T, N, W>; S],
}

impl<L: ForcedLagrangianInLanes<N>, const N: usize, const S: usize, const W: usize>
    LaneRuns<'_, L, Gauss<S>, N, W>
{
    const COEFFICIENTS: &'static Coefficients<S> = &Gauss::<S>::COEFFICIENTS;

    /// The velocities of the last step, one step on; of members that have not stepped, those to start from.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn extrapolate(&self, is_fused: bool, extrapolated: &mut [MemberVector<L::Scalar, N, W>; S]) {
        let columns = &Self::COEFFICIENTS.extrapolation;
        stage_by_stage!(i => {
            coordinate_by_coordinate!(a => {
                let mut sums = [Members::splat(nalgebra::zero()); 2];
                each_stage!(j => {
                    sums[j % 2] = self.kept.v[j][a].times_plus(is_fused, L::Scalar::constant(columns[j][i]), sums[j % 2]);
                });
                extrapolated[i][a] = sums[0] + sums[1];
            });
        });
        if self.is_new.0.contains(&true) {
            stage_by_stage!(i => {
                coordinate_by_coordinate!(a => {
                    extrapolated[i][a] = Members::select(self.is_new, self.kept.v[i][a], extrapolated[i][a]);
                });
            });
        }
    }

    /// start + Σ_j μ_ij (h b_j x_j) at the stage i, the `terms` being h b_j x_j.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn at_stage(
        is_fused: bool,
        start: &CompensatedMembers<L::Scalar, N, W>,
        terms: &[MemberVector<L::Scalar, N, W>; S],
        i: usize,
    ) -> MemberVector<L::Scalar, N, W> {
        let columns = &Self::COEFFICIENTS.shares;
        let mut at = [Members::splat(nalgebra::zero()); N];
        coordinate_by_coordinate!(a => {
            let mut sums = [start.rest[a], Members::splat(nalgebra::zero())];
            each_stage!(j => {
                sums[j % 2] = terms[j][a].times_plus(is_fused, L::Scalar::constant(columns[j][i]), sums[j % 2]);
            });
            at[a] = (sums[0] + sums[1]) + start.value[a];
        });
        at
    }

    /// Solves the stages of the members `together`, so many steps into the call, as far as sweeps of the usual
    /// kind do:
    /// [`iterate`](crate::rules::gauss::fixed_point::iterate) of each.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn solve(
        &self,
        step: u64,
        steps: &[L::Scalar; S],
        together: Mask<W>,
        sweeps: &mut SweepsOf<L, N, S, W>,
        solved: &mut Solved<L::Scalar, N, S, W>,
    ) {
        let is_fused = L::STRUCTURE.fused_multiply_add;
        let mut fields = self.fields;
        if L::IS_TIMED {
            fields = L::later_in_lanes(&fields, &self.clocks.elapsed(step, self.h));
        }
        let Sweeps { v, next, rate, terms: [of_v, of_rate], kept, anchors } = sweeps;
        let (mut v, mut next) = (v, next);
        *anchors = Blank::blank();
        self.extrapolate(is_fused, v);
        stage_by_stage!(j => {
            coordinate_by_coordinate!(a => {
                of_v[j][a] = v[j][a] * steps[j];
            });
        });
        solved.is_solved = Mask::splat(false);
        let mut is_open = together;
        let mut allowances = Allowances::new(self.kept.slack, &self.kept.left, self.h, &self.p.value);
        let is_loose = allowances.are_known;
        let some_loose = is_loose.0.contains(&true);
        let some_to_rounding = (together & !is_loose).0.contains(&true);
        let mut floors = Floors::new();
        for iterations in 1..=MAX_ITERATIONS {
            stage_by_stage!(i => {
                let q = Self::at_stage(is_fused, &self.q, of_v, i);
                // One call for both, which is inlined.
                let in_time;
                let mut at_stage = &fields;
                if L::IS_TIMED {
                    let elapsed = Members::<L::Scalar, W>::splat(L::Scalar::constant(Self::COEFFICIENTS.nodes[i]) * self.h);
                    in_time = L::later_in_lanes(&fields, &elapsed);
                    at_stage = &in_time;
                }
                (rate[i], kept[i]) = L::rates_in_lanes(at_stage, &mut anchors[i], &q, &v[i]);
                coordinate_by_coordinate!(a => {
                    of_rate[i][a] = rate[i][a] * steps[i];
                });
            });
            // Of every other stage, by an index that LLVM does not know: as variables, not in memory, they
            // would become vectors of numbers that do not belong together.
            let mut seen = [Seen::nothing(); 2];
            stage_by_stage!(i => {
                let p = Self::at_stage(is_fused, &self.p, of_rate, i);
                let [residual, correction] = L::corrections_in_lanes(&fields, &kept[i], &v[i], &p);
                let now = &mut seen[i % 2];
                let (mut largest, mut sum) = (now.correction, now.sum);
                coordinate_by_coordinate!(a => {
                    next[i][a] = v[i][a] + correction[a];
                    of_v[i][a] = next[i][a] * steps[i];
                    let (residual, correction) = (residual[a].abs(), correction[a].abs());
                    now.residual[a] = now.residual[a].larger(residual);
                    largest = largest.larger(correction);
                    sum = sum + (residual + correction);
                });
                (now.correction, now.sum) = (largest, sum);
            });
            let seen = Seen::of_both(&seen);
            let (mut is_done, mut is_moved) = (Mask::splat(false), is_loose);
            if some_to_rounding {
                let terms = Terms { h: self.h, p: &self.p.value, rate };
                let mass_is_constant = L::STRUCTURE.constant_mass_matrix;
                let Verdict { is_solved, is_at_rest, is_open: may_be } =
                    floors.judge(iterations, is_open & !is_loose, &seen, &terms, mass_is_constant);
                (is_done, is_moved) = (is_solved, is_moved | is_at_rest);
                is_open = (is_open & is_loose) | may_be;
            }
            if some_loose {
                is_done = is_done | allowances.solved(iterations, &mut is_open, &seen);
            }
            if is_done.0.contains(&true) {
                // The first overwrite what is of no step.
                let some_solved = solved.is_solved.0.contains(&true);
                let all_moved = !is_moved.0.contains(&false);
                stage_by_stage!(i => {
                    coordinate_by_coordinate!(a => {
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
        }
    }
}
