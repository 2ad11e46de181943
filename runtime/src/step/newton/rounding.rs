//! When a step is solved: the one definition, for every rule, memory and solver.
//!
//! **Definition.** A step is solved where each component of the residual of its equation is at most
//! [`AT_FLOOR`] times its round-off floor, and this floor
//!
//! 1. belongs to the solution that is returned, not to an iterate on the way: where the last correction was
//!    not small beside v̄ ([`SMALL`]), the matrix is evaluated again at the solution;
//! 2. is finite;
//! 3. where the residual had stopped falling, or Newton steps had to be shortened: is at most [`SENSIBLE`] of
//!    the terms that the equation is made of. Otherwise rounding would explain any residual.
//!
//! Then the solution satisfies exactly the equation with q, v̄ and p changed by some units of their last
//! places. Each component has a floor of its own,
//!
//! ```text
//! floorᵢ = 4ε (|pᵢ| + Σⱼ |Jᵢⱼ||vⱼ|)                          one-stage rules, J = ∂p0/∂v̄
//! floorᵢ = 4ε (|pᵢ| + |h| max |Gᵢ| + max Σⱼ |Mᵢⱼ||Vⱼ|)        Gauss rules, the largest of all stages
//! ```
//!
//! so that neither the unit of a coordinate nor its neighbours' size matters. These estimates know nothing of
//! what q contributes: near an equilibrium away from q = 0 large forces cancel, and v and p go to 0 while the
//! rounding of those forces stays. Where the residual stops falling above the estimate, its rounding is
//! therefore measured: by what the last places of q and v change ([`rounding`]), and, where that does not
//! explain it, by how it scatters ([`scatter`]). The latter sees each configuration on the way rounded on its
//! own: far from q = 0, say after 10³ turns of an angle, q0 and q1 are known to ε|q|, and where what their
//! errors do cancels if both are moved together, as under the trapezoidal rule, moving q shows nothing of it.
//!
//! Where forces cancel at q = 0, as (q − 1) + (q + 1) do, no place of q shows their rounding. Derivatives that
//! are written out come with the sizes of such terms ([`cancelling_terms`](crate::Discrete::cancelling_terms)),
//! which count before anything is measured: ε times them is floor, and they are terms of the equation.
//!
//! `tests/examples/verdicts` holds every rule against this definition in twice the precision.

use nalgebra::SVector;

use crate::numbers::{NewtonMatrix, Scalar};

/// A residual of at most this many floors, estimated or measured, is that of a root.
pub(crate) const AT_FLOOR: f64 = 4.0;

/// A contraction above this is not that of Newton's method: rounding slows it, or the root is far.
pub(crate) const SLOW: f64 = 0.25;

/// A correction of at most this share of v̄ leads to a point where the floor is that of the point before.
pub(crate) const SMALL: f64 = 1.0 / 16.0;

/// A floor above this share of the terms of the equation says that rounding decides it.
pub(crate) const SENSIBLE: f64 = 1.0 / 1024.0;

/// Whether every floor is at most [`SENSIBLE`] of the `terms` of its equation.
#[cold]
pub(crate) fn is_sensible<S: Scalar, const N: usize>(floor: &SVector<S, N>, terms: &SVector<S, N>) -> bool {
    (0..N).all(|i| floor[i] <= terms[i] * S::constant(SENSIBLE) + S::SMALLEST_NORMAL * S::constant(4.0))
}

/// The absolute values of `terms`, with 0 where a term is not finite.
#[cold]
pub(crate) fn finite_part<S: Scalar, const N: usize>(terms: &SVector<S, N>) -> SVector<S, N> {
    terms.map(|term| if term.is_finite() { term.abs() } else { S::zero() })
}

/// The floor that the terms of p0 give, 4ε (|pᵢ| + Σⱼ |Jᵢⱼ||vⱼ|).
#[inline]
pub(crate) fn estimated_floor<S: Scalar, const N: usize>(
    p: &SVector<S, N>,
    matrix: &impl NewtonMatrix<S, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    // Scaled before they are added up, so that only what overflows itself does.
    let unit = S::EPSILON * S::constant(4.0);
    let mut floor = matrix.magnitudes(&(v * unit));
    for i in 0..N {
        // Below the normal numbers ε no longer bounds the rounding.
        floor[i] += p[i].abs() * unit + S::SMALLEST_NORMAL;
    }
    floor
}

