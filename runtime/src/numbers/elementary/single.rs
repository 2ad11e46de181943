//! Elementary functions of `f32` in `f32`, for processors whose `f64` is software.
//!
//! libm's sine, cosine, tangent, 2ˣ, arcsine, cube root and hypotenuse of an `f32` compute in `f64`. These
//! stay in `f32` and integers; arcosh is here for its error. Errors are below 2 units in the last place:
//! `firmware/host/src/bin/single_precision.rs` measures them over as many `f32` as one has time for, all if
//! need be, and a test below over samples. Coefficients are minimax fits of our own, rounded to `f32`, or
//! those of a series.

use core::f32::consts::FRAC_PI_4;

/// Below this, x is its own sine, tangent and so on, −0 included: x²/3 is under half a unit in the last
/// place.
const TINY: f32 = 1.0 / 4096.0;

/// π/2 − [`FRAC_PI_2`](core::f32::consts::FRAC_PI_2), rounded; that constant is twice [`FRAC_PI_4`].
const FRAC_PI_2_LOW: f32 = -4.371_139e-8;

/// The bits of 2/π behind the point, after 32 zeros.
const TWO_OVER_PI: [u32; 8] =
    [0, 0xa2f9_836e, 0x4e44_1529, 0xfc27_57d1, 0xf534_ddc0, 0xdb62_9599, 0x3c43_9041, 0xfe51_63ab];

/// Sine and cosine.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let size = x.abs();
    if size <= FRAC_PI_4 {
        return (if size < TINY { x } else { near_sin(x, 0.0) }, near_cos(x, 0.0));
    }
    let (quarter, r, low) = reduced(size);
    let (sine, cosine) = (near_sin(r, low), near_cos(r, low));
    let (sine, cosine) = if quarter % 2 == 0 { (sine, cosine) } else { (cosine, -sine) };
    let (sine, cosine) = if quarter >= 2 { (-sine, -cosine) } else { (sine, cosine) };
    (if x < 0.0 { -sine } else { sine }, cosine)
}

/// Sine.
#[inline]
pub fn sin(x: f32) -> f32 {
    let size = x.abs();
    if size <= FRAC_PI_4 {
        return if size < TINY { x } else { near_sin(x, 0.0) };
    }
    let (quarter, r, low) = reduced(size);
    let sine = if quarter % 2 == 0 { near_sin(r, low) } else { near_cos(r, low) };
    if (quarter >= 2) != (x < 0.0) { -sine } else { sine }
}

/// Cosine.
#[inline]
pub fn cos(x: f32) -> f32 {
    let size = x.abs();
    if size <= FRAC_PI_4 {
        return near_cos(x, 0.0);
    }
    let (quarter, r, low) = reduced(size);
    let cosine = if quarter % 2 == 0 { near_cos(r, low) } else { near_sin(r, low) };
    if quarter == 1 || quarter == 2 { -cosine } else { cosine }
}

/// Tangent.
#[inline]
pub fn tan(x: f32) -> f32 {
    let size = x.abs();
    if size <= FRAC_PI_4 {
        return if size < TINY { x } else { near_tan(x, 0.0) };
    }
    let (quarter, r, low) = reduced(size);
    let tangent = near_tan(r, low);
    let tangent = if quarter % 2 == 0 { tangent } else { -1.0 / tangent };
    if x < 0.0 { -tangent } else { tangent }
}

/// tan(r + low) for |r| ≤ π/4 and a low part below the last place of r.
#[inline]
#[expect(
    clippy::excessive_precision,
    reason = "a coefficient with the zero that makes its digits those of the others"
)]
fn near_tan(r: f32, low: f32) -> f32 {
    let z = r * r;
    let excess = z
        * (0.333_333_43
            + z * (0.133_327_78
                + z * (0.054_053_877 + z * (0.021_287_605 + z * (0.010_870_570 + z * z * 0.004_438_023)))));
    r + (low * (1.0 + z) + r * excess)
}

/// sin(r + low) for |r| ≤ π/4 and a low part below the last place of r.
#[inline]
fn near_sin(r: f32, low: f32) -> f32 {
    let z = r * r;
    r + (low * (1.0 - 0.5 * z) + r * z * (-0.166_666_55 + z * (0.008_332_101 - z * 0.000_195_039_3)))
}

/// cos(r + low) likewise.
#[inline]
fn near_cos(r: f32, low: f32) -> f32 {
    let z = r * r;
    let half = 0.5 * z;
    let first = 1.0 - half;
    // What the subtraction lost comes back with the small terms.
    first
        + ((1.0 - first) - half
            + (z * z * (0.041_666_653 + z * (-0.001_388_765_4 + z * 0.000_024_463_776)) - r * low))
}

