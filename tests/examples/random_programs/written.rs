//! Programs as people write them: bodies of physics, composed as text from ways of writing.
//!
//! The reference is the same source without the attribute, compiled beside it: values to the bit, and its
//! difference quotients for the derivatives.

mod curve;
mod draft;
mod form;
mod functions;
pub mod judgement;
mod law;
pub mod manner;
pub mod page;
mod quantity;
pub mod run;
mod scene;
mod source;
mod table;

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::batch::Source;
use super::engine::options;
use super::members::Way;
use super::random::Random;
use super::syntax::view;
use functions::Seen;
use manner::Manner;
pub use source::program;

/// Where the attribute stands in the source.
const ATTRIBUTE: &str = "#[annotated_or_not]";

/// Points of a program.
const POINTS: usize = 3;

/// A program as text.
pub struct Written {
    pub seed: u64,
    /// Its items, the attribute as [`ATTRIBUTE`].
    text: String,
    pub single: bool,
    pub n: usize,
    seen: Seen,
    pub manners: BTreeSet<Manner>,
}

impl Written {
    /// The source under the attribute.
    pub fn annotated(&self, engine: &str) -> String {
        let options = Way::named(engine).map_or_else(|| options(engine), |way| way.options().to_owned());
        self.text.replace(ATTRIBUTE, &format!("#[dalembert::rayleigh_system({options})]"))
    }

    fn plain(&self) -> String {
        self.text.replace(ATTRIBUTE, "")
    }

    /// The points: q, v, u and t, numbers that an f32 holds.
    fn points(&self) -> String {
        let mut random = Random::new(self.seed ^ 0x5eed_0f90_1275);
        let mut entries = |n: usize| -> Vec<f64> {
            (0..n).map(|_| f64::from((random.unit() * 2.4 - 0.9) as f32)).collect()
        };
        let (n, scalar) = (self.n, self.scalar());
        let points: Vec<String> = (0..POINTS)
            .map(|_| format!("({:?}, {:?}, {:?}, {:?})", entries(n), entries(n), entries(1), entries(1)[0]))
            .collect();
        format!(
            "let points: [([{scalar}; {n}], [{scalar}; {n}], [{scalar}; 1], {scalar}); {POINTS}] = [{}];\n",
            points.join(", ")
        )
    }

    fn scalar(&self) -> &'static str {
        if self.single { "f32" } else { "f64" }
    }

    /// The view of an input and a time, where the system takes them.
    fn view(&self) -> Option<&'static str> {
        view(self.seen.input, self.seen.timed.contains(&true))
    }

    /// L, R and f of `system` at (q, v), as a vector of f64.
    fn values(&self, system: &str) -> [Option<String>; 3] {
        let time = self.seen.timed.map(|is_timed| if is_timed { ", t" } else { "" });
        let q = if self.seen.rayleigh_of_both { "q, " } else { "" };
        let u = if self.seen.input { ", u" } else { "" };
        [
            Some(format!("vec![{system}.lagrangian(q, v{}) as f64]", time[0])),
            self.seen.rayleigh.then(|| format!("vec![{system}.rayleigh({q}v{}) as f64]", time[1])),
            self.seen.force.then(|| format!("{system}.force(q, v{u}{}).map(|x| x as f64).to_vec()", time[2])),
        ]
    }

    /// The function that calls all of it.
    fn calls(&self, index: usize, engine: &str) -> String {
        let n = self.n;
        // The runtime's elementary functions are not those of std.
        let own = if engine == "portable" { "annotated" } else { "plain" };
        let of_differences = if self.single { "wide" } else { "plain" };
        let mut text = format!(
            "pub fn run() {{\nlet (s, p, w) = (annotated::system(), {own}::system(), {of_differences}::system());\n\
             {}for (k, (q, v, u, t)) in points.into_iter().enumerate() {{\n\
             let x: Vec<f64> = q.iter().chain(&v).map(|x| *x as f64).collect();\n",
            self.points()
        );
        for (told, system) in [("plain", "p"), ("own", "s")] {
            let values: Vec<String> = self.values(system).into_iter().flatten().collect();
            writeln!(text, "crate::{told}({index}, k, || [{}].concat());", values.join(", "))
                .expect("a string takes all");
        }
        if let Some(view) = self.view() {
            writeln!(text, "let s = s.{view};").expect("a string takes all");
        }
        text += "let (q, v) = (q.into(), v.into());\n";
        let wide = if self.single { "let (u, t) = (u.map(f64::from), f64::from(t));\n" } else { "" };
        text += wide;
        for (name, value) in ["lagrangian", "rayleigh", "force"].into_iter().zip(self.values("w")) {
            let Some(value) = value else { continue };
            writeln!(
                text,
                "let of = |x: &[f64]| -> Vec<f64> {{ let (q, v): ([f64; {n}], [f64; {n}]) = (std::array::from_fn(|i| x[i]), std::array::from_fn(|i| x[{n} + i])); {value} }};\n\
                 crate::{name}({index}, k, &s, &q, &v);\ncrate::slopes(\"slopes\", {index}, k, &x, &of);"
            )
            .expect("a string takes all");
            if name == "force" {
                continue;
            }
            let gradient = if self.single {
                "crate::slopes_of(x, &of).0.remove(0)".to_owned()
            } else {
                format!("crate::{name}_by_both(&s, x)")
            };
            writeln!(text, "crate::slopes(\"curvatures\", {index}, k, &x, &|x| {gradient});")
                .expect("a string takes all");
        }
        text + &format!("crate::verified({index}, k, &s, &q, &v);\n}}\n}}\n")
    }
}

impl Source for Written {
    const HARNESS: &'static str = concat!(include_str!("harness.txt"), include_str!("written/harness.txt"));

    fn coordinates(&self) -> usize {
        self.n
    }

    fn with_macro(&self, index: usize, engine: &str) -> String {
        if let Some(way) = Way::named(engine) {
            return format!(
                "mod p{index} {{\npub mod annotated {{\n{}}}\npub fn run() {{\nlet s = annotated::system();\n{}{}}}\n}}\n",
                self.annotated(engine),
                self.points(),
                way.call(index, self.view())
            );
        }
        let wide = if self.single {
            format!("pub mod wide {{\n{}}}\n", self.plain().replace("f32", "f64"))
        } else {
            String::new()
        };
        format!(
            "mod p{index} {{\npub mod plain {{\n{}}}\n{wide}pub mod annotated {{\n{}}}\n{}}}\n",
            self.plain(),
            self.annotated(engine),
            self.calls(index, engine)
        )
    }

    fn without_macro(&self, index: usize, _engine: &str) -> String {
        let wide = if self.single { self.plain().replace("f32", "f64") } else { String::new() };
        format!("mod p{index} {{\npub mod plain {{\n{}}}\npub mod wide {{\n{wide}}}\n}}\n", self.plain())
    }
}
