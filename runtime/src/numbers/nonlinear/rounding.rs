//! Whether rounding explains what is left of a residual; `step/newton/rounding.rs` has the definition.

use super::equations::{Equations, Matrix};
use super::vectors::{Room, add, copy, largest, sum};
use crate::numbers::Precision;

/// A residual of at most this many floors, estimated or measured, is that of a root.
pub(crate) const AT_FLOOR: f64 = 4.0;

/// A contraction above this is not that of Newton's method: rounding slows it, or the root is far.
pub(crate) const SLOW: f64 = 0.25;

/// A correction of at most this share of v̄ leads to a point where the floor is that of the point before.
pub(crate) const SMALL: f64 = 1.0 / 65536.0;

/// A floor above this share of the terms of the equation says that rounding decides it.
const SENSIBLE: f64 = 1.0 / 1024.0;

/// Whether every floor is at most [`SENSIBLE`] of the `terms` of its equation.
#[cold]
pub(crate) fn is_sensible<S: Precision>(floor: &[S], terms: &[S]) -> bool {
    let mut pairs = floor.iter().zip(terms);
    pairs.all(|(floor, terms)| *floor <= *terms * S::nearest(SENSIBLE) + S::LEAST_NORMAL * S::nearest(4.0))
}

/// Adds `factor` times the absolute values of `terms` where they are finite.
#[cold]
pub(crate) fn add_finite_part<S: Precision>(sums: &mut [S], factor: S, terms: &[S]) {
    for (sum, term) in sums.iter_mut().zip(terms) {
        let term = *term * factor;
        if term.is_finite() {
            *sum += term.abs();
        }
    }
}

/// max |residualᵢ|/floorᵢ. An exact 0 counts 0, whatever its floor; a NaN or infinite ratio is returned as it
/// is.
#[inline]
pub(crate) fn in_units_of<S: Precision>(residual: &[S], floor: &[S]) -> S {
    let mut largest = S::zero();
    for (residual, floor) in residual.iter().zip(floor) {
        if *residual != S::zero() {
            let units = residual.abs() / *floor;
            if !units.is_finite() {
                return units;
            }
            largest = largest.max(units);
        }
    }
    largest
}

/// The larger in units of its floor, of the `worst` so far and of the residuals, with this floor; and whether
/// all are those of a root: at most [`AT_FLOOR`] floors.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn held_one_by_one<S: Precision>(
    residuals: &[S],
    floors: &[S],
    mut worst: (S, S, bool),
) -> (S, S, bool) {
    for (&residual, &floor) in residuals.iter().zip(floors) {
        worst = held(residual, floor, worst);
    }
    worst
}

/// The larger of the `worst` so far and of the residual, whose floor this is; and whether it is still that of
/// a root.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn held<S: Precision>(residual: S, floor: S, worst: (S, S, bool)) -> (S, S, bool) {
    let (size, most) = (residual.abs(), floor * S::nearest(AT_FLOOR));
    // A floor that overflows explains nothing.
    let is_root = worst.2 & (size <= most) & most.is_finite();
    if size * worst.1 > worst.0 * floor { (size, floor, is_root) } else { (worst.0, worst.1, is_root) }
}

/// [`held_one_by_one`] of all.
pub(super) fn held_against<S: Precision>(residual: &[S], floor: &[S]) -> (S, S, bool) {
    match (residual.first(), floor.first()) {
        // One of the residuals from the start: products with one that is tiny, or with a floor that
        // overflows, decide nothing.
        (Some(first), Some(of)) => held_one_by_one(residual, floor, (first.abs(), *of, true)),
        _ => (S::zero(), S::zero(), true),
    }
}

/// The residual that is largest in units of its floor, and this floor.
#[cold]
pub(crate) fn worst<S: Precision>(residual: &[S], floor: &[S]) -> (S, S) {
    let mut pairs = residual.iter().zip(floor).map(|(residual, floor)| (residual.abs(), *floor));
    let first = pairs.next().unwrap_or_else(|| (S::zero(), S::one()));
    pairs.fold(first, |worst, other| if other.0 / other.1 > worst.0 / worst.1 { other } else { worst })
}

