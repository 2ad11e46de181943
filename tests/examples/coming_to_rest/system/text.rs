//! Systems as the text of a program.

use super::System;

/// The text of some systems that differ in their numbers alone.
pub struct Text {
    /// What stands before the attribute: the type.
    pub declared: String,
    /// The annotated block.
    pub block: String,
    /// Each system, an expression.
    pub values: Vec<String>,
}

impl Text {
    /// The text of the first of `systems`, with the numbers of each.
    pub fn of(systems: &[System], attribute: &str) -> Self {
        let written: Vec<(String, Constants)> =
            systems.iter().map(|system| written(&systems[0], system)).collect();
        let (body, first) = &written[0];
        let declared = match first.are_fields {
            true => format!("pub struct System {{ c: [f64; {}] }}", first.own.len()),
            false => "pub struct System;".into(),
        };
        let values = written.iter().map(|(_, constants)| constants.value()).collect();
        Self { declared, block: format!("#[rayleigh_system({attribute})]\nimpl System {{\n{body}}}"), values }
    }
}

/// The functions of `first` as text, and the numbers of `own` in their places.
fn written(first: &System, own: &System) -> (String, Constants) {
    let mut constants = Constants { first: Vec::new(), own: Vec::new(), are_fields: first.has_fields };
    let [[mass, length, time], [own_mass, own_length, own_time]] = [first.units, own.units];
    let n = first.n;
    let l = constants.named(length, own_length);
    let mut potential = Vec::new();
    for (term, own) in first.terms.iter().zip(&own.terms) {
        let (i, other) = term.of;
        let sign = if term.offset < 0.0 { '+' } else { '-' };
        let outward = if term.offset < 0.0 { -1.0 } else { 1.0 };
        let offset = constants.named(outward * term.offset * length, outward * own.offset * own_length);
        let x = match (other, term.offset == 0.0, term.way % 2) {
            (None, true, _) => format!("q[{i}]"),
            (None, false, 0) => format!("q[{i}] {sign} {offset}"),
            (None, false, _) if term.offset < 0.0 => format!("{offset} + q[{i}]"),
            (None, false, _) => format!("q[{i}] {sign} {offset}"),
            (Some(j), true, _) => format!("q[{i}] - q[{j}]"),
            (Some(j), false, _) => format!("q[{i}] - q[{j}] {sign} {offset}"),
        };
        let k = constants.named(term.k * mass / (time * time), own.k * own_mass / (own_time * own_time));
        potential.push(format!("({})", term.law.text(&k, &x, &l, term.way)));
    }
    let mut kinetic = Vec::new();
    for i in 0..n {
        let m = constants.named(first.masses[i] * mass, own.masses[i] * own_mass);
        let factor = match first.varying[i] {
            0.0 => String::new(),
            a => {
                let a = constants.named(a, own.varying[i]);
                format!(" * (1.0 + {a} * (q[{i}] / {l}).sin().powi(2))")
            }
        };
        kinetic.push(format!("0.5 * {m}{factor} * v[{i}] * v[{i}]"));
    }
    let mut drag = Vec::new();
    for (i, ([linear, quadratic, cubic], own_drag)) in first.drag.iter().zip(&own.drag).enumerate() {
        if *linear != 0.0 {
            let c = constants.named(linear * mass / time, own_drag[0] * own_mass / own_time);
            drag.push(format!("0.5 * {c} * v[{i}] * v[{i}]"));
        }
        if *quadratic != 0.0 {
            let c = constants.named(quadratic * mass / length, own_drag[1] * own_mass / own_length);
            drag.push(format!("{c} * v[{i}].abs().powi(3) / 3.0"));
        }
        if *cubic != 0.0 {
            let unit = [mass * time / (length * length), own_mass * own_time / (own_length * own_length)];
            let c = constants.named(cubic * unit[0], own_drag[2] * unit[1]);
            drag.push(format!("0.25 * {c} * v[{i}].powi(4)"));
        }
    }
    for (i, (c, own_c)) in first.between.iter().zip(&own.between).enumerate() {
        if *c != 0.0 {
            let c = constants.named(c * mass / time, own_c * own_mass / own_time);
            drag.push(format!("0.5 * {c} * (v[{}] - v[{i}]).powi(2)", i + 1));
        }
    }
    if drag.is_empty() {
        let c = constants.named(mass / time, own_mass / own_time);
        drag.push(format!("0.05 * {c} * v[0] * v[0]"));
    }
    let body = format!(
        "fn lagrangian(&self, q: [f64; {n}], v: [f64; {n}]) -> f64 {{\nlet kinetic = {};\nlet potential = {};\n\
         kinetic - potential\n}}\nfn rayleigh(&self, v: [f64; {n}]) -> f64 {{\n{}\n}}\n",
        kinetic.join("\n+ "),
        potential.join("\n+ "),
        drag.join("\n+ "),
    );
    (body, constants)
}

/// The constants of a text: of the system that it is written for, and of one that reads the same.
struct Constants {
    first: Vec<f64>,
    own: Vec<f64>,
    are_fields: bool,
}

impl Constants {
    /// The constant as an expression. One number has one field.
    fn named(&mut self, first: f64, own: f64) -> String {
        if !self.are_fields {
            return format!("{first:?}");
        }
        let known = self.first.iter().position(|known| known.to_bits() == first.to_bits());
        let index = known.unwrap_or_else(|| {
            self.first.push(first);
            self.own.push(own);
            self.first.len() - 1
        });
        format!("self.c[{index}]")
    }

    fn value(&self) -> String {
        if self.are_fields { format!("System {{ c: {:?} }}", self.own) } else { "System".into() }
    }
}
