//! Error of every elementary function of one `f32`, over every `f32`, in units in the last place.
//!
//! The reference is the standard library's function in `f64`, whose own error is some 10⁻⁸ of such a unit.
//! `single_precision 1` takes all 2³² numbers, `single_precision 4099` every 4099th; names of functions
//! behind the stride take these alone. Fails above 2 units.

use std::thread;

use dalembert::Elementary;

/// A function of one `f32`, and the same in `f64`.
type Pair = (&'static str, fn(f32) -> f32, fn(f64) -> f64);

/// Every function of one number, and both results of `sin_cos`.
const FUNCTIONS: [Pair; 25] = [
    ("sqrt", Elementary::sqrt, f64::sqrt),
    ("cbrt", Elementary::cbrt, f64::cbrt),
    ("exp", Elementary::exp, f64::exp),
    ("exp2", Elementary::exp2, f64::exp2),
    ("exp_m1", Elementary::exp_m1, f64::exp_m1),
    ("ln", Elementary::ln, f64::ln),
    ("log2", Elementary::log2, f64::log2),
    ("log10", Elementary::log10, f64::log10),
    ("ln_1p", Elementary::ln_1p, f64::ln_1p),
    ("sin", Elementary::sin, f64::sin),
    ("cos", Elementary::cos, f64::cos),
    ("sin_cos.0", |x| Elementary::sin_cos(x).0, f64::sin),
    ("sin_cos.1", |x| Elementary::sin_cos(x).1, f64::cos),
    ("tan", Elementary::tan, f64::tan),
    ("asin", Elementary::asin, f64::asin),
    ("acos", Elementary::acos, f64::acos),
    ("atan", Elementary::atan, f64::atan),
    ("sinh", Elementary::sinh, f64::sinh),
    ("cosh", Elementary::cosh, f64::cosh),
    ("tanh", Elementary::tanh, f64::tanh),
    ("asinh", Elementary::asinh, f64::asinh),
    ("acosh", Elementary::acosh, f64::acosh),
    ("atanh", Elementary::atanh, f64::atanh),
    // Of two numbers: along a line of the second.
    ("hypot(x, 1.7)", |x| Elementary::hypot(x, 1.7), |x| x.hypot(f64::from(1.7_f32))),
    ("atan2(x, 1.7)", |x| Elementary::atan2(x, 1.7), |x| x.atan2(f64::from(1.7_f32))),
];

/// The largest error found, and where.
#[derive(Clone, Copy)]
struct Worst {
    error: f64,
    at: f32,
}

/// Distance of `value` from `exact`, in units in the last place of an `f32` of that size; infinite where the
/// two are not of one kind (NaN, infinity).
fn error(value: f32, exact: f64) -> f64 {
    // The least number that rounds to infinity.
    let overflow = f64::from(f32::MAX) * (1.0 + f64::from(f32::EPSILON) / 4.0);
    if exact.is_nan() || value.is_nan() {
        return if exact.is_nan() && value.is_nan() { 0.0 } else { f64::INFINITY };
    }
    let exponent = (exact.to_bits() >> 52 & 0x7ff).clamp(1023 - 126, 1023 + 127);
    let unit = f64::from_bits((exponent - 23) << 52);
    if value.is_infinite() {
        // As if the next number after the largest were there.
        let beyond = f64::from(f32::MAX) + unit;
        let same_sign = (value > 0.0) == (exact > 0.0);
        return if !same_sign { f64::INFINITY } else { ((beyond - exact.abs()) / unit).max(0.0) };
    }
    if exact.abs() >= overflow {
        return (exact.abs().min(f64::from(f32::MAX) + unit) - f64::from(value).abs()) / unit;
    }
    (f64::from(value) - exact).abs() / unit
}

fn worst((_, function, reference): Pair, first: u64, stride: u64) -> Worst {
    let mut worst = Worst { error: 0.0, at: 0.0 };
    let mut bits = first;
    while bits < 1 << 32 {
        let x = f32::from_bits(bits as u32);
        let error = error(function(x), reference(f64::from(x)));
        if error > worst.error {
            worst = Worst { error, at: x };
        }
        bits += stride;
    }
    worst
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [stride, names @ ..] = &arguments[..] else {
        panic!("single_precision STRIDE [FUNCTION …]");
    };
    let stride: u64 = stride.parse().expect("a stride, such as 4099");
    let threads = thread::available_parallelism().map_or(1, |count| count.get() as u64);
    println!("{:14} {:>8}  at", "function", "ulp");
    let mut failed = false;
    for pair in FUNCTIONS {
        if !names.is_empty() && !names.iter().any(|name| name == pair.0) {
            continue;
        }
        let parts: Vec<_> = (0..threads)
            .map(|part| thread::spawn(move || worst(pair, part * stride, threads * stride)))
            .collect();
        let worst = parts
            .into_iter()
            .map(|part| part.join().expect("no function panics"))
            .fold(Worst { error: 0.0, at: 0.0 }, |a, b| if b.error > a.error { b } else { a });
        println!("{:14} {:8.3}  {:e}", pair.0, worst.error, worst.at);
        failed |= worst.error > 2.0;
    }
    assert!(!failed, "a function is off by more than 2 units in the last place");
}