/// The floor that the terms of p0 give at `v`, 4ε (|pᵢ| + Σⱼ |Jᵢⱼ||vⱼ|).
#[inline(never)]
pub(super) fn estimated_floor<S: Precision>(
    of: &Equations<'_, S>,
    matrix: Matrix<'_, S>,
    v: &[S],
    floor: &mut [S],
    mut room: Room<'_, S>,
) {
    // Scaled before they are added up, so that only what overflows itself does.
    let unit = S::SPACING * S::nearest(4.0);
    let scaled = room.vector();
    for (scaled, v) in scaled.iter_mut().zip(v) {
        *scaled = *v * unit;
    }
    of.evaluate.magnitudes(matrix, scaled, floor);
    for (floor, p) in floor.iter_mut().zip(of.p) {
        // Below the normal numbers ε no longer bounds the rounding.
        *floor += p.abs() * unit + S::LEAST_NORMAL;
    }
}

/// Last places that rounding is measured over: functions on the way, such as the root in a length, may
/// swallow a single one.
pub(crate) const PLACES: f64 = 8.0;

/// Adds to `sums` the rounding of p0 at `v`: its changes when each entry of q and of v moves by its last
/// place, added up.
#[inline(never)]
pub(super) fn add_rounding<S: Precision>(
    of: &Equations<'_, S>,
    v: &[S],
    sums: &mut [S],
    mut room: Room<'_, S>,
) {
    let [value, moved_q, moved_v, changed] = room.vectors();
    let sum = room.zeros();
    of.p0(of.q, v, value, room.inner());
    copy(moved_q, of.q);
    copy(moved_v, v);
    let places = S::nearest(PLACES);
    for end in [S::one() + S::SPACING * places, S::one() - S::SPACING * places] {
        for i in 0..v.len() {
            for of_q in [true, false] {
                let moved = if of_q { &mut *moved_q } else { &mut *moved_v };
                let Some(entry) = moved.get_mut(i) else { continue };
                let before = *entry;
                *entry *= end;
                of.p0(moved_q, moved_v, changed, room.inner());
                for ((sum, changed), value) in sum.iter_mut().zip(changed.iter()).zip(value.iter()) {
                    *sum += (*changed - *value).abs();
                }
                let moved = if of_q { &mut *moved_q } else { &mut *moved_v };
                if let Some(entry) = moved.get_mut(i) {
                    *entry = before;
                }
            }
        }
    }
    add(sums, S::one() / places, sum);
}

/// The most that [`add_scatter`] moves a velocity, as a share of it: what is left of a smooth function's
/// fourth differences is below ε.
const NEXT_TO: f64 = 1.0 / (1 << 24) as f64;

/// Places and weights of a fourth difference. Static: an array of the loop would take room on a small stack.
static FOURTH_DIFFERENCE: &[(f64, f64)] = &[(2.0, 1.0), (-2.0, 1.0), (1.0, -4.0), (-1.0, -4.0), (0.0, 6.0)];

/// Adds to `sums` how far p0 scatters about a smooth function of v where h v moves by a few last places of q:
/// its fourth differences, which hold up to 16 times the rounding of p0 and a quarter of them mostly at least
/// that.
#[inline(never)]
pub(super) fn add_scatter<S: Precision>(
    of: &Equations<'_, S>,
    v: &[S],
    sums: &mut [S],
    mut room: Room<'_, S>,
) {
    let [change, moved, value, fourth] = room.vectors();
    let found = room.zeros();
    let most = largest(v) * S::nearest(NEXT_TO);
    for k in 1..=8 {
        // Shares of a place that no two coordinates and no two moves have in common.
        for (i, (change, q)) in change.iter_mut().zip(of.q).enumerate() {
            let place = S::SPACING * q.abs() / of.h.abs();
            let share = S::nearest(0.37 * f64::from(k) + 0.173 * i as f64);
            *change = if place * share < most { place * share } else { S::zero() };
        }
        fourth.fill(S::zero());
        for &(places, weight) in FOURTH_DIFFERENCE {
            sum(moved, v, S::nearest(places), change);
            of.p0(of.q, moved, value, room.inner());
            add(fourth, S::nearest(weight), value);
        }
        for (found, fourth) in found.iter_mut().zip(fourth.iter()) {
            let size = fourth.abs() * S::nearest(0.25);
            *found = if size > *found { size } else { *found };
        }
    }
    add(sums, S::one(), found);
}

#[cfg(test)]
mod tests {
    use super::super::equations::Values;
    use super::*;

    #[test]
    fn the_worst_residual_is_taken_in_units_of_its_own_floor() {
        let (residual, floor) = ([1e9, -3e-9], [1e9, 1e-9]);
        assert_eq!(worst(&residual, &floor), (3e-9, 1e-9));
        assert_eq!(in_units_of(&residual, &floor), 3.0);
    }

