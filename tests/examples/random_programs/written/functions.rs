//! L, R and f of a program.

use super::draft::Draft;
use super::manner::Manner;
use super::scene::Scene;

/// The arguments that a system has beside q and v.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    pub rayleigh: bool,
    /// Whether R takes q.
    pub rayleigh_of_both: bool,
    pub force: bool,
    pub input: bool,
    /// Whether L, R and f take the time.
    pub timed: [bool; 3],
}

impl Draft {
    pub fn lagrangian(&mut self, scene: Scene, seen: &Seen) -> String {
        let (n, scalar) = (self.n, self.scalar);
        let mut lines = Vec::new();
        let q = self.entries("q", &mut lines);
        let v = self.entries("v", &mut lines);
        let mut potentials = Vec::new();
        let displacements = scene.displacements(self, &q, &mut lines);
        for x in &displacements {
            if self.random.chance(75) {
                potentials.push(self.term(x, &mut lines));
            }
        }
        if self.may(Manner::TwoHygienes, 100) {
            potentials.push(self.two_hygienes(&q[0], &mut lines));
        }
        if self.may(Manner::SliceNames, 100) {
            potentials.push(self.by_slice_name(&mut lines));
        }
        if seen.timed[0] {
            potentials.push(format!(
                "{} * (t * {}).cos() * {}",
                self.quantity(0.1, 1.0),
                self.number(0.5, 2.0),
                q[0]
            ));
        }
        let kinetic = self.kinetic(&v, &mut lines);
        let coupling = scene.coupling(self, &q, &v).map(|text| format!(" + {text}")).unwrap_or_default();
        let value = if potentials.is_empty() {
            format!("{kinetic}{coupling}")
        } else if self.random.chance(50) {
            format!("{kinetic}{coupling} - {}", potentials.join(" - "))
        } else {
            let sum = self.local();
            lines.push(format!("let mut {sum} = {};", potentials[0]));
            lines.extend(potentials[1..].iter().map(|term| format!("{sum} += {term};")));
            format!("{kinetic}{coupling} - {sum}")
        };
        self.live.clear();
        let time = if seen.timed[0] { format!(", t: {scalar}") } else { String::new() };
        let body = lines.join("\n");
        format!(
            "pub fn lagrangian(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]{time}) -> {scalar} {{\n{body}\n{value}\n}}"
        )
    }

    /// A curve, in a local if it has some of its own, which others may then hide.
    fn term(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        let mut inner = Vec::new();
        let live = self.live.len();
        let value = self.curve(x, &mut inner);
        self.live.truncate(live);
        if inner.is_empty() && self.random.chance(50) {
            return value;
        }
        let is_block = self.random.chance(25);
        let name = self.local();
        if is_block {
            lines.push(format!("let {name} = {{\n{}\n{value}\n}};", inner.join("\n")));
        } else {
            lines.extend(inner);
            lines.push(format!("let {name} = {value};"));
        }
        name
    }

    /// A local of the macro, and one of its caller's of the same name.
    fn two_hygienes(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        let local = self.local();
        let (a, b) = (self.number(0.5, 1.5), self.number(0.5, 1.5));
        self.callers.push((local.clone(), format!("{local} * {a} + {b}")));
        let first = [format!("let $k = {x} * 1.5;"), format!("let {local} = {x} - 0.25;")];
        let is_turned = self.random.chance(50);
        lines.extend(if is_turned { first.into_iter().rev().collect() } else { Vec::from(first) });
        format!("$f * {local}")
    }

    pub fn rayleigh(&mut self, seen: &Seen) -> String {
        let (n, scalar) = (self.n, self.scalar);
        let mut lines = Vec::new();
        let v = self.entries("v", &mut lines);
        let own = match self.random.below(3) {
            0 => {
                let (sum, w) = (self.local(), self.local());
                lines.push(format!(
                    "let mut {sum}: {scalar} = 0.0;\nfor {w} in v.iter() {{\n    {sum} += {w} * {w};\n}}"
                ));
                format!("({} * {sum})", self.factor(0.05, 0.8))
            }
            1 => format!("({} * {1} * {1} * 0.5)", self.factor(0.05, 0.8), v[0]),
            _ => self.term(&v[0].clone(), &mut lines),
        };
        let q = if seen.rayleigh_of_both { format!("q: [{scalar}; {n}], ") } else { String::new() };
        let by_place = if seen.rayleigh_of_both {
            format!(" * (1.0 + q[0] * q[0]) + {} * v[0]", self.number(0.1, 0.3))
        } else {
            String::new()
        };
        let (time, factor) = if seen.timed[1] {
            (format!(", t: {scalar}"), " * (2.0 + t.sin())")
        } else {
            (String::new(), "")
        };
        self.live.clear();
        format!(
            "pub fn rayleigh(&self, {q}v: [{scalar}; {n}]{time}) -> {scalar} {{\n{}\n{own}{by_place}{factor}\n}}",
            lines.join("\n")
        )
    }

    pub fn force(&mut self, seen: &Seen) -> String {
        let (n, scalar) = (self.n, self.scalar);
        let mut lines = Vec::new();
        let q = self.entries("q", &mut lines);
        let v = self.entries("v", &mut lines);
        if self.may(Manner::EarlyReturns, 40) {
            lines.push(format!("if {} < {} {{\n    return [0.25; {n}];\n}}", v[0], self.number(-1.0, 0.0)));
        }
        let mut entries: Vec<String> = Vec::new();
        for i in 0..n {
            let x = if self.random.chance(50) { q[i].clone() } else { v[i].clone() };
            let term = if self.random.chance(60) {
                self.term(&x, &mut lines)
            } else {
                format!("-{} * {x}", self.quantity(0.1, 1.0))
            };
            entries.push(term);
        }
        if seen.input {
            entries[0] = format!("{} * u[0] + {}", self.factor(0.5, 2.0), entries[0]);
        }
        if seen.timed[2] {
            entries[n - 1] = format!("{} + (t * 0.5).sin() * {}", entries[n - 1], q[0]);
        }
        let value = if self.random.chance(60) {
            format!("[{}]", entries.join(", "))
        } else {
            let f = self.local();
            lines.push(format!("let mut {f}: [{scalar}; {n}] = [0.0; {n}];"));
            lines.extend(entries.iter().enumerate().map(|(i, entry)| format!("{f}[{i}] += {entry};")));
            f
        };
        let input = if seen.input { format!(", u: [{scalar}; 1]") } else { String::new() };
        let time = if seen.timed[2] { format!(", t: {scalar}") } else { String::new() };
        self.live.clear();
        format!(
            "pub fn force(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]{input}{time}) -> [{scalar}; {n}] {{\n{}\n{value}\n}}",
            lines.join("\n")
        )
    }
}
