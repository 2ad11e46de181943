//! One program through the macro: refused, or held against what it must compute.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::computed::Computed;
use super::engine::options;
use super::expansion::{self, Reaction};
use super::expected::{self, Expected, Skipped};
use super::lowered;
use super::members;
use super::point::points;
use super::print;
use super::rayleigh_system::Runtime;
use super::syntax::Program;
use super::verdict::{self, Verdict};

/// What became of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum Trial {
    /// The plain function would panic or run too long, or rustc refuses it without the macro as well: no
    /// program at all.
    Discarded,
    Refused(String),
    /// Values agree at all points; so many points had their derivatives compared, and so many not.
    Agrees {
        compared: usize,
        near_branch: usize,
        too_large: usize,
    },
    /// The graph holds an expression of fields that is read by rustc alone.
    Unread(String),
    Failed(String),
}

/// What is expected at the points of a program; nothing where its plain functions panic.
pub fn expected(program: &Program) -> Option<Vec<Expected>> {
    expected::all_points(program, &points(program))
}

/// Whether the macro takes the program; where it does not, that is the end of the trial.
pub fn reaction(program: &Program, engine: &str, runtime: Runtime) -> Option<Trial> {
    let reaction = match members::Way::named(engine) {
        Some(way) => expansion::of(&members::block(program, way), way.options(), runtime),
        None => expansion::of(&print::block(program), &options(engine), runtime),
    };
    match reaction {
        Reaction::Refused(reason) => Some(Trial::Refused(reason)),
        Reaction::Panicked(message) => Some(Trial::Failed(format!("panic: the macro panics: {message}"))),
        Reaction::Accepted if program.has_cfg => {
            Some(Trial::Failed("cfg: a body with `#[cfg]` is accepted".to_owned()))
        }
        Reaction::Accepted => None,
    }
}

/// What rustc said: the runtime's own words for what dual numbers cannot follow are a refusal, anything else
/// is a mistake in generated code.
pub fn told_by_rustc(error: &str) -> Trial {
    const WORDS: [&str; 6] = [
        "cannot be used in a differentiated body",
        "a floating-point number of a differentiated body cannot become an integer",
        "`%` cannot be used on floating-point numbers of a differentiated body",
        "rounding and bit methods cannot be used in a differentiated body",
        "cannot be cast to the scalar type of this system",
        "this method has no derivative over dual numbers",
    ];
    match WORDS.iter().find(|words| error.contains(*words)) {
        Some(words) => Trial::Refused(format!("told by rustc: {words}")),
        None => Trial::Failed(format!("rustc: {error}")),
    }
}

/// The trial of what was computed.
pub fn judged<'c>(
    program: &Program,
    expected: &[Expected],
    computed: impl Fn(usize) -> Option<&'c Computed>,
) -> Trial {
    let (mut compared, mut near_branch, mut too_large) = (0, 0, 0);
    for (index, expected) in expected.iter().enumerate() {
        let Some(computed) = computed(index) else {
            return Trial::Failed("value: the generated code panics".to_owned());
        };
        match verdict::of(program, expected, computed) {
            Verdict::Agrees => compared += 1,
            Verdict::ValueAgrees(Skipped::NearBranch) => near_branch += 1,
            Verdict::ValueAgrees(Skipped::TooLarge) => too_large += 1,
            Verdict::Differs(words) => {
                return Trial::Failed(format!("{words}; at {:?}", points(program)[index]));
            }
        }
    }
    Trial::Agrees { compared, near_branch, too_large }
}

/// The trial of what lanes computed: of each, whether it is what its member does alone, and whether it was
/// moved.
pub fn judged_in_lanes(seed: u64, computed: Option<&Computed>) -> Trial {
    let Some(lanes) = computed.and_then(|computed| computed.lanes.as_ref()) else {
        // The potential at (q, q) may panic where the program does not.
        return Trial::Discarded;
    };
    let acts = |told: f64| told == 2.0;
    match lanes.iter().position(|told| *told == 0.0) {
        Some(lane) => Trial::Failed(format!("lanes: lane {lane} of {seed} is another")),
        None => Trial::Agrees {
            compared: lanes.iter().filter(|told| acts(**told)).count(),
            near_branch: 0,
            too_large: 0,
        },
    }
}

/// A program tried without rustc: its graph evaluated. A panic is a failure, of the study if not of the
/// macro.
pub fn by_graph(program: &Program) -> Trial {
    catch_unwind(AssertUnwindSafe(|| graph_tried(program))).unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().cloned();
        let message = message.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
        Trial::Failed(format!("panic: {}", message.unwrap_or_default()))
    })
}

fn graph_tried(program: &Program) -> Trial {
    let Some(expected) = expected(program) else { return Trial::Discarded };
    if let Some(end) = reaction(program, "expanded", Runtime::STD) {
        return end;
    }
    let expressions = match lowered::expressions(program, &print::block(program)) {
        Ok(expressions) => expressions,
        Err(reason) => return Trial::Refused(reason),
    };
    let mut all = Vec::new();
    for (point, expected) in points(program).iter().zip(&expected) {
        match expressions.computed(program, point, &expected.values) {
            Ok(computed) => all.push(computed),
            Err(reason) => return Trial::Unread(reason),
        }
    }
    judged(program, &expected, |index| all.get(index))
}
