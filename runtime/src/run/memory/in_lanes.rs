//! Steps of several members, each with a Newton matrix kept from an earlier step: the operations of each
//! member's own step, in their order.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use super::kept_matrix::{CLOSE, CONTRACTION, MOST, SMALL};
use crate::numbers::members::{coordinate_by_coordinate, difference};
use crate::numbers::{Mask, MatricesOfMembers, MemberVector, Members, Scalar};
use crate::step::DiscreteInLanes;
use crate::step::in_lanes::newton::{
    MatricesOf, Roots, estimated_floor, is_at_floor, is_small_beside, largest, reciprocals, scaled, weighted,
};
use crate::step::newton::AT_FLOOR;

/// The steps of `whose` by the matrices kept, and their corrections; unsolved are those whose corrections do
/// not shrink fast, and those whose rounding has to be looked at.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn by_kept_matrices<L, R, const N: usize, const W: usize>(
    matrices: &MatricesOf<L, R, N, W>,
    fields: &L::Fields<'_, W>,
    [q, p]: [&MemberVector<L::Scalar, N, W>; 2],
    h: L::Scalar,
    guess: &MemberVector<L::Scalar, N, W>,
    whose: Mask<W>,
) -> (Roots<L::Scalar, N, W>, [u32; W])
where
    L: DiscreteInLanes<R, N>,
{
    let constant = L::Scalar::constant;
    let floor = estimated_floor(p, &matrices.magnitudes(&scaled(guess)));
    let weights = reciprocals(&floor);
    let mut roots = Roots::none(guess);
    let mut corrections = [0; W];
    let mut v = *guess;
    let mut is_open = whose;
    let mut last_size = Members::splat(constant(CLOSE) / (L::Scalar::EPSILON * constant(CONTRACTION)));
    for iterations in 0..=MOST {
        let momenta = L::momenta_in_lanes(fields, q, &v, h);
        let residual = difference(&momenta[0], p);
        let size = weighted(&residual, &weights);
        if iterations > 0 {
            let is_small = is_open & size.less_or_equal(Members::splat(constant(AT_FLOOR)));
            if is_small.0.contains(&true) {
                let below = constant(AT_FLOOR) * (constant(1.0) - L::Scalar::EPSILON * constant(2.0));
                let is_known = is_small_beside(&residual, p);
                let mut is_root = size.less_or_equal(Members::splat(below));
                if (is_small & !is_known).0.contains(&true) {
                    let (_, there) = L::step_kernel_in_lanes(fields, q, &v, h);
                    let magnitudes = MatricesOf::<L, R, N, W>::magnitudes_of(&there, &scaled(&v));
                    let held = is_at_floor(&residual, &estimated_floor(p, &magnitudes));
                    is_root = (is_known & is_root) | (!is_known & held);
                }
                is_root = is_root & is_small;
                roots.add(is_root, &v, &momenta);
                for lane in 0..W {
                    corrections[lane] = if is_root.0[lane] { iterations } else { corrections[lane] };
                }
                is_open = is_open & !is_small;
            }
        }
        is_open = is_open & size.less_or_equal(last_size * constant(CONTRACTION));
        if !is_open.0.contains(&true) {
            break;
        }
        last_size = size;
        v = difference(&v, &matrices.solve(&residual));
    }
    (roots, corrections)
}

/// The steps of `whose` where the equation is linear.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn by_linear_matrices<L, R, const N: usize, const W: usize>(
    matrices: &MatricesOf<L, R, N, W>,
    fields: &L::Fields<'_, W>,
    [q, p]: [&MemberVector<L::Scalar, N, W>; 2],
    h: L::Scalar,
    guess: &MemberVector<L::Scalar, N, W>,
    whose: Mask<W>,
) -> (Roots<L::Scalar, N, W>, [u32; W])
where
    L: DiscreteInLanes<R, N>,
{
    let correction = |v: &_| {
        let [p0, _] = L::momenta_in_lanes(fields, q, v, h);
        matrices.solve(&difference(&p0, p))
    };
    let first = correction(guess);
    let mut v = difference(guess, &first);
    let again = whose & (largest(&v) * L::Scalar::constant(SMALL)).less(largest(&first));
    if again.0.contains(&true) {
        let second = difference(&v, &correction(&v));
        coordinate_by_coordinate!(a => {
            v[a] = Members::select(again, second[a], v[a]);
        });
    }
    let momenta = L::momenta_in_lanes(fields, q, &v, h);
    let floor = estimated_floor(p, &matrices.magnitudes(&scaled(&v)));
    let mut roots = Roots::none(guess);
    roots.add(whose & is_at_floor(&difference(&momenta[0], p), &floor), &v, &momenta);
    (roots, again.0.map(|again| 1 + u32::from(again)))
}
