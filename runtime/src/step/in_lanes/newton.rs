//! Newton's method for several members at once: the operations of each member's own step, in their order.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use crate::numbers::members::{difference, each_coordinate};
use crate::numbers::{Mask, MatricesOfMembers, MemberVector, Members, NewtonMatrix, Scalar};
use crate::step::newton::{AT_FLOOR, QUICK_ITERATIONS, SLOW, SMALL};
use crate::step::{DiscreteInLanes, Fused};
use crate::system::Lagrangian;

/// The roots of the members that are solved, and both momenta there.
#[derive(Clone, Copy)]
pub(crate) struct Roots<T, const N: usize, const W: usize> {
    pub(crate) is_solved: Mask<W>,
    pub(crate) v: MemberVector<T, N, W>,
    pub(crate) momenta: [MemberVector<T, N, W>; 2],
}

impl<T: Scalar, const N: usize, const W: usize> Roots<T, N, W> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn none(guess: &MemberVector<T, N, W>) -> Self {
        Self { is_solved: Mask::splat(false), v: *guess, momenta: [*guess; 2] }
    }

    /// Adds the roots of the members of `whose`, with both momenta.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn add(
        &mut self,
        whose: Mask<W>,
        v: &MemberVector<T, N, W>,
        [p0, p1]: &[MemberVector<T, N, W>; 2],
    ) {
        each_coordinate!(a => {
            self.v[a] = Members::select(whose, v[a], self.v[a]);
            self.momenta[0][a] = Members::select(whose, p0[a], self.momenta[0][a]);
            self.momenta[1][a] = Members::select(whose, p1[a], self.momenta[1][a]);
        });
        self.is_solved = self.is_solved | whose;
    }
}

/// The matrices of W members by the rule.
pub(crate) type MatricesOf<L, R, const N: usize, const W: usize> =
    <<L as Fused<R, N>>::Matrix as NewtonMatrix<<L as Lagrangian<N>>::Scalar, N>>::OfMembers<W>;

/// [`quick`](crate::step::newton::quick) of each of `whose`: it leaves those unsolved that quick leaves, and
/// some with numbers near overflow.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn quick_in_lanes<L, R, const N: usize, const W: usize>(
    fields: &L::Fields<'_, W>,
    [q, p]: [&MemberVector<L::Scalar, N, W>; 2],
    h: L::Scalar,
    guess: &MemberVector<L::Scalar, N, W>,
    whose: Mask<W>,
) -> Roots<L::Scalar, N, W>
where
    L: DiscreteInLanes<R, N>,
{
    let one = Members::splat(L::Scalar::constant(1.0));
    let mut roots = Roots::none(guess);
    let mut v = *guess;
    let mut is_open = whose;
    let mut weights = *guess;
    let slowest = Members::splat(L::Scalar::constant(SLOW));
    let (mut last_size, mut slow) = (one, slowest);
    for iterations in 0..QUICK_ITERATIONS {
        let (p0, matrix) = L::step_kernel_in_lanes(fields, q, &v, h);
        let residual = difference(&p0, p);
        let (correction, has_solution) = MatricesOf::<L, R, N, W>::solution(&matrix, &residual);
        is_open = is_open & has_solution;
        let next = difference(&v, &correction);
        let mut is_close = is_open;
        if !L::LINEAR {
            if iterations == 0 {
                let floor =
                    estimated_floor(p, &MatricesOf::<L, R, N, W>::magnitudes_of(&matrix, &scaled(&next)));
                weights = reciprocals(&floor);
            }
            let size = weighted(&residual, &weights);
            let mut is_known = size.less_or_equal(one);
            if iterations > 0 {
                let contraction = size / last_size;
                let is_slow_at_floor = is_known & contraction.less_or_equal(slowest);
                is_open = is_open & (contraction.less_or_equal(slow) | is_slow_at_floor);
                is_known = is_known | (contraction * contraction * size).less_or_equal(one);
                slow = contraction * Members::splat(L::Scalar::constant(0.5));
            }
            last_size = size;
            is_close = is_open & is_known;
        }
        if is_close.0.contains(&true) {
            let momenta = L::momenta_in_lanes(fields, q, &next, h);
            let residual = difference(&momenta[0], p);
            let floor = estimated_floor(p, &MatricesOf::<L, R, N, W>::magnitudes_of(&matrix, &scaled(&next)));
            let mut is_root = is_close & is_at_floor(&residual, &floor);
            if !L::LINEAR {
                is_root = is_root & (is_known_at(&next, &correction) | is_small_beside(&residual, p));
            }
            roots.add(is_root, &next, &momenta);
            is_open = is_open & !is_root;
        }
        if !is_open.0.contains(&true) {
            break;
        }
        v = next;
    }
    roots
}