/// The multiple k of π/2 nearest to x > π/4, by its last two bits, and x − kπ/2 in two parts; NaN for
/// infinity and NaN.
///
/// x = m 2ᵉ with an integer m, so that of 2/π only bits of weight below 4/2ᵉ matter: 96 of them leave an
/// error of 2⁻⁶², and no `f32` comes closer to a multiple of π/2 than 2⁻³⁰.
#[inline]
fn reduced(x: f32) -> (u32, f32, f32) {
    let bits = x.to_bits();
    let exponent = (bits >> 23) & 0xff;
    if exponent == 0xff {
        return (0, f32::NAN, 0.0);
    }
    let m = u64::from(bits & 0x7f_ffff | 0x80_0000);
    // The first bit of weight below 4, counted from the front of the table.
    let first = exponent.wrapping_sub(120);
    let (word, shift) = ((first / 32) as usize, first % 32);
    let bits_of = |i: usize| {
        let pair = u64::from(TWO_OVER_PI[(word + i) % 8]) << 32 | u64::from(TWO_OVER_PI[(word + i + 1) % 8]);
        (pair << shift) >> 32
    };
    // x 2/π/4 modulo 1, in units of 2⁻⁶⁴; then the quarter and what is left of it.
    let turn =
        (m.wrapping_mul(bits_of(0)) << 32).wrapping_add(m * bits_of(1)).wrapping_add((m * bits_of(2)) >> 32);
    let quarter = turn.wrapping_add(1 << 61) >> 62;
    let rest = turn.wrapping_sub(quarter << 62) as i64;
    // rest π/2 2⁻⁶², with 32 leading bits.
    let size = rest.unsigned_abs();
    let zeros = size.leading_zeros();
    let leading = (size << (zeros % 64)) >> 32;
    let product = ((leading * 0xc90f_daa2) >> 32) as u32;
    let unit = f32::from_bits((98 - zeros) << 23);
    let unit = if rest < 0 { -unit } else { unit };
    let rounded = product & 0xffff_ff00;
    (quarter as u32, rounded as f32 * unit, (product - rounded) as f32 * unit)
}

/// 2ˣ.
#[inline]
#[expect(
    clippy::excessive_precision,
    clippy::approx_constant,
    reason = "coefficients of the fit, not ln 2 and its powers"
)]
pub fn exp2(x: f32) -> f32 {
    if x.is_nan() {
        return x;
    }
    // Beyond these the result is infinity or 0.
    let x = x.clamp(-160.0, 130.0);
    let n = (x + if x < 0.0 { -0.5 } else { 0.5 }) as i32;
    let f = x - n as f32;
    let power = 1.0
        + f * (0.693_147_2
            + f * (0.240_226_51
                + f * (0.055_502_973 + f * (0.009_618_031 + f * (0.001_341_000_4 + f * 0.000_154_697_45)))));
    // In two parts, since 2ⁿ alone may leave the normal numbers.
    let half = n / 2;
    power * power_of_two(half) * power_of_two(n - half)
}

/// 2ⁿ for |n| ≤ 80.
#[inline]
fn power_of_two(n: i32) -> f32 {
    f32::from_bits(((n + 127) as u32) << 23)
}

/// Arcsine.
#[inline]
pub fn asin(x: f32) -> f32 {
    let size = x.abs();
    if size <= 0.5 {
        return if size < TINY { x } else { x + x * excess(x * x) };
    }
    // asin x = π/2 − 2 asin √((1 − x)/2); NaN beyond 1.
    let z = (1.0 - size) * 0.5;
    let root = libm::sqrtf(z);
    // In two parts, as π/2: their difference may be smaller than either.
    let high = f32::from_bits(root.to_bits() & 0xffff_f000);
    let low = if root > 0.0 { (z - high * high) / (root + high) } else { 0.0 };
    let small = 2.0 * root * excess(z) - (FRAC_PI_2_LOW - 2.0 * low);
    (FRAC_PI_4 - (small - (FRAC_PI_4 - 2.0 * high))).copysign(x)
}

/// asin √z/√z − 1 for z ≤ ¼.
#[inline]
fn excess(z: f32) -> f32 {
    z * (0.166_667_31 + z * (0.074_956_626 + z * (0.045_466_63 + z * (0.024_051_787 + z * 0.042_563_37))))
}

/// Hyperbolic tangent. libm's is off by 2.07 units.
#[inline]
pub fn tanh(x: f32) -> f32 {
    let size = x.abs();
    if size < TINY {
        return x;
    }
    if size < 0.625 {
        let z = x * x;
        return x + x
            * z
            * (-0.333_332_93
                + z * (0.133_315_41 + z * (-0.053_738_553 + z * (0.020_615_738 - z * 0.005_664_465))));
    }
    // NaN fails the comparison too.
    let tanh = if size > 10.0 { 1.0 } else { 1.0 - 2.0 / (libm::expm1f(2.0 * size) + 2.0) };
    tanh.copysign(x)
}

/// Cube root.
#[inline]
pub fn cbrt(x: f32) -> f32 {
    let size = x.abs();
    if size == 0.0 || !size.is_finite() {
        return x;
    }
    // Subnormal and very large numbers are moved by 2^±24, their roots back by 2^∓8.
    let (y, back) = if size < f32::MIN_POSITIVE {
        (size * power_of_two(24), power_of_two(-8))
    } else if size > 1e30 {
        (size * power_of_two(-24), power_of_two(8))
    } else {
        (size, 1.0)
    };
    // A third of the exponent: within 5 %. Halley's steps cube the error.
    let mut root = f32::from_bits(y.to_bits() / 3 + 0x2a50_8935);
    for _ in 0..2 {
        let cube = root * root * root;
        root -= root * ((cube - y) / (2.0 * cube + y));
    }
    (root * back).copysign(x)
}