    #[test]
    fn a_residual_that_is_no_number_has_no_size() {
        assert!(in_units_of(&[1.0, f64::NAN, 2.0], &[1.0, 1.0, 1.0]).is_nan());
        assert_eq!(in_units_of(&[f64::INFINITY], &[1.0]), f64::INFINITY);
        assert_eq!(in_units_of(&[0.0], &[0.0]), 0.0);
    }

    #[test]
    fn a_floor_as_large_as_the_terms_decides_nothing() {
        assert!(is_sensible(&[1e-3, 0.0], &[1.1, 0.0]));
        assert!(!is_sensible(&[1e-3, 0.0], &[0.9, 0.0]));
        assert!(!is_sensible(&[f64::INFINITY], &[1.0]));
        assert!(!is_sensible(&[f64::NAN], &[1.0]));
    }

    /// The rounding of p0 at (q, v), and how far it scatters for this h.
    fn measured<const N: usize>(
        p0: impl Fn(&[f64], &[f64], &mut [f64]),
        q: [f64; N],
        v: [f64; N],
        h: f64,
    ) -> [[f64; N]; 2] {
        let mut values = Values { momentum: p0, kernel: |_: &[f64], _: &[f64], _: &mut [f64]| {} };
        let of = Equations { evaluate: &mut values, q: &q, p: &[0.0; N], h, held: &[0.0; N] };
        let [mut rounding, mut scatter] = [[0.0; N]; 2];
        add_rounding(&of, &v, &mut rounding, Room::new(&mut [0.0; 40], N));
        add_scatter(&of, &v, &mut scatter, Room::new(&mut [0.0; 40], N));
        [rounding, scatter]
    }

    #[test]
    fn the_rounding_of_cancelling_forces_is_measured() {
        let value = |q: &[f64], v: &[f64], p0: &mut [f64]| p0[0] = v[0] + 1e3 * (q[0] - 0.7);
        // The last place of 0.7 is ε/2; q moves by one or two of them either way.
        let [[found], _] = measured(value, [0.7], [0.0], 1.0);
        assert!((1e3 * f64::EPSILON..=2e3 * f64::EPSILON).contains(&found), "{found:e}");
        // Positive control: nothing cancels at q = 0.
        assert_eq!(measured(value, [0.0], [0.0], 1.0)[0], [0.0]);
    }

    /// p0 = v + (f(q1) − f(q0))/2: what q does cancels, its rounding does not.
    #[test]
    fn configurations_are_rounded_each_on_its_own() {
        let h = 0.05;
        for q in [8474.05867, 2.7e4, -6.1e5, 3.3e7] {
            for slope in [1.0, -40.0] {
                let value = |q: &[f64], v: &[f64], p0: &mut [f64]| {
                    p0[0] = v[0] + slope * ((q[0] + h * v[0]) - q[0]);
                };
                let [[moved], [found]] = measured(value, [q], [3.7162], h);
                // q1 is off by half a last place at most.
                let place = f64::EPSILON * 2.0_f64.powf(q.abs().log2().floor());
                let off = 0.5 * f64::abs(slope) * place;
                assert!(found >= off && found <= 8.0 * off, "{q} {slope}: {found:e} {off:e}");
                assert!(moved < 0.1 * off, "{moved:e} {off:e}");
            }
        }
    }

    /// The control: what is smooth does not scatter, however steep and curved it is; nor does anything
    /// without a place to move to.
    #[test]
    fn what_is_smooth_does_not_scatter() {
        let (q, v) = ([8474.05867, 1e9], [3.7162, -4e-3]);
        let value = |_: &[f64], v: &[f64], p0: &mut [f64]| {
            p0.copy_from_slice(&[1e6 * v[0].powi(3) + v[1].exp(), 1.0 / v[1]]);
        };
        let mut terms = [0.0; 2];
        value(&q, &v, &mut terms);
        terms[0] += 1.0;
        let [_, found] = measured(value, q, v, 0.05);
        assert!((0..2).all(|i| found[i] <= 16.0 * f64::EPSILON * terms[i].abs()), "{found:?} {terms:?}");
        for h in [0.0, f64::MIN_POSITIVE] {
            assert_eq!(measured(value, q, v, h)[1], [0.0; 2]);
        }
    }
}
