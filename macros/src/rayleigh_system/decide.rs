//! Which engine makes a system's derivatives.

use super::derived::{self, Derived};
use super::diagnostics::{Mistake, Report};
use super::dual::rewrite;
use super::dual::{self, Twins};
use super::lower::{self, Refusal};
use super::model::{Engine, Runtime, System};
use super::{constraints, joint, kinks, lanes, parameters};

/// Bodies of at most as many expressions are lowered where rewriting them is doubtful: what stands in loops
/// and calls is then written out once for each.
const MOST_EXPRESSIONS: usize = 2_000;

/// The decision which engine makes the derivatives.
pub enum Decision {
    /// They are written out.
    WrittenOut(Box<Derived>),
    /// num-dual, over the twins; with the reason, where nobody asked for it.
    DualNumbers(Twins, Option<Refusal>),
    /// Nobody: the report says why.
    Refused,
}

/// Decides by what the attribute asks for, what the bodies allow and what the runtime has.
pub fn engine(system: &System<'_>, runtime: Runtime, report: &mut Report) -> Decision {
    if !report.is_empty() {
        // The mistakes in bodies are shown beside those found so far.
        rewrite::over_duals(system, report);
        parameters::check_unread(system, report);
        return Decision::Refused;
    }
    lanes::check(system, report);
    constraints::check(system, report);
    kinks::check(system, report);
    match system.engine {
        Engine::NumDual => by_duals(system, report),
        Engine::Auto if !asks_for_code(system) => by_either(system, runtime, report),
        Engine::Auto | Engine::Expanded => written_out(system, runtime, report),
    }
}

/// Whether derivatives by parameters are asked for, code on lanes or fused sums, or constraints or friction
/// hold the system: dual numbers have none of them.
fn asks_for_code(system: &System<'_>) -> bool {
    let is_asked = !system.parameters.is_empty() || system.lanes.words().next().is_some();
    is_asked || system.fused.is_some() || system.is_constrained() || system.rules.proximal.is_some()
}

/// `derivatives = auto`: written out where they can be.
fn by_either(system: &System<'_>, runtime: Runtime, report: &mut Report) -> Decision {
    let refusal = match expansion(system, report) {
        Ok(decision) => return decision,
        Err(refusal) if refusal.is_final => return not_lowered(refusal, false, report),
        Err(refusal) => refusal,
    };
    let twins = rewrite::over_duals(system, report);
    if !report.is_empty() {
        needs_duals(Some(refusal), report);
        return Decision::Refused;
    }
    if !runtime.has_std {
        report.at_span(refusal.span, Mistake::NotLoweredWithoutStd(refusal.reason));
        return Decision::Refused;
    }
    Decision::DualNumbers(Twins::Rewritten(twins), Some(refusal))
}

/// `derivatives = expanded`: written out, or an error.
fn written_out(system: &System<'_>, runtime: Runtime, report: &mut Report) -> Decision {
    expansion(system, report).unwrap_or_else(|refusal| {
        // Advice that the system could not follow is none.
        let is_sound = report.is_empty() && !refusal.is_final && !asks_for_code(system);
        let by_duals = is_sound && runtime.has_std && {
            let mut mistakes = Report::default();
            rewrite::over_duals(system, &mut mistakes);
            mistakes.is_empty()
        };
        not_lowered(refusal, by_duals, report)
    })
}

/// The derivatives written out, as far as the system has what it asks for.
fn expansion(system: &System<'_>, report: &mut Report) -> Result<Decision, Refusal> {
    let lowered = lower::system(system);
    joint::check(system, lowered.as_ref().ok(), report);
    let is_sound = report.is_empty();
    match &lowered {
        Ok(lowered) => parameters::check(system, lowered, report),
        Err(_) => parameters::check_unread(system, report),
    }
    let lowered = lowered?;
    constraints::check_lowered(system, &lowered, report);
    if !is_sound {
        return Ok(Decision::Refused);
    }
    // Parameters that are none hide nothing of what is found in the expressions.
    let without_parameters = System { parameters: Vec::new(), ..system.clone() };
    let system = if report.is_empty() { system } else { &without_parameters };
    let derived = derived::functions(system, lowered)?;
    lanes::check_derived(system, &derived, report);
    constraints::check_derived(system, &derived, report);
    kinks::check_derived(system, &derived, report);
    if !report.is_empty() {
        return Ok(Decision::Refused);
    }
    Ok(Decision::WrittenOut(Box::new(derived)))
}

/// `derivatives = num_dual`: over rewritten bodies, or over expressions where those say too little.
fn by_duals(system: &System<'_>, report: &mut Report) -> Decision {
    joint::check(system, None, report);
    if !report.is_empty() {
        rewrite::over_duals(system, report);
        return Decision::Refused;
    }
    let mut mistakes = Report::default();
    let twins = rewrite::over_duals(system, &mut mistakes);
    let (is_sound, is_doubtful) = (mistakes.is_empty(), twins.iter().any(|twin| twin.is_doubtful));
    let over_bodies = Decision::DualNumbers(Twins::Rewritten(twins), None);
    if is_sound && !is_doubtful {
        return over_bodies;
    }
    match lower::system(system) {
        Ok(lowered) if is_sound && lowered.graph.len() > MOST_EXPRESSIONS => over_bodies,
        Ok(lowered) if !dual::names_are_taken(system) => {
            Decision::DualNumbers(Twins::Lowered(Box::new(lowered)), None)
        }
        _ if is_sound => over_bodies,
        Err(refusal) if refusal.is_final => not_lowered(refusal, false, report),
        refusal => {
            needs_duals(refusal.err(), &mut mistakes);
            *report = mistakes;
            Decision::Refused
        }
    }
}

/// Reports why dual numbers were needed, where the mistakes found are limits of dual numbers alone.
fn needs_duals(refusal: Option<Refusal>, report: &mut Report) {
    if let Some(refusal) = refusal.filter(|_| report.is_limit_of_duals()) {
        report.at_span(refusal.span, Mistake::NeedsDuals(refusal.reason));
    }
}

/// Refuses a system that was to be written out, or that no engine can follow.
fn not_lowered(refusal: Refusal, by_duals: bool, report: &mut Report) -> Decision {
    report.at_span(refusal.span, Mistake::NotLowered { reason: refusal.reason, by_duals });
    Decision::Refused
}