/// max |residualᵢ|/floorᵢ. An exact 0 counts 0, whatever its floor; a NaN or infinite ratio is returned as it
/// is.
#[inline]
pub(super) fn in_units_of<S: Scalar, const N: usize>(residual: &SVector<S, N>, floor: &SVector<S, N>) -> S {
    let mut largest = S::zero();
    for i in 0..N {
        if residual[i] != S::zero() {
            let units = residual[i].abs() / floor[i];
            if !units.is_finite() {
                return units;
            }
            largest = largest.max(units);
        }
    }
    largest
}

/// The residual that is largest in units of its floor, this floor, and whether it is a root's: at most
/// [`AT_FLOOR`] of them.
#[inline]
pub(crate) fn held_against<S: Scalar, const N: usize>(
    residual: &SVector<S, N>,
    floor: &SVector<S, N>,
) -> (S, S, bool) {
    const LANES: usize = 4;
    // One of the residuals from the start: products with one that is tiny, or with a floor that overflows,
    // decide nothing.
    let first = (residual[0].abs(), floor[0], true);
    if N < 2 * LANES {
        return of_slices(residual.as_slice(), floor.as_slice(), first);
    }
    // Lane by lane, so that few comparisons wait for one another.
    let mut worst = [first; LANES];
    let (residuals, other_residuals) = residual.as_slice().as_chunks::<LANES>();
    let (floors, other_floors) = floor.as_slice().as_chunks::<LANES>();
    for (residuals, floors) in residuals.iter().zip(floors) {
        for lane in 0..LANES {
            worst[lane] = held(residuals[lane], floors[lane], worst[lane]);
        }
    }
    let [a, b, c, d] = worst;
    let rest = of_slices(other_residuals, other_floors, a);
    let larger = |a: (S, S, bool), b: (S, S, bool)| {
        let (size, floor) = if b.0 * a.1 > a.0 * b.1 { (b.0, b.1) } else { (a.0, a.1) };
        (size, floor, a.2 & b.2)
    };
    larger(larger(rest, b), larger(c, d))
}

/// The larger of the `worst` so far and of the residual, whose floor this is; and whether it is still that of
/// a root.
#[inline(always)]
fn held<S: Scalar>(residual: S, floor: S, worst: (S, S, bool)) -> (S, S, bool) {
    let (size, most) = (residual.abs(), floor * S::constant(AT_FLOOR));
    // A floor that overflows explains nothing.
    let is_root = worst.2 & (size <= most) & most.is_finite();
    if size * worst.1 > worst.0 * floor { (size, floor, is_root) } else { (worst.0, worst.1, is_root) }
}

/// The residual and floor of [`held_against`] at a root, in a third of its operations, where the `size`,
/// [`weighted`](super::weighted) by `weights` = 1/`floor`, is known; `None` where it is no root, or where the
/// rounding of the weights would decide. No floor may overflow.
#[inline]
pub(crate) fn held_by_weights<S: Scalar, const N: usize>(
    residual: &SVector<S, N>,
    floor: &SVector<S, N>,
    weights: &SVector<S, N>,
    size: S,
) -> Option<(S, S)> {
    // Weight and product are rounded once each.
    let is_below = size <= S::constant(AT_FLOOR) * (S::one() - S::EPSILON * S::constant(2.0));
    if !is_below {
        return None;
    }
    let worst = (0..N).find(|&i| residual[i].abs() * weights[i] == size)?;
    Some((residual[worst].abs(), floor[worst]))
}

/// One after the other.
#[inline(always)]
fn of_slices<S: Scalar>(residuals: &[S], floors: &[S], mut worst: (S, S, bool)) -> (S, S, bool) {
    for (&residual, &floor) in residuals.iter().zip(floors) {
        worst = held(residual, floor, worst);
    }
    worst
}

/// The residual that is largest in units of its floor, and this floor.
#[inline]
pub(super) fn worst<S: Scalar, const N: usize>(residual: &SVector<S, N>, floor: &SVector<S, N>) -> (S, S) {
    let mut worst = (residual[0].abs(), floor[0]);
    for i in 1..N {
        let other = (residual[i].abs(), floor[i]);
        if other.0 / other.1 > worst.0 / worst.1 {
            worst = other;
        }
    }
    worst
}

/// Last places that rounding is measured over: functions on the way, such as the root in a length, may
/// swallow a single one.
pub(crate) const PLACES: f64 = 8.0;

