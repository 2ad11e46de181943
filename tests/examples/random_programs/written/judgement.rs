//! Whether what a program computed is what its plain copy does.

use super::super::computed::Computed;
use super::super::trial::{self, Trial};
use super::super::verdict::all_same;
use super::manner::Manner;
use super::{POINTS, Written};

/// Differences whose two extrapolations are farther apart say nothing: a branch or a kink is near.
const DOUBT: f64 = 1e-7;

/// What derivatives may differ by beside ten times that: no term of a body is as small.
const ROUNDING: f64 = 1e-9;
/// In single precision the generated derivatives are rounded so.
const ROUNDING_SINGLE: f64 = 1e-3;

/// What became of derivatives at a point.
enum Slopes {
    Compared,
    InDoubt,
    Differ(String),
}

/// Of what rustc said: a message without a code is the macro's, but for what tokens that are no Rust give.
pub fn told(error: &str) -> Trial {
    const OF_RUSTC: [&str; 6] = [
        "error: expected",
        "error: unexpected",
        "error: no rules",
        "error: cannot find",
        "panicked",
        "error: unknown",
    ];
    // Words of the runtime for what only types tell, the last by a trait that has the methods of slices.
    let by_types = [
        ("may have operators of its own", "a reference, or a type that may have operators of its own"),
        ("does not fit the scalar type of this system", "does not fit the scalar type of this system"),
        ("multiple applicable items in scope", "a method of a trait in scope has the name of one of slices'"),
    ];
    if let Some((_, words)) = by_types.iter().find(|(found, _)| error.contains(found)) {
        return Trial::Refused(format!("told by rustc: {words}"));
    }
    match error.strip_prefix("error: ") {
        Some(reason) if !OF_RUSTC.iter().any(|words| error.contains(words)) => {
            Trial::Refused(reason.to_owned())
        }
        _ => trial::told_by_rustc(error),
    }
}

/// The trial of what was computed at all points.
pub fn judged<'c>(program: &Written, computed: impl Fn(usize) -> Option<&'c Computed>) -> Trial {
    let (mut compared, mut near_branch) = (0, 0);
    for point in 0..POINTS {
        let Some(computed) = computed(point) else {
            return Trial::Failed("value: the generated code panics".to_owned());
        };
        let found = match values(program, computed) {
            Some(words) => Slopes::Differ(words),
            None => slopes(program, computed),
        };
        match found {
            Slopes::Compared if computed.is_told => {
                return Trial::Failed(format!("alarm: a run would refuse what is right; at point {point}"));
            }
            Slopes::Compared => compared += 1,
            Slopes::InDoubt => near_branch += 1,
            Slopes::Differ(words) if computed.is_told && program.manners.contains(&Manner::SliceNames) => {
                return Trial::Refused(format!(
                    "told where a run starts: {}",
                    words.split(':').next().unwrap_or_default()
                ));
            }
            Slopes::Differ(words) => {
                let told = if computed.is_told { "told by runs" } else { "not told by runs" };
                return Trial::Failed(format!("{words}; {told}; at point {point}"));
            }
        }
    }
    Trial::Agrees { compared, near_branch, too_large: 0 }
}

/// What differs of the values, which are to be the plain function's to the bit.
fn values(program: &Written, computed: &Computed) -> Option<String> {
    let Some(plain) = &computed.plain else { return Some("value: the plain function panics".to_owned()) };
    if !computed.own.as_ref().is_some_and(|own| all_same(own, plain)) {
        return Some(format!("own value: under the attribute {:?}, without it {plain:?}", computed.own));
    }
    let scalars = 1 + usize::from(program.seen.rayleigh);
    let (mut gradients, mut derivatives) = (0, 0);
    for (from, values) in &computed.values {
        let start = match *from {
            "gradient" => &mut gradients,
            "derivatives" => &mut derivatives,
            _ => &mut scalars.clone(),
        };
        let expected = plain.get(*start..*start + values.len());
        *start += 1;
        if !expected.is_some_and(|expected| all_same(expected, values)) {
            return Some(format!("value: {from} {values:?}, plain function {plain:?}"));
        }
    }
    None
}

fn slopes(program: &Written, computed: &Computed) -> Slopes {
    let generated = computed.gradients.iter().map(Vec::as_slice);
    let size = 2 * program.n;
    let rows = computed.hessians.iter().flat_map(|hessian| hessian.chunks(size));
    let mut is_in_doubt = false;
    let parts = [
        ("gradient", generated.collect::<Vec<_>>(), &computed.slopes),
        ("Hessian", rows.collect(), &computed.curvatures),
    ];
    for (what, generated, differences) in parts {
        if generated.len() != differences.len() {
            is_in_doubt = true;
            continue;
        }
        for (row, (generated, differences)) in generated.iter().zip(differences).enumerate() {
            let (expected, errors) = differences.split_at(size);
            let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
            for (at, ((generated, expected), error)) in generated.iter().zip(expected).zip(errors).enumerate()
            {
                let rounding = if program.single { ROUNDING_SINGLE } else { ROUNDING };
                if error.is_nan() || *error > DOUBT * scale {
                    is_in_doubt = true;
                } else if generated.is_nan() || (generated - expected).abs() > rounding * scale + 10.0 * error
                {
                    return Slopes::Differ(format!(
                        "derivative: {what} {row}, entry {at}: {generated:e} for {expected:e} within {error:e}"
                    ));
                }
            }
        }
    }
    if is_in_doubt { Slopes::InDoubt } else { Slopes::Compared }
}
