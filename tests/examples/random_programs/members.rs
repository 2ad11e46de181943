//! Programs as forces of several members at once: what lanes compute, beside what each member does alone.

use std::fmt::Write as _;

use super::batch::Computed;
use super::point::{POINTS, Point, points};
use super::print;
use super::syntax::Program;
use super::trial::Trial;

/// The name of this way among the engines.
pub const LANES: &str = "lanes";

/// The options of the macro.
pub const OPTIONS: &str = "rule = trapezoidal, lanes = explicit, derivatives = expanded";

/// Where the time is set.
const TIME: &str = "0.25";

/// The program's block with explicit steps: its L and R at (q, q) are the potential, its f there is the force.
pub fn block(program: &Program) -> String {
    let (n, m) = (program.n, program.inputs);
    let scalar = if program.single { "f32" } else { "f64" };
    let mut text = print::block(program);
    for name in ["lagrangian", "rayleigh", "force"] {
        text = text.replace(&format!("pub fn {name}("), &format!("fn written_{name}("));
    }
    let time = program.timed.map(|is_timed| if is_timed { format!(", {TIME}") } else { String::new() });
    let mut potential = format!("self.written_lagrangian(q, q{})", time[0]);
    if let Some((of_both, _)) = &program.rayleigh {
        let q = if *of_both { "q, " } else { "" };
        write!(potential, " + self.written_rayleigh({q}q{})", time[1]).expect("a string takes all");
    }
    let mut own = format!(
        "pub fn lagrangian(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]) -> {scalar} {{\n\
         let mut kinetic = 0.0;\nfor i in 0..{n} {{ kinetic += 0.5 * v[i] * v[i]; }}\nkinetic - ({potential})\n}}\n"
    );
    if program.force.is_some() {
        let (parameter, input) =
            if m > 0 { (format!(", u: [{scalar}; {m}]"), ", u") } else { (String::new(), "") };
        write!(
            own,
            "pub fn force(&self, q: [{scalar}; {n}], _v: [{scalar}; {n}]{parameter}) -> [{scalar}; {n}] {{\n\
             self.written_force(q, q{input}{})\n}}\n",
            time[2]
        )
        .expect("a string takes all");
    }
    text.replacen("impl System {\n", &format!("impl System {{\n{own}"), 1)
}

/// The module of a program, whose members stand at its points, each with the input there.
pub fn module(program: &Program, index: usize) -> String {
    let (n, m) = (program.n, program.inputs);
    let scalar = if program.single { "f32" } else { "f64" };
    let points: Vec<String> =
        points(program).iter().map(|Point { q, v, u, .. }| format!("({q:?}, {v:?}, {u:?})")).collect();
    let systems = if m > 0 && program.force.is_some() {
        "let views = points.map(|(_, _, u)| s.driven(u));\nlet systems = views.each_ref();"
    } else {
        "let systems = points.map(|_| &s);"
    };
    format!(
        "mod p{index} {{\n{}#[dalembert::rayleigh_system({OPTIONS})]\n{}\
         pub fn run() {{\nlet s = system();\n\
         let points: [([{scalar}; {n}], [{scalar}; {n}], [{scalar}; {m}]); {POINTS}] = [{}];\n{systems}\n\
         crate::lanes({index}, systems, points.map(|(q, v, _)| (q.into(), v.into())));\n}}\n}}\n",
        print::surroundings(program),
        block(program),
        points.join(", ")
    )
}

/// The trial of what lanes computed: of each, whether it is what its member does alone, and whether there was
/// a force.
pub fn judged(program: &Program, computed: Option<&Computed>) -> Trial {
    let Some(lanes) = computed.and_then(|computed| computed.lanes.as_ref()) else {
        // The potential at (q, q) may panic where the program does not.
        return Trial::Discarded;
    };
    let acts = |told: f64| told == 2.0;
    match lanes.iter().position(|told| *told == 0.0) {
        Some(lane) => Trial::Failed(format!("lanes: lane {lane} of {} is another", program.seed)),
        None => Trial::Agrees {
            compared: lanes.iter().filter(|told| acts(**told)).count(),
            near_branch: 0,
            too_large: 0,
        },
    }
}