/// The rounding of p0: its changes when each entry of q and of v moves by its last place, added up.
#[cold]
pub(super) fn rounding<S: Scalar, const N: usize>(
    p0: impl Fn(&SVector<S, N>, &SVector<S, N>) -> SVector<S, N>,
    q: &SVector<S, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    let value = p0(q, v);
    let mut sum: SVector<S, N> = nalgebra::zero();
    let mut add = |q: &SVector<S, N>, v: &SVector<S, N>| sum += (p0(q, v) - value).abs();
    let places = S::constant(PLACES);
    for factor in [S::one() + S::EPSILON * places, S::one() - S::EPSILON * places] {
        for i in 0..N {
            let mut moved = *q;
            moved[i] *= factor;
            add(&moved, v);
            let mut moved = *v;
            moved[i] *= factor;
            add(q, &moved);
        }
    }
    sum / places
}

/// The most that [`scatter`] moves a velocity, as a share of it: what is left of a smooth function's fourth
/// differences is below ε.
const NEXT_TO: f64 = 1.0 / (1 << 24) as f64;

/// How far p0 scatters about a smooth function of v where h v moves by a few last places of q: its fourth
/// differences, which hold up to 16 times the rounding of p0 and a quarter of them mostly at least that.
#[cold]
pub(super) fn scatter<S: Scalar, const N: usize>(
    p0: impl Fn(&SVector<S, N>) -> SVector<S, N>,
    q: &SVector<S, N>,
    v: &SVector<S, N>,
    h: S,
) -> SVector<S, N> {
    let mut largest: SVector<S, N> = nalgebra::zero();
    let most = v.amax() * S::constant(NEXT_TO);
    for k in 1..=8 {
        // Shares of a place that no two coordinates and no two moves have in common.
        let change = SVector::<S, N>::from_fn(|i, _| {
            let place = S::EPSILON * q[i].abs() / h.abs();
            let share = S::constant(0.37 * f64::from(k) + 0.173 * i as f64);
            if place * share < most { place * share } else { S::zero() }
        });
        let at = |places: f64| p0(&(v + change * S::constant(places)));
        let sides = [1.0, 2.0].map(|places| at(places) + at(-places));
        let fourth = sides[1] - sides[0] * S::constant(4.0) + at(0.0) * S::constant(6.0);
        largest = largest.sup(&(fourth.abs() * S::constant(0.25)));
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{matrix, vector};

    #[test]
    fn the_worst_residual_is_taken_in_units_of_its_own_floor() {
        let (residual, floor) = (vector![1e9, -3e-9], vector![1e9, 1e-9]);
        assert_eq!(worst(&residual, &floor), (3e-9, 1e-9));
        assert_eq!(in_units_of(&residual, &floor), 3.0);
    }

    #[test]
    fn a_residual_that_is_no_number_has_no_size() {
        assert!(in_units_of(&vector![1.0, f64::NAN, 2.0], &vector![1.0, 1.0, 1.0]).is_nan());
        assert_eq!(in_units_of(&vector![f64::INFINITY], &vector![1.0]), f64::INFINITY);
        assert_eq!(in_units_of(&vector![0.0], &vector![0.0]), 0.0);
    }

    #[test]
    fn floors_neither_vanish_nor_overflow() {
        let floor = |p: f64| estimated_floor(&vector![p], &matrix![1.0], &vector![p])[0];
        assert_eq!(floor(1.0), 8.0 * f64::EPSILON + f64::MIN_POSITIVE);
        assert!(floor(1e308) < 1e294 && floor(1e-320) == f64::MIN_POSITIVE);
    }

    #[test]
    fn a_residual_that_overflows_is_no_root() {
        let overflowed = vector![0.0, f64::INFINITY];
        assert!(!held_against(&overflowed, &vector![1.0, f64::INFINITY]).2);
        // Beside a finite floor that is larger, a large residual is that of a root.
        assert!(held_against(&vector![0.0, 1e300], &vector![1.0, 1e300]).2);
    }

    #[test]
    fn a_floor_that_overflows_explains_no_residual() {
        for residual in [0.0, 1.0, 1e300] {
            assert!(!held_against(&vector![0.0, residual], &vector![1.0, f64::INFINITY]).2);
            assert!(!held_against(&vector![0.0, residual], &vector![1.0, f64::NAN]).2);
        }
        let nine = SVector::<f64, 9>::from_fn(|i, _| if i == 6 { f64::INFINITY } else { 1.0 });
        assert!(!held_against(&SVector::<f64, 9>::repeat(1e-3), &nine).2);
    }

    /// By its weight as by its floor: what one calls a root, the other does, but for the last places of a
    /// residual of four floors.
    #[test]
    fn weights_say_of_a_residual_what_floors_do() {
        let by_weights = |residual: [f64; 5], floor: [f64; 5]| {
            let (residual, floor) = (SVector::from(residual), SVector::from(floor));
            let weights = floor.map(|floor: f64| 1.0 / floor);
            let (worst, of, is_root) = held_against(&residual, &floor);
            let size = crate::step::newton::weighted(&residual, &weights);
            let found = held_by_weights(&residual, &floor, &weights, size);
            assert!(found.is_none() || is_root);
            assert!(found.is_none_or(|found| found == (worst, of)));
            (found.is_some(), is_root)
        };
        let floor = [0.1, 0.7, 3.0, 1e-9, 1e200];
        for i in 0..5 {
            for (floors, expected) in [(3.999, true), (4.0 - 1e-14, true), (4.0 + 1e-14, false), (1e3, false)]
            {
                let mut residual = floor.map(|floor| -floor);
                residual[i] = floors * floor[i];
                assert_eq!(by_weights(residual, floor), (expected, expected), "{i}, {floors}");
            }
            let mut residual = [0.0; 5];
            residual[i] = f64::NAN;
            assert_eq!(by_weights(residual, floor), (false, false));
        }
    }

    #[test]
    fn a_floor_as_large_as_the_terms_decides_nothing() {
        assert!(is_sensible(&vector![1e-3, 0.0], &vector![1.1, 0.0]));
        assert!(!is_sensible(&vector![1e-3, 0.0], &vector![0.9, 0.0]));
        assert!(!is_sensible(&vector![f64::INFINITY], &vector![1.0]));
        assert!(!is_sensible(&vector![f64::NAN], &vector![1.0]));
    }

    #[test]
    fn the_residual_told_is_one_of_them() {
        // Products underflow, or are no numbers.
        assert_eq!(
            held_against(&vector![-1e-309], &vector![f64::MIN_POSITIVE]),
            (1e-309, f64::MIN_POSITIVE, true)
        );
        assert_eq!(held_against(&vector![1e284], &vector![f64::INFINITY]), (1e284, f64::INFINITY, false));
        let nine = SVector::<f64, 9>::from_fn(|i, _| if i == 6 { 3.0 } else { 1e-320 });
        assert_eq!(held_against(&nine, &SVector::repeat(1.0)), (3.0, 1.0, true));
    }

    #[test]
    fn the_rounding_of_cancelling_forces_is_measured() {
        let value = |q: &SVector<f64, 1>, v: &SVector<f64, 1>| vector![v[0] + 1e3 * (q[0] - 0.7)];
        // The last place of 0.7 is ε/2; q moves by one or two of them either way.
        let measured = rounding(value, &vector![0.7], &vector![0.0])[0];
        assert!((1e3 * f64::EPSILON..=2e3 * f64::EPSILON).contains(&measured), "{measured:e}");
        // Positive control: nothing cancels at q = 0.
        assert_eq!(rounding(value, &vector![0.0], &vector![0.0])[0], 0.0);
    }

    /// p0 = v + (f(q1) − f(q0))/2: what q does cancels, its rounding does not.
    #[test]
    fn configurations_are_rounded_each_on_its_own() {
        let h = 0.05;
        for q in [8474.05867, 2.7e4, -6.1e5, 3.3e7] {
            for slope in [1.0, -40.0] {
                let value = |q: &SVector<f64, 1>, v: &SVector<f64, 1>| {
                    vector![v[0] + slope * ((q[0] + h * v[0]) - q[0])]
                };
                let (q, v) = (vector![q], vector![3.7162]);
                let moved = rounding(value, &q, &v)[0];
                let found = scatter(|v| value(&q, v), &q, &v, h)[0];
                // q1 is off by half a last place at most.
                let place = f64::EPSILON * 2.0_f64.powf(q[0].abs().log2().floor());
                let off = 0.5 * slope.abs() * place;
                assert!(found >= off && found <= 8.0 * off, "{q} {slope}: {found:e} {off:e}");
                assert!(moved < 0.1 * off, "{moved:e} {off:e}");
            }
        }
    }

    /// The control: what is smooth does not scatter, however steep and curved it is; nor does anything
    /// without a place to move to.
    #[test]
    fn what_is_smooth_does_not_scatter() {
        let (q, v) = (vector![8474.05867, 1e9], vector![3.7162, -4e-3]);
        let value = |v: &SVector<f64, 2>| vector![1e6 * v[0].powi(3) + v[1].exp(), 1.0 / v[1]];
        let terms = value(&v).abs() + vector![1.0, 0.0];
        let found = scatter(value, &q, &v, 0.05);
        assert!((0..2).all(|i| found[i] <= 16.0 * f64::EPSILON * terms[i]), "{found:e} {terms:e}");
        for h in [0.0, f64::MIN_POSITIVE] {
            assert_eq!(scatter(value, &q, &v, h).amax(), 0.0);
        }
    }
}
