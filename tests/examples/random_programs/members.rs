//! Programs as forces of several members at once: what lanes compute, beside what each member does alone.

use std::fmt::Write as _;

use super::generate::VIEWS_FROM;
use super::point::{POINTS, Point, points};
use super::print;
use super::syntax::{Program, view};

/// What a program is in lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// An explicit system: L and R of the program at (q, q) are the potential, f there is the force.
    Explicit,
    /// L, R and f of the program, as perturbations of a particle, by Gauss rules.
    Gauss,
    /// The same by the midpoint rule.
    Midpoint,
}

impl Way {
    /// The one that an engine's name asks for.
    pub fn named(engine: &str) -> Option<Self> {
        match engine {
            "lanes" => Some(Self::Explicit),
            "gauss_lanes" => Some(Self::Gauss),
            "midpoint_lanes" => Some(Self::Midpoint),
            _ => None,
        }
    }

    /// The options of the macro.
    pub fn options(self) -> &'static str {
        match self {
            Self::Explicit => "rule = trapezoidal, lanes = explicit, derivatives = expanded",
            Self::Gauss => "rule = gauss, lanes = gauss, derivatives = expanded",
            Self::Midpoint => "rule = midpoint, lanes = midpoint, derivatives = expanded",
        }
    }

    /// The call of the harness with the system `s` at `points`, each by a view of its input and time.
    pub fn call(self, index: usize, view: Option<&str>) -> String {
        let function = match self {
            Self::Explicit => "lanes",
            Self::Gauss => "gauss_lanes",
            Self::Midpoint => "midpoint_lanes",
        };
        let systems = view.map_or_else(
            || "let systems = points.map(|_| &s);".to_owned(),
            |view| {
                format!("let views = points.map(|(_, _, u, t)| s.{view});\nlet systems = views.each_ref();")
            },
        );
        format!(
            "{systems}\ncrate::{function}({index}, systems, points.map(|(q, v, ..)| (q.into(), v.into())));\n"
        )
    }
}

/// Whether L, R and f of what is stepped take the time.
fn timed(program: &Program, way: Way) -> [bool; 3] {
    let [of_l, of_r, of_f] = program.timed;
    let of_r = of_r && program.rayleigh.is_some();
    // There R is a part of the potential.
    let of_l = of_l || (way == Way::Explicit && of_r);
    [of_l, of_r && way != Way::Explicit, of_f && program.force.is_some()]
}

/// The program's block, its functions called by those that are stepped.
pub fn block(program: &Program, way: Way) -> String {
    let (n, m) = (program.n, program.inputs);
    let scalar = if program.single { "f32" } else { "f64" };
    let mut text = print::block(program);
    for name in ["lagrangian", "rayleigh", "force"] {
        text = text.replace(&format!("pub fn {name}("), &format!("fn written_{name}("));
    }
    let time = program.timed.map(|is_timed| if is_timed { ", t" } else { "" });
    let taken =
        timed(program, way).map(|is_timed| if is_timed { format!(", t: {scalar}") } else { String::new() });
    // Where no velocity may occur, q stands for it.
    let (v, share) = if way == Way::Explicit { ("q", "1.0") } else { ("v", "0.1") };
    let rayleigh = program.rayleigh.as_ref().map(|(of_both, _)| {
        let q = if *of_both { "q, " } else { "" };
        format!("self.written_rayleigh({q}{v}{})", time[1])
    });
    let mut potential = format!("self.written_lagrangian(q, {v}{})", time[0]);
    let mut own = String::new();
    match (way, rayleigh) {
        (Way::Explicit, Some(rayleigh)) => write!(potential, " + {rayleigh}").expect("a string takes all"),
        (Way::Gauss | Way::Midpoint, Some(rayleigh)) => write!(
            own,
            "pub fn rayleigh(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]{}) -> {scalar} {{\n{share} * {rayleigh}\n}}\n",
            taken[1]
        )
        .expect("a string takes all"),
        (_, None) => {}
    }
    write!(
        own,
        "pub fn lagrangian(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]{}) -> {scalar} {{\n\
         let mut kinetic = 0.0;\nfor i in 0..{n} {{ kinetic += 0.5 * v[i] * v[i]; }}\n\
         kinetic - {share} * ({potential})\n}}\n",
        taken[0]
    )
    .expect("a string takes all");
    if program.force.is_some() {
        let (parameter, input) =
            if m > 0 { (format!(", u: [{scalar}; {m}]"), ", u") } else { (String::new(), "") };
        write!(
            own,
            "pub fn force(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]{parameter}{}) -> [{scalar}; {n}] {{\n\
             self.written_force(q, {v}{input}{})\n}}\n",
            taken[2], time[2]
        )
        .expect("a string takes all");
    }
    text.replacen("impl System {\n", &format!("impl System {{\n{own}"), 1)
}

/// Whether the program's sums are fused; none below the seeds that take times, which are those of earlier
/// counts.
fn is_fused(program: &Program) -> bool {
    program.seed >= VIEWS_FROM && program.seed % 2 == 1
}

/// The module of a program, whose members stand at its points, each with the input and the time there.
pub fn module(program: &Program, index: usize, way: Way) -> String {
    let fused = if is_fused(program) { ", multiply_add = fused" } else { "" };
    let options = format!("{}{fused}", way.options());
    let (n, m) = (program.n, program.inputs);
    let scalar = if program.single { "f32" } else { "f64" };
    let points: Vec<String> =
        points(program).iter().map(|Point { q, v, u, t }| format!("({q:?}, {v:?}, {u:?}, {t:?})")).collect();
    let points = format!(
        "let points: [([{scalar}; {n}], [{scalar}; {n}], [{scalar}; {m}], {scalar}); {POINTS}] = [{}];\n",
        points.join(", ")
    );
    let is_driven = m > 0 && program.force.is_some();
    let view = view(is_driven, timed(program, way).contains(&true));
    format!(
        "mod p{index} {{\n{}#[dalembert::rayleigh_system({options})]\n{}\
         pub fn run() {{\nlet s = system();\n{points}{}}}\n}}\n",
        print::surroundings(program),
        block(program, way),
        way.call(index, view)
    )
}