/// [`is_known_at`](crate::step::newton) of each.
#[cfg_attr(not(debug_assertions), inline(always))]
fn is_known_at<T: Scalar, const N: usize, const W: usize>(
    v: &MemberVector<T, N, W>,
    correction: &MemberVector<T, N, W>,
) -> Mask<W> {
    let mut is_known = Mask::splat(true);
    each_coordinate!(a => {
        is_known = is_known & correction[a].abs().less_or_equal(v[a].abs() * T::constant(SMALL));
    });
    is_known
}

/// [`is_small_beside`](crate::step::newton::is_small_beside) of each.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn is_small_beside<T: Scalar, const N: usize, const W: usize>(
    residual: &MemberVector<T, N, W>,
    p: &MemberVector<T, N, W>,
) -> Mask<W> {
    let unit = T::EPSILON * T::constant(8.0 * AT_FLOOR);
    let mut is_small = Mask::splat(true);
    each_coordinate!(a => {
        is_small = is_small & residual[a].abs().less_or_equal(p[a].abs() * unit);
    });
    is_small
}

/// v in units of which [`estimated_floor`] takes the magnitudes.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn scaled<T: Scalar, const N: usize, const W: usize>(
    v: &MemberVector<T, N, W>,
) -> MemberVector<T, N, W> {
    let unit = T::EPSILON * T::constant(4.0);
    let mut scaled = *v;
    each_coordinate!(a => {
        scaled[a] = v[a] * unit;
    });
    scaled
}

/// [`estimated_floor`](crate::step::newton::estimated_floor) of each, with the magnitudes of the [`scaled`]
/// v.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn estimated_floor<T: Scalar, const N: usize, const W: usize>(
    p: &MemberVector<T, N, W>,
    magnitudes: &MemberVector<T, N, W>,
) -> MemberVector<T, N, W> {
    let unit = T::EPSILON * T::constant(4.0);
    let mut floor = *magnitudes;
    each_coordinate!(a => {
        floor[a] = magnitudes[a] + (p[a].abs() * unit + T::SMALLEST_NORMAL);
    });
    floor
}

/// 1/x.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn reciprocals<T: Scalar, const N: usize, const W: usize>(
    x: &MemberVector<T, N, W>,
) -> MemberVector<T, N, W> {
    let mut reciprocals = *x;
    each_coordinate!(a => {
        reciprocals[a] = Members::splat(T::one()) / x[a];
    });
    reciprocals
}

/// [`weighted`](crate::step::newton::weighted) of each: NaN where a number is none, and where their sum, in
/// whatever order, might overflow.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn weighted<T: Scalar, const N: usize, const W: usize>(
    residual: &MemberVector<T, N, W>,
    weights: &MemberVector<T, N, W>,
) -> Members<T, W> {
    let (mut size, mut sum) = (Members::splat(T::zero()), Members::splat(T::zero()));
    each_coordinate!(a => {
        let units = residual[a].abs() * weights[a];
        size = units.larger(size);
        sum = sum + units;
    });
    size + sum * T::constant(256.0) * T::zero()
}

/// max |vᵢ| of each.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn largest<T: Scalar, const N: usize, const W: usize>(v: &MemberVector<T, N, W>) -> Members<T, W> {
    let mut largest = Members::splat(T::zero());
    each_coordinate!(a => {
        largest = v[a].abs().larger(largest);
    });
    largest
}

/// Which members have the residual of a root, by [`held_against`](crate::step::newton::held_against).
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn is_at_floor<T: Scalar, const N: usize, const W: usize>(
    residual: &MemberVector<T, N, W>,
    floor: &MemberVector<T, N, W>,
) -> Mask<W> {
    let mut is_root = Mask::splat(true);
    each_coordinate!(a => {
        let most = floor[a] * T::constant(AT_FLOOR);
        is_root = is_root & residual[a].abs().less_or_equal(most) & most.is_finite();
    });
    is_root
}
