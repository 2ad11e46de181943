//! Whether what was computed is what is expected.

use super::computed::Computed;
use super::expected::{Derivatives, Expected, Skipped};
use super::syntax::Program;

/// How far derivatives may differ, of the largest number on the way.
const ROUNDING: f64 = 1e-11;
const ROUNDING_SINGLE: f64 = 1e-3;

/// What was found at a point.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    Agrees,
    /// Values agree; derivatives were not compared.
    ValueAgrees(Skipped),
    Differs(String),
}

fn same(a: f64, b: f64) -> bool {
    // Zeros of either sign are one, as the project documents; a NaN is any NaN.
    a == b || (a.is_nan() && b.is_nan())
}

pub fn all_same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(*a, *b))
}

pub fn of(program: &Program, expected: &Expected, computed: &Computed) -> Verdict {
    let Some(plain) = &computed.plain else {
        return Verdict::Differs("the plain function panics, the interpreter does not".to_owned());
    };
    if !all_same(plain, &expected.values) {
        return Verdict::Differs(format!(
            "interpreter: plain function {plain:?}, interpreter {:?}",
            expected.values
        ));
    }
    // Gradients and derivatives tell the value of L, then that of R; then f.
    let scalars = 1 + usize::from(program.rayleigh.is_some());
    let (mut gradients, mut hessians) = (0, 0);
    for (from, values) in &computed.values {
        let (index, count) = match *from {
            "gradient" => (&mut gradients, 1),
            "derivatives" => (&mut hessians, 1),
            _ => (&mut gradients, program.n),
        };
        let start = if *from == "force" { scalars } else { *index };
        *index += 1;
        if !plain.get(start..start + count).is_some_and(|plain| all_same(plain, values)) {
            return Verdict::Differs(format!("value: {from} {values:?}, plain function {plain:?}"));
        }
    }
    match &expected.derivatives {
        Err(skipped) => Verdict::ValueAgrees(*skipped),
        Ok(derivatives) => compare(program, derivatives, &computed.gradients, &computed.hessians),
    }
}

/// Derivatives against differences, and num-dual's against them too.
pub fn compare(
    program: &Program,
    expected: &Derivatives,
    gradients: &[Vec<f64>],
    hessians: &[Vec<f64>],
) -> Verdict {
    let rounding = if program.single { ROUNDING_SINGLE } else { ROUNDING };
    let tolerance = rounding * expected.scale;
    let difference = |what: &str, a: &[f64], b: &[f64]| {
        let at = a.iter().zip(b).position(|(a, b)| (a - b).abs() > tolerance || (a - b).is_nan())?;
        Some(Verdict::Differs(format!(
            "derivative: {what}, entry {at}: {:e} for {:e}, tolerance {tolerance:e}",
            a[at], b[at]
        )))
    };
    for (index, derived) in expected.by_differences.iter().enumerate() {
        let dual = &expected.by_num_dual[index];
        let compared =
            difference("num-dual's gradient against differences", &dual.gradient, &derived.gradient)
                .or_else(|| {
                    difference("num-dual's Hessian against differences", &dual.hessian, &derived.hessian)
                })
                .or_else(|| difference("gradient", gradients.get(index)?, &derived.gradient))
                .or_else(|| difference("Hessian", hessians.get(index)?, &derived.hessian));
        if let Some(verdict) = compared {
            return verdict;
        }
    }
    Verdict::Agrees
}