/// √(x² + y²).
#[inline]
pub fn hypot(x: f32, y: f32) -> f32 {
    let (x, y) = (x.abs(), y.abs());
    if x == f32::INFINITY || y == f32::INFINITY {
        return f32::INFINITY;
    }
    let large = x.max(y);
    // Squares neither overflow nor lose digits.
    let (down, up) = if large > 1e18 {
        (power_of_two(-70), power_of_two(70))
    } else if large < 1e-18 {
        (power_of_two(70), power_of_two(-70))
    } else {
        (1.0, 1.0)
    };
    let (x, y) = (x * down, y * down);
    libm::sqrtf(x * x + y * y) * up
}

/// arcosh x. Near 1 by √(2t) (1 − t/12 + 3t²/160 − …), t = x − 1, the series of arsinh √(t/2): libm's
/// logarithm of a sum is off by more than 2 units there.
#[inline]
pub fn acosh(x: f32) -> f32 {
    let t = x - 1.0;
    if t < 0.0 {
        // libm's value at x ≤ −1 is a number; there is none.
        return f32::NAN;
    }
    if t < 0.25 {
        let tail = -5.0 / 896.0 + t * (35.0 / 18432.0 + t * (-63.0 / 90112.0 + t * (231.0 / 851_968.0)));
        let root = libm::sqrtf(2.0 * t);
        return root + root * (t * (-1.0 / 12.0 + t * (3.0 / 160.0 + t * tail)));
    }
    libm::acoshf(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error in units in the last place over every 9973rd `f32` of moderate result, against `f64`.
    fn worst(function: fn(f32) -> f32, reference: fn(f64) -> f64) -> f64 {
        (0..u32::MAX).step_by(9973).map(f32::from_bits).fold(0.0, |worst: f64, x| {
            let (value, exact) = (function(x), reference(f64::from(x)));
            if !(1e-30..1e30).contains(&exact.abs()) {
                return worst;
            }
            let unit = 2.0_f64.powi(exact.abs().log2().floor() as i32 - 23);
            worst.max((f64::from(value) - exact).abs() / unit)
        })
    }

    #[test]
    fn errors_stay_below_two_units_in_the_last_place() {
        // `firmware/host/src/bin/single_precision.rs` takes more of them; its table stands in
        // docs/embedding.md.
        assert!(worst(sin, f64::sin) < 1.0);
        assert!(worst(cos, f64::cos) < 1.0);
        assert!(worst(|x| sin_cos(x).0, f64::sin) < 1.0);
        assert!(worst(|x| sin_cos(x).1, f64::cos) < 1.0);
        assert!(worst(tan, f64::tan) < 2.0);
        assert!(worst(exp2, f64::exp2) < 2.0);
        assert!(worst(asin, f64::asin) < 2.0);
        assert!(worst(tanh, f64::tanh) < 2.0);
        assert!(worst(cbrt, f64::cbrt) < 2.0);
        assert!(worst(acosh, f64::acosh) < 2.0);
        assert!(worst(|x| hypot(x, 1.7), |x| x.hypot(f64::from(1.7_f32))) < 2.0);
        // Positive control: the next number is off by one more.
        assert!(worst(|x| sin(x).next_up(), f64::sin) > 1.0);
    }

    #[test]
    fn special_values_are_those_of_the_standard_library() {
        let special = [
            0.0,
            -0.0,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
            1e-45,
            -1e-40,
            1.0,
            -1.0,
            2.0,
            -300.0,
            300.0,
        ];
        type Function = fn(f32) -> f32;
        let pairs: [(Function, Function); 9] = [
            (sin, f32::sin),
            (cos, f32::cos),
            (tan, f32::tan),
            (exp2, f32::exp2),
            (asin, f32::asin),
            (tanh, f32::tanh),
            (cbrt, f32::cbrt),
            (acosh, f32::acosh),
            (|x| hypot(x, f32::INFINITY), |x| x.hypot(f32::INFINITY)),
        ];
        for (index, (own, standard)) in pairs.into_iter().enumerate() {
            for x in special {
                let (value, expected) = (own(x), standard(x));
                let close = (value - expected).abs() <= 4.0 * f32::EPSILON * expected.abs();
                let same = value.to_bits() == expected.to_bits() || (value.is_nan() && expected.is_nan());
                assert!(
                    same || (close && value.is_sign_negative() == expected.is_sign_negative()),
                    "{index} at {x}: {value} {expected}"
                );
            }
        }
        assert!(hypot(f32::NAN, 1.0).is_nan());
        assert_eq!(hypot(3e30, 4e30), 5e30);
        assert_eq!(hypot(3e-30, 4e-30), 5e-30);
    }
}
