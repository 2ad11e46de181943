//! The demands of friction that holds on a system, and on its R.

use super::derived::{Derived, Fault};
use super::diagnostics::{Mistake, Report};
use super::model::{Engine, System};
use super::parts::Part;

/// The motion stops at a kink, where −∂R/∂v is a set.
const UNSERVED: &str = "R has a kink here, at which the motion can stop; only `rule = proximal` has that step: \
                        use it, or smooth R, as √(v² + ε²) for |v|";

/// Reports what the attribute asks for and steps with kinks do not have.
pub fn check(system: &System<'_>, report: &mut Report) {
    let Some(word) = &system.rules.proximal else { return };
    let mut refuse = |lacks| report.at(word, Mistake::Kinks { lacks });
    if system.engine == Engine::NumDual {
        refuse("needs to see R, which `derivatives = num_dual` leaves to the run; leave that out");
    }
    if !system.has(Part::Rayleigh) {
        refuse("holds by the kinks of a Rayleigh function, and there is none; use `midpoint`");
    }
    if system.is_constrained() {
        refuse("is not solved on constraints; leave one of them out");
    }
    if system.has(Part::TimeScale) {
        refuse("takes no steps that follow a time scale; remove `time_scale`");
    }
}

/// Reports kinks that the rules do not take, and an R without any where the rule is for kinks.
pub fn check_derived(system: &System<'_>, derived: &Derived, report: &mut Report) {
    let kinks = &derived.kinks;
    let Some(word) = &system.rules.proximal else {
        for &at in &kinks.certain {
            report.at_span(at, Mistake::Kink { fault: UNSERVED });
        }
        return;
    };
    if kinks.components() > 0 {
        for other in &system.rules.others {
            report.at(other, Mistake::KinkByOther { rule: other.to_string() });
        }
    } else if kinks.faults.is_empty() {
        let lacks = "holds by kinks of R such as `v[0].abs()`, and none is seen in this R; without one it is `midpoint`: \
                     use that";
        report.at(word, Mistake::Kinks { lacks });
    }
    for &(fault, at) in &kinks.faults {
        let fault = match fault {
            Fault::NotLinear => {
                "a kink of R is of what is not linear in `v`: write it of what is, as |A(q) v − b(q, t)|"
            }
            Fault::NotApart => {
                "a kink of R has a factor that depends on `v` or stands in another kink: leave in front of it \
                 nothing but fields, `q` and the time"
            }
            Fault::LengthNotProportional => {
                "a length of `v` stands in another function: R may be proportional to a length, or a function of |v|"
            }
            Fault::NotSquares => {
                "a root of a quadratic form of `v` has a kink at rest: write the form as a sum of squares of what \
                 is linear in `v`, as a·v₀² + b·v₁²"
            }
        };
        report.at_span(at, Mistake::Kink { fault });
    }
}
