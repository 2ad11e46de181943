//! Elementary functions of `f32` in `f32`, for processors whose `f64` is software.
//!
//! libm's sine, cosine, tangent, 2ˣ, arcsine, cube root and hypotenuse of an `f32` compute in `f64`. These stay in `f32` and
//! integers. Errors are below 2 units in the last place; the program `single_precision` of the test package measures them over
//! every `f32`, and a test over samples. Coefficients are minimax fits of our own, rounded to `f32`.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// The bits of 2/π behind the point, after 32 zeros.
const TWO_OVER_PI: [u32; 8] =
    [0, 0xa2f9_836e, 0x4e44_1529, 0xfc27_57d1, 0xf534_ddc0, 0xdb62_9599, 0x3c43_9041, 0xfe51_63ab];

/// Sine and cosine.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let size = x.abs();
    if size <= FRAC_PI_4 {
        return (near_sin(x), near_cos(x));
    }
    let (quarter, r) = reduced(size);
    let (sine, cosine) = (near_sin(r), near_cos(r));
    let (sine, cosine) = if quarter % 2 == 0 { (sine, cosine) } else { (cosine, -sine) };
    let (sine, cosine) = if quarter >= 2 { (-sine, -cosine) } else { (sine, cosine) };
    (if x < 0.0 { -sine } else { sine }, cosine)
}

/// Sine.
#[inline]
pub fn sin(x: f32) -> f32 {
    let size = x.abs();
    if size <= FRAC_PI_4 {
        return near_sin(x);
    }
    let (quarter, r) = reduced(size);
    let sine = if quarter % 2 == 0 { near_sin(r) } else { near_cos(r) };
    if (quarter >= 2) != (x < 0.0) { -sine } else { sine }
}

/// Cosine.
#[inline]
pub fn cos(x: f32) -> f32 {
    let size = x.abs();
    if size <= FRAC_PI_4 {
        return near_cos(x);
    }
    let (quarter, r) = reduced(size);
    let cosine = if quarter % 2 == 0 { near_cos(r) } else { near_sin(r) };
    if quarter == 1 || quarter == 2 { -cosine } else { cosine }
}

/// Tangent.
#[inline]
pub fn tan(x: f32) -> f32 {
    let (sine, cosine) = sin_cos(x);
    sine / cosine
}

/// sin r for |r| ≤ π/4.
#[inline]
fn near_sin(r: f32) -> f32 {
    let z = r * r;
    r + r * z * (-0.166_666_55 + z * (0.008_332_101 - z * 0.000_195_039_3))
}

/// cos r for |r| ≤ π/4.
#[inline]
fn near_cos(r: f32) -> f32 {
    let z = r * r;
    1.0 - (0.5 * z - z * z * (0.041_666_653 + z * (-0.001_388_765_4 + z * 0.000_024_463_776)))
}

/// The multiple k of π/2 nearest to x > π/4, by its last two bits, and x − kπ/2; NaN for infinity and NaN.
///
/// x = m 2ᵉ with an integer m, so that of 2/π only bits of weight below 4/2ᵉ matter: 96 of them leave an error of 2⁻⁶², and
/// no `f32` comes closer to a multiple of π/2 than 2⁻³⁰.
#[inline]
fn reduced(x: f32) -> (u32, f32) {
    let bits = x.to_bits();
    let exponent = (bits >> 23) & 0xff;
    if exponent == 0xff {
        return (0, f32::NAN);
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
    let product = (leading * 0xc90f_daa2) >> 32;
    let r = product as u32 as f32 * f32::from_bits((98 - zeros) << 23);
    (quarter as u32, if rest < 0 { -r } else { r })
}

/// 2ˣ.
#[inline]
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
        return x + x * excess(x * x);
    }
    // asin x = π/2 − 2 asin √((1 − x)/2); NaN beyond 1.
    let z = (1.0 - size) * 0.5;
    let root = libm::sqrtf(z);
    (FRAC_PI_2 - 2.0 * (root + root * excess(z))).copysign(x)
}

/// asin √z/√z − 1 for z ≤ ¼.
#[inline]
fn excess(z: f32) -> f32 {
    z * (0.166_667_31 + z * (0.074_956_626 + z * (0.045_466_63 + z * (0.024_051_787 + z * 0.042_563_37))))
}

/// Cube root.
#[inline]
pub fn cbrt(x: f32) -> f32 {
    let size = x.abs();
    if size == 0.0 || !size.is_finite() {
        return x;
    }
    // Subnormal numbers are raised by 2²⁴, their root lowered by 2⁸.
    let (y, lowered) =
        if size < f32::MIN_POSITIVE { (size * 16_777_216.0, 0.003_906_25) } else { (size, 1.0) };
    // A third of the exponent: within 5 %. Halley's steps cube the error.
    let mut root = f32::from_bits(y.to_bits() / 3 + 0x2a50_8935);
    for _ in 0..2 {
        let cube = root * root * root;
        root -= root * ((cube - y) / (2.0 * cube + y));
    }
    (root * lowered).copysign(x)
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
