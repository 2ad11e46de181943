//! Noise of the stages' residuals, where neither the terms of their equations nor last places say how they
//! round: `numbers/nonlinear/noise.rs` has the definition.

use core::array;

use nalgebra::SVector;

use super::linearised::{Factored, Local, StageVector, locals};
use super::problem::Problem;
use crate::numbers::nonlinear::{self, AROUND, Room, WITHIN_NOISE, shift};
use crate::numbers::{LaneVector, Scalar, lanes::lane};
use crate::system::ForcedLagrangian;

/// The part of a coordinate's own second derivatives by which those nearby may differ, to be called the same.
const SAME: f64 = 1.0 / 16.0;

/// The part of a correction by which those of matrices nearby may differ from it.
const ALIKE: f64 = 1.0 / 8.0;

/// The residual that is left at an iterate that the `correction` from the one before led to.
pub(super) struct Left<'a, T, const N: usize, const S: usize> {
    pub(super) v: &'a LaneVector<T, N, S>,
    pub(super) residual: &'a LaneVector<T, N, S>,
    pub(super) floor: &'a SVector<T, N>,
    pub(super) locals: &'a [Local<T, N>; S],
    pub(super) correction: &'a StageVector<T, N, S>,
}

/// The floor with the noise of the residual, if that explains what is left of it.
#[cold]
#[inline(never)]
pub(super) fn noise<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    left: &Left<'_, T, N, S>,
    before: &[Local<T, N>; S],
) -> Option<SVector<T, N>> {
    let Left { v: at_stages, residual: of_stages, locals: here, correction, .. } = *left;
    let h = problem.h.abs();
    let residuals = array::from_fn(|i| lane(of_stages, i));
    let own = Factored::new(problem, here).ok()?.solve(&residuals);
    // Entries that hardly change, where the matrix is nearly singular, change what it corrects altogether.
    let corrects_alike = |now: &[Local<T, N>; S]| {
        let Ok(factored) = Factored::new(problem, now) else { return false };
        let (mut apart, mut all) = (T::zero(), T::zero());
        for ((other, own), here) in factored.solve(&residuals).iter().zip(&own).zip(here) {
            for a in 0..N {
                let (weight, difference) = (size(here, h, (a, a)), other[a] - own[a]);
                apart += difference * difference * weight;
                all += own[a] * own[a] * weight;
            }
        }
        apart <= all * T::constant(ALIKE * ALIKE) && all > T::SMALLEST_NORMAL && all.is_finite()
    };
    let is_same = |now: &[Local<T, N>; S]| {
        now.iter().zip(here).all(|(now, here)| {
            (0..N).all(|a| {
                (0..N).all(|b| {
                    // Not their product, which may overflow.
                    let scale = size(here, h, (a, a)).sqrt() * size(here, h, (b, b)).sqrt();
                    // Beside what overflows everything is near.
                    scale.is_finite() && is_near(now, here, h, (a, b), scale * T::constant(SAME / N as f64))
                })
            })
        }) && corrects_alike(now)
    };
    // Where a product of step sizes underflows or overflows, the matrix is not that of the equations.
    if h * h <= T::SMALLEST_NORMAL || !(h * h).is_finite() || !is_same(before) {
        return None;
    }
    for direction in 0..2 {
        for away in &AROUND {
            let mut v = *at_stages;
            for (i, correction) in correction.iter().enumerate() {
                for a in 0..N {
                    v[a].0[i] += correction[a] * T::constant(*away * shift(direction, a));
                }
            }
            if !is_same(&locals(problem, &v)) {
                return None;
            }
        }
    }

    let mut buffer = [[[T::zero(); N]; S]; WITHIN_NOISE];
    let [mut at, mut residual, mut change, mut measured] = [[[T::zero(); N]; S]; 4];
    // One floor for a coordinate, in all stages.
    let floor = [(*left.floor).into(); S];
    for i in 0..S {
        for a in 0..N {
            (at[i][a], residual[i][a]) = (at_stages[a].0[i], of_stages[a].0[i]);
            for (here, correction) in here.iter().zip(correction) {
                for b in 0..N {
                    change[i][a] += size(here, h, (a, b)) * correction[b].abs();
                }
            }
        }
    }
    let correction: [[T; N]; S] = correction.map(Into::into);
    let mut function = |at: &[T], residual: &mut [T]| {
        let mut v = *at_stages;
        for (i, at) in (0..S).zip(at.as_chunks::<N>().0) {
            for a in 0..N {
                v[a].0[i] = at[a];
            }
        }
        let found = problem.stages(&v).residual;
        for (i, residual) in (0..S).zip(residual.as_chunks_mut::<N>().0) {
            for a in 0..N {
                residual[a] = found[a].0[i];
            }
        }
    };
    let left = nonlinear::Left {
        at: at.as_flattened(),
        residual: residual.as_flattened(),
        correction: correction.as_flattened(),
        change: change.as_flattened(),
        floor: floor.as_flattened(),
    };
    let room = Room::new(buffer.as_flattened_mut().as_flattened_mut(), N * S);
    T::add_noise(&mut function, &left, measured.as_flattened_mut(), room).then(|| {
        SVector::from_fn(|a, _| measured.iter().fold(T::zero(), |most, of_stage| most.max(of_stage[a])))
    })
}

/// |M| + h |B − C| + h² |K|, the terms of an entry of the matrix.
fn size<T: Scalar, const N: usize>(local: &Local<T, N>, h: T, entry: (usize, usize)) -> T {
    let terms = [
        local.mass[entry],
        local.momentum_by_q[entry] * h,
        local.rate_by_v[entry] * h,
        local.rate_by_q[entry] * (h * h),
    ];
    terms.iter().fold(T::zero(), |sum, term| sum + term.abs())
}

/// Whether the terms of an entry differ by at most `scale`.
fn is_near<T: Scalar, const N: usize>(
    now: &Local<T, N>,
    last: &Local<T, N>,
    h: T,
    entry: (usize, usize),
    scale: T,
) -> bool {
    let differences = [
        now.mass[entry] - last.mass[entry],
        (now.momentum_by_q[entry] - last.momentum_by_q[entry]) * h,
        (now.rate_by_v[entry] - last.rate_by_v[entry]) * h,
        (now.rate_by_q[entry] - last.rate_by_q[entry]) * (h * h),
    ];
    differences.iter().fold(T::zero(), |sum, term| sum + term.abs()) <= scale
}
