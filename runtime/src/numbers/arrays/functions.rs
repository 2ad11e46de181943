//! Sine, cosine and exponential of several numbers at once.
//!
//! Branch-free, so that they run in vector instructions: reduction by three parts of π/2
//! or two of ln 2 and the polynomials of fdlibm (Sun Microsystems, 1993; `k_sin.c`, `k_cos.c`, `e_exp.c`),
//! within 1.5 units in the last place. Arguments beyond their range go one by one through the functions of
//! numbers. So every lane has the bits that it has alone, whatever stands beside it and however many.

/// Functions that have a branch-free form.
pub trait Functions: Sized {
    /// Sine and cosine of every lane.
    fn sines_and_cosines<const S: usize>(x: [Self; S]) -> ([Self; S], [Self; S]);

    /// The exponential of every lane.
    fn exponentials<const S: usize>(x: [Self; S]) -> [Self; S];

    /// Sine and cosine of every lane from an angle near by, its sine and its cosine, the `anchor`; lanes that
    /// are not near become anchors themselves.
    fn turned<const S: usize, const FUSED: bool>(
        x: [Self; S],
        angle: &mut [Self; S],
        sine: &mut [Self; S],
        cosine: &mut [Self; S],
    ) -> ([Self; S], [Self; S]);

    /// 1/x of every lane by a step of Newton's method from reciprocals near by, by a division elsewhere.
    fn corrected_reciprocals<const S: usize, const FUSED: bool>(x: [Self; S], near: [Self; S]) -> [Self; S];
}

/// Up to here multiples of π/2 times the 33 bits of its first part are exact.
const LARGEST_ANGLE: f64 = 1e6;

/// 1.5 · 2⁵²: adding it leaves the nearest integer in the last bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Sine and cosine for |x| ≤ [`LARGEST_ANGLE`].
#[cfg_attr(not(debug_assertions), inline(always))]
#[expect(clippy::excessive_precision, reason = "as fdlibm prints them")]
fn sine_and_cosine(x: f64) -> (f64, f64) {
    const FIRST: f64 = 1.57079632673412561417e+00;
    const SECOND: f64 = 6.07710050630396597660e-11;
    const THIRD: f64 = 2.02226624879595063154e-21;
    let rounded = x * core::f64::consts::FRAC_2_PI + ROUNDER;
    let quadrant = rounded.to_bits();
    let k = rounded - ROUNDER;
    // x − kπ/2 = r + rest.
    let t = x - k * FIRST;
    let w = k * SECOND;
    let u = t - w;
    let w = k * THIRD - ((t - u) - w);
    let r = u - w;
    let rest = (u - r) - w;

    let z = r * r;
    let p = 8.33333333332248946124e-03
        + z * (-1.98412698298579493134e-04
            + z * (2.75573137070700676789e-06
                + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    let cube = z * r;
    let sine = r - ((z * (0.5 * rest - cube * p) - rest) - cube * -1.66666666666666324348e-01);
    let p = z
        * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05))
        + (z * z)
            * (z * z)
            * (-2.75573143513906633035e-07
                + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
    let half = 0.5 * z;
    let lead = 1.0 - half;
    let cosine = lead + (((1.0 - lead) - half) + (z * p - r * rest));

    let is_odd = quadrant & 1 == 1;
    let (a, b) = if is_odd { (cosine, sine) } else { (sine, cosine) };
    let sine = f64::from_bits(a.to_bits() ^ ((quadrant & 2) << 62));
    let cosine = f64::from_bits(b.to_bits() ^ ((quadrant.wrapping_add(1) & 2) << 62));
    (sine, cosine)
}

/// Up to this angle the addition theorem is used.
const LARGEST_TURN: f64 = 0.1875;

/// a b + c, rounded once where that is asked for and where the target of the build has an instruction for it.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn product_plus<T: nalgebra::RealField>(is_fused: bool, a: T, b: T, c: T) -> T {
    if is_fused || cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// sin δ and 1 − cos δ for |δ| ≤ [`LARGEST_TURN`]: interpolated at Chebyshev's nodes of δ², 0.05 ε off.
#[cfg_attr(not(debug_assertions), inline(always))]
fn sine_and_versine<const FUSED: bool>(delta: f64) -> (f64, f64) {
    let z = delta * delta;
    let p = product_plus(FUSED, -z, 2.7539709917498416e-06, 0.00019841265972408056);
    let p = product_plus(FUSED, -z, p, 0.008333333333061315);
    let p = product_plus(FUSED, -z, p, 0.16666666666666638);
    let sine = product_plus(FUSED, -delta, z * p, delta);
    let p = product_plus(FUSED, -z, 2.754264415234022e-07, 2.4801584077348975e-05);
    let p = product_plus(FUSED, -z, p, 0.0013888888888662191);
    let p = product_plus(FUSED, -z, p, 0.041666666666666644);
    (sine, z * product_plus(FUSED, -z, p, 0.5))
}

/// Sine and cosine of angles δ away from those of `sine` and `cosine`, each within [`LARGEST_TURN`].
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]
fn by_addition<const S: usize, const FUSED: bool>(
    delta: &[f64; S],
    sine: &[f64; S],
    cosine: &[f64; S],
) -> ([f64; S], [f64; S]) {
    let (mut sines, mut cosines) = (*sine, *cosine);
    for i in 0..S {
        let (turn, versine) = sine_and_versine::<FUSED>(delta[i]);
        let (s, c) = (sine[i], cosine[i]);
        sines[i] = s + product_plus(FUSED, c, turn, -(s * versine));
        cosines[i] = c - product_plus(FUSED, s, turn, c * versine);
    }
    (sines, cosines)
}

/// Beyond this 1 − x r the reciprocal of x is no step of Newton's method from r.
const LARGEST_DEFECT: f64 = 0.0625;

/// Up to here neither the result nor a factor of it leaves the normal numbers.
const LARGEST_EXPONENT: f64 = 700.0;

/// eˣ for |x| ≤ [`LARGEST_EXPONENT`].
#[cfg_attr(not(debug_assertions), inline(always))]
#[expect(clippy::excessive_precision, reason = "as fdlibm prints them")]
fn exponential(x: f64) -> f64 {
    const HIGH: f64 = 6.93147180369123816490e-01;
    const LOW: f64 = 1.90821492927058770002e-10;
    let rounded = x * core::f64::consts::LOG2_E + ROUNDER;
    let k = rounded - ROUNDER;
    let (high, low) = (x - k * HIGH, k * LOW);
    let r = high - low;
    let z = r * r;
    let c = r - z
        * (1.66666666666666019037e-01
            + z * (-2.77777777770155933842e-03
                + z * (6.61375632143793436117e-05
                    + z * (-1.65339022054652515390e-06 + z * 4.13813679705723846039e-08))));
    let mantissa = 1.0 + ((r * c / (2.0 - c) - low) + high);
    // k stands in the last bits of `rounded`; it moves the exponent.
    f64::from_bits(mantissa.to_bits().wrapping_add(rounded.to_bits() << 52))
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn all_within<const S: usize>(x: &[f64; S], limit: f64) -> bool {
    let mut within = true;
    for lane in x {
        within &= lane.abs() <= limit;
    }
    within
}

/// Whether a lane is larger than the limit; none that is NaN.
#[cfg_attr(not(debug_assertions), inline(always))]
fn some_above<const S: usize>(x: &[f64; S], limit: f64) -> bool {
    let mut is_above = false;
    for lane in x {
        is_above |= lane.abs() > limit;
    }
    is_above
}

/// Whether every lane is larger than the limit.
#[cfg_attr(not(debug_assertions), inline(always))]
fn all_above<const S: usize>(x: &[f64; S], limit: f64) -> bool {
    let mut are_above = true;
    for lane in x {
        are_above &= lane.abs() > limit;
    }
    are_above
}

/// Sine and cosine of a number, those of [`Elementary`](crate::numbers::Elementary), which stands on this
/// module: the platform's, or libm's where there is no platform or every machine is to compute the same.
fn of_any_angle(x: f64) -> (f64, f64) {
    if cfg!(all(feature = "std", not(feature = "libm"))) {
        nalgebra::ComplexField::sin_cos(x)
    } else {
        libm::sincos(x)
    }
}

/// The exponential of a number, likewise.
fn of_any_exponent(x: f64) -> f64 {
    if cfg!(all(feature = "std", not(feature = "libm"))) {
        nalgebra::ComplexField::exp(x)
    } else {
        libm::exp(x)
    }
}

/// Puts the functions of numbers where the angle is out of range.
#[cold]
#[inline(never)]
fn beyond_largest_angle<const S: usize>(x: &[f64; S], values: &mut [[f64; S]; 2]) {
    let [sines, cosines] = values;
    for ((x, sine), cosine) in x.iter().zip(sines).zip(cosines) {
        let is_within = x.abs() <= LARGEST_ANGLE;
        if !is_within {
            (*sine, *cosine) = of_any_angle(*x);
        }
    }
}

/// Puts the functions of numbers where the exponent is out of range.
#[cold]
#[inline(never)]
fn beyond_largest_exponent<const S: usize>(x: &[f64; S], values: &mut [f64; S]) {
    for (x, value) in x.iter().zip(values) {
        let is_within = x.abs() <= LARGEST_EXPONENT;
        if !is_within {
            *value = of_any_exponent(*x);
        }
    }
}

#[allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]
impl Functions for f64 {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sines_and_cosines<const S: usize>(x: [Self; S]) -> ([Self; S], [Self; S]) {
        let (mut sines, mut cosines) = (x, x);
        for i in 0..S {
            (sines[i], cosines[i]) = sine_and_cosine(x[i]);
        }
        if !all_within(&x, LARGEST_ANGLE) {
            // Copies: what a call is given the address of would be kept in memory.
            let (x, mut values) = (x, [sines, cosines]);
            beyond_largest_angle(&x, &mut values);
            [sines, cosines] = values;
        }
        (sines, cosines)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn exponentials<const S: usize>(x: [Self; S]) -> [Self; S] {
        let mut exponentials = x;
        for i in 0..S {
            exponentials[i] = exponential(x[i]);
        }
        if !all_within(&x, LARGEST_EXPONENT) {
            let (x, mut values) = (x, exponentials);
            beyond_largest_exponent(&x, &mut values);
            exponentials = values;
        }
        exponentials
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn turned<const S: usize, const FUSED: bool>(
        x: [Self; S],
        angle: &mut [Self; S],
        sine: &mut [Self; S],
        cosine: &mut [Self; S],
    ) -> ([Self; S], [Self; S]) {
        let mut delta = x;
        for i in 0..S {
            delta[i] = x[i] - angle[i];
        }
        if !some_above(&delta, LARGEST_TURN) {
            return by_addition::<S, FUSED>(&delta, sine, cosine);
        }
        let (mut sines, mut cosines) = Self::sines_and_cosines(x);
        if all_above(&delta, LARGEST_TURN) {
            (*angle, *sine, *cosine) = (x, sines, cosines);
            return (sines, cosines);
        }
        let (near_sines, near_cosines) = by_addition::<S, FUSED>(&delta, sine, cosine);
        for i in 0..S {
            let is_far = delta[i].abs() > LARGEST_TURN;
            let chosen = |far: f64, near: f64| if is_far { far } else { near };
            angle[i] = chosen(x[i], angle[i]);
            sine[i] = chosen(sines[i], sine[i]);
            cosine[i] = chosen(cosines[i], cosine[i]);
            sines[i] = chosen(sines[i], near_sines[i]);
            cosines[i] = chosen(cosines[i], near_cosines[i]);
        }
        (sines, cosines)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn corrected_reciprocals<const S: usize, const FUSED: bool>(x: [Self; S], near: [Self; S]) -> [Self; S] {
        let (mut reciprocals, mut defect) = (near, x);
        for i in 0..S {
            defect[i] = product_plus(FUSED, -x[i], near[i], 1.0);
            reciprocals[i] = product_plus(FUSED, near[i], defect[i], near[i]);
        }
        if some_above(&defect, LARGEST_DEFECT) {
            let mut exact = x;
            for i in 0..S {
                exact[i] = 1.0 / x[i];
            }
            for i in 0..S {
                let is_far = defect[i].abs() > LARGEST_DEFECT;
                reciprocals[i] = if is_far { exact[i] } else { reciprocals[i] };
            }
        }
        reciprocals
    }
}

impl Functions for f32 {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sines_and_cosines<const S: usize>(x: [Self; S]) -> ([Self; S], [Self; S]) {
        let (sines, cosines) = f64::sines_and_cosines(x.map(f64::from));
        (sines.map(|lane| lane as f32), cosines.map(|lane| lane as f32))
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn exponentials<const S: usize>(x: [Self; S]) -> [Self; S] {
        f64::exponentials(x.map(f64::from)).map(|lane| lane as f32)
    }

    /// As many digits as an anchor would have to hold a number of this type has not.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn turned<const S: usize, const FUSED: bool>(
        x: [Self; S],
        _angle: &mut [Self; S],
        _sine: &mut [Self; S],
        _cosine: &mut [Self; S],
    ) -> ([Self; S], [Self; S]) {
        Self::sines_and_cosines(x)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn corrected_reciprocals<const S: usize, const FUSED: bool>(x: [Self; S], _near: [Self; S]) -> [Self; S] {
        x.map(|x| 1.0 / x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::Elementary;

    /// Difference in units in the last place of the reference.
    fn units(value: f64, reference: f64) -> f64 {
        let last_place = (reference.abs().to_bits() + 1) as i64 - reference.abs().to_bits() as i64;
        assert_eq!(last_place, 1);
        let spacing = f64::from_bits(reference.abs().to_bits() + 1) - reference.abs();
        (value - reference).abs() / spacing
    }

    /// A spread of arguments of every size, both signs, and neighbours of the multiples of π/4.
    fn arguments(limit: f64) -> impl Iterator<Item = f64> {
        let spread = (1..200_000).map(move |k| {
            let k = f64::from(k);
            limit * (k * 0.618_033_988_749_894_9).fract().powi(3) * if k % 2.0 == 0.0 { 1.0 } else { -1.0 }
        });
        let corners = (0..20_000).flat_map(move |k| {
            let x = f64::from(k) * core::f64::consts::FRAC_PI_4;
            [x, f64::from_bits(x.to_bits() + 1), -x, x * (1.0 + 1e-9)]
        });
        spread.chain(corners.filter(move |x| x.abs() <= limit))
    }

    #[test]
    fn sine_and_cosine_are_those_of_the_standard_library() {
        let mut worst = [0.0_f64; 2];
        for limit in [1.0, 10.0, 1e3, 1e6] {
            for x in arguments(limit) {
                let (sine, cosine) = sine_and_cosine(x);
                worst = [worst[0].max(units(sine, x.sin())), worst[1].max(units(cosine, x.cos()))];
            }
        }
        // The library's own error is up to ½ unit; 1.5 asks for ours within 1.
        assert!(worst[0] <= 1.5 && worst[1] <= 1.5, "{worst:?}");
        // Positive control: one part of π/2 less is seen.
        let x = 355.0_f64;
        let k = (x * core::f64::consts::FRAC_2_PI).round();
        assert!(units((x - k * core::f64::consts::FRAC_PI_2).sin().abs(), x.sin().abs()) > 1e6);
    }

    /// Neither neighbours nor their number change a bit; out of range it is the function of numbers.
    #[test]
    fn lanes_are_what_they_are_alone() {
        let all = [0.3, 1e9, -2.0, f64::INFINITY, f64::NAN, 800.0, -0.0, 1e6];
        let (sines, cosines) = f64::sines_and_cosines(all);
        let exponentials = f64::exponentials(all);
        for (i, &x) in all.iter().enumerate() {
            let ([sine], [cosine]) = f64::sines_and_cosines([x]);
            let [exponential] = f64::exponentials([x]);
            let bits = |of: [f64; 3]| of.map(|x| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() });
            let alone = bits([sine, cosine, exponential]);
            assert_eq!(bits([sines[i], cosines[i], exponentials[i]]), alone, "{x}");
            let of_number = bits([Elementary::sin(x), Elementary::cos(x), Elementary::exp(x)]);
            assert!(x.abs() <= LARGEST_ANGLE || alone[..2] == of_number[..2]);
            assert!(x.abs() <= LARGEST_EXPONENT || alone[2] == of_number[2]);
        }
        // The control: in range it is another function, in the last place.
        let mut angles = arguments(1e3);
        assert!(angles.any(|x| sine_and_cosine(x).0 != x.sin()));
    }

    #[test]
    fn the_exponential_is_that_of_the_standard_library() {
        let mut worst = 0.0_f64;
        for limit in [1e-3, 1.0, 30.0, 700.0] {
            for x in arguments(limit) {
                worst = worst.max(units(exponential(x), x.exp()));
            }
        }
        assert!(worst <= 1.5, "{worst}");
    }
}
