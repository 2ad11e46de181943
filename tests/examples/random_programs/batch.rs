//! Many programs as one crate: built by cargo beside the workspace, run, and read back.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::beside::Beside;
use super::computed::Computed;
use super::engine::options;
use super::members;
use super::point::{Point, points};
use super::syntax::Program;
use super::{print, renamed};

/// What became of a batch.
#[derive(Default)]
pub struct Outcome {
    /// By program and point.
    pub computed: BTreeMap<(usize, usize), Computed>,
    /// Programs that rustc refused, with its words.
    pub errors: BTreeMap<usize, String>,
    /// Those among them that it refuses without the macro too.
    pub not_rust: BTreeSet<usize>,
}

/// A program of a batch.
pub trait Source {
    /// What its module calls.
    const HARNESS: &'static str = include_str!("harness.txt");

    fn coordinates(&self) -> usize;

    /// Its module, with the macro and what calls it.
    fn with_macro(&self, index: usize, engine: &str) -> String;

    /// Its module without the macro.
    fn without_macro(&self, index: usize, engine: &str) -> String;
}

impl Source for Program {
    fn coordinates(&self) -> usize {
        self.n
    }

    fn with_macro(&self, index: usize, engine: &str) -> String {
        match members::Way::named(engine) {
            Some(way) => members::module(self, index, way),
            None => module(self, index, engine),
        }
    }

    fn without_macro(&self, index: usize, engine: &str) -> String {
        let plain = format!("{}{}", print::surroundings(self), print::block(self));
        format!("mod p{index} {{\n{}\n}}\n", named(plain, self, engine))
    }
}

/// What rustc's lints would refuse, the interpreter has an answer to.
const LINTS: &str = "#![allow(arithmetic_overflow, unconditional_panic, overflowing_literals)]";

/// One build finds the programs that fail at the same stage of rustc.
const MOST_BUILDS: usize = 12;

/// So many programs are expanded sooner than the macro is optimised.
const FEW: usize = 50;

/// Where batches are built.
pub struct Workshop {
    beside: Beside,
    workspace: PathBuf,
    /// Features of the runtime.
    features: &'static str,
}

impl Workshop {
    pub fn new(folder: &Path, workspace: &Path, features: &'static str) -> Self {
        let beside = Beside { folder: folder.to_owned(), target: folder.join("../target") };
        Self { beside, workspace: workspace.to_owned(), features }
    }

    /// Builds and runs the programs; those that rustc refuses are taken out and named.
    pub fn run<P: Source>(&self, programs: &[P], engine: &str) -> Result<Outcome, String> {
        let mut outcome = Outcome::default();
        let runtime = self.workspace.join("runtime");
        let mut manifest = format!(
            "[package]\nname = \"random-programs\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
             [dependencies]\ndalembert = {{ path = {runtime:?}, default-features = false, features = [{}] }}\n\n\
             [profile.dev]\nopt-level = 0\ndebug = false\nincremental = false\noverflow-checks = true\n\n",
            self.features,
        );
        if programs.len() > FEW {
            manifest += "[profile.dev.package.\"*\"]\nopt-level = 1\n\n";
            // The macro runs at every batch, the runtime is built once.
            for name in ["syn", "quote", "proc-macro2"] {
                manifest += &format!("[profile.dev.package.{name}]\nopt-level = 3\n\n");
            }
        }
        self.beside.begin(&self.workspace, &manifest).map_err(|error| error.to_string())?;
        for _ in 0..MOST_BUILDS {
            let kept: Vec<usize> =
                (0..programs.len()).filter(|index| !outcome.errors.contains_key(index)).collect();
            match self.built(&crate_text(programs, &kept, engine))? {
                Built::Printed(printed) => {
                    read(&printed, programs, &mut outcome)?;
                    outcome.not_rust = self.not_rust(programs, &outcome.errors, engine)?;
                    return Ok(outcome);
                }
                Built::Refused(errors) => outcome.errors.extend(errors),
            }
        }
        Err("rustc goes on refusing programs".to_owned())
    }

    /// Which of the programs that rustc refuses it refuses without the macro as well.
    fn not_rust<P: Source>(
        &self,
        programs: &[P],
        refused: &BTreeMap<usize, String>,
        engine: &str,
    ) -> Result<BTreeSet<usize>, String> {
        let mut found = BTreeSet::new();
        for _ in 0..MOST_BUILDS {
            let kept: Vec<usize> = refused.keys().copied().filter(|index| !found.contains(index)).collect();
            match self.built(&plain_text(programs, &kept, engine))? {
                Built::Printed(_) => return Ok(found),
                Built::Refused(errors) => found.extend(errors.into_keys()),
            }
        }
        Err("rustc goes on refusing plain programs".to_owned())
    }

    /// Builds and runs a crate.
    fn built(&self, text: &CrateText) -> Result<Built, String> {
        let words = |error: std::io::Error| error.to_string();
        std::fs::write(self.beside.folder.join("src/main.rs"), &text.text).map_err(words)?;
        let build = self.beside.cargo(&["run", "--message-format", "short"]).map_err(words)?;
        if build.status.success() {
            return Ok(Built::Printed(String::from_utf8_lossy(&build.stdout).into_owned()));
        }
        let messages = String::from_utf8_lossy(&build.stderr).into_owned();
        let mut errors = BTreeMap::new();
        for message in messages.lines().filter(|line| line.contains(": error")) {
            let line = message.split(':').nth(1).and_then(|line| line.parse::<usize>().ok());
            let owner = line.and_then(|line| text.lines.iter().rposition(|(start, _)| *start <= line));
            if let Some(owner) = owner {
                let words = message.split_once("error").map_or(message, |(_, words)| words);
                errors.entry(text.lines[owner].1).or_insert_with(|| format!("error{words}"));
            }
        }
        if errors.is_empty() { Err(messages) } else { Ok(Built::Refused(errors)) }
    }
}

/// What became of a crate.
enum Built {
    /// What it printed.
    Printed(String),
    /// The programs that rustc refuses, with its words.
    Refused(BTreeMap<usize, String>),
}

/// The source of a crate, and the lines at which its programs begin.
struct CrateText {
    text: String,
    lines: Vec<(usize, usize)>,
}

/// The programs with the macro, and what calls them.
fn crate_text<P: Source>(programs: &[P], kept: &[usize], engine: &str) -> CrateText {
    let mut text = format!("{LINTS}\n{}", P::HARNESS);
    let mut lines = Vec::new();
    for &index in kept {
        lines.push((text.lines().count() + 1, index));
        text += &programs[index].with_macro(index, engine);
    }
    text += "fn main() {\n    std::panic::set_hook(Box::new(|_| {}));\n";
    for index in kept {
        writeln!(text, "    p{index}::run();").expect("a string takes all");
    }
    CrateText { text: text + "}\n", lines }
}

/// The programs without the macro.
fn plain_text<P: Source>(programs: &[P], kept: &[usize], engine: &str) -> CrateText {
    let mut text = format!("{LINTS}\nfn main() {{}}\n");
    let mut lines = Vec::new();
    for &index in kept {
        lines.push((text.lines().count() + 1, index));
        text += &programs[index].without_macro(index, engine);
    }
    CrateText { text, lines }
}

/// The text, under other names if the engine says so.
fn named(text: String, program: &Program, engine: &str) -> String {
    match renamed::by(engine) {
        Some(rename) => rename(&text, program.seed),
        None => text,
    }
}

fn module(program: &Program, index: usize, engine: &str) -> String {
    let n = program.n;
    let scalar = if program.single { "f32" } else { "f64" };
    let options = options(engine);
    let system = format!(
        "{}#[dalembert::rayleigh_system({options})]\n{}",
        print::surroundings(program),
        print::block(program)
    );
    let mut text = format!("mod p{index} {{\n{}\n", named(system, program, engine));
    writeln!(text, "pub fn run() {{\nlet s = system();").expect("a string takes all");
    let arrays: Vec<String> =
        points(program).iter().map(|Point { q, v, u, t }| format!("({q:?}, {v:?}, {u:?}, {t:?})")).collect();
    let m = program.inputs;
    writeln!(text, "let points: [([{scalar}; {n}], [{scalar}; {n}], [{scalar}; {m}], {scalar}); {}] = [{}];\nfor (k, (q, v, u, t)) in points.into_iter().enumerate() {{",
        arrays.len(),
        arrays.join(", ")
    )
    .expect("a string takes all");
    let time = program.timed.map(|is_timed| if is_timed { ", t" } else { "" });
    let mut plain = format!("let mut plain = vec![s.lagrangian(q, v{}) as f64];\n", time[0]);
    if let Some((of_both, _)) = &program.rayleigh {
        let q = if *of_both { "q, " } else { "" };
        writeln!(plain, "plain.push(s.rayleigh({q}v{}) as f64);", time[1]).expect("a string takes all");
    }
    if program.force.is_some() {
        let input = if m > 0 { ", u" } else { "" };
        writeln!(plain, "plain.extend(s.force(q, v{input}{}).map(|x| x as f64));", time[2])
            .expect("a string takes all");
    }
    writeln!(text, "crate::plain({index}, k, || {{ {plain} plain }});").expect("a string takes all");
    text += "let (q, v) = (q.into(), v.into());\n";
    if let Some(view) = program.view() {
        writeln!(text, "let s = s.{view};").expect("a string takes all");
    }
    writeln!(text, "crate::lagrangian({index}, k, &s, &q, &v);").expect("a string takes all");
    if program.rayleigh.is_some() {
        writeln!(text, "crate::rayleigh({index}, k, &s, &q, &v);").expect("a string takes all");
    }
    if program.force.is_some() {
        writeln!(text, "crate::force({index}, k, &s, &q, &v);").expect("a string takes all");
    }
    text + "}\n}\n}\n"
}

fn read<P: Source>(printed: &str, programs: &[P], outcome: &mut Outcome) -> Result<(), String> {
    for line in printed.lines() {
        let mut words = line.split(' ');
        let mut word = || words.next().unwrap_or_default();
        let tag = word().to_owned();
        let (index, point) = (word().parse(), word().parse());
        let (Ok(index), Ok(point)) = (index, point) else { return Err(format!("not understood: {line}")) };
        let numbers: Option<Vec<f64>> =
            words.map(|word| u64::from_str_radix(word, 16).ok().map(f64::from_bits)).collect();
        let Some(numbers) = numbers else { return Err(format!("not understood: {line}")) };
        let n = programs.get(index).map_or(0, Source::coordinates);
        let computed = outcome.computed.entry((index, point)).or_default();
        let (first, rest) = numbers.split_at(numbers.len().min(1));
        match tag.as_str() {
            "lanes" => computed.lanes = (!numbers.is_empty()).then_some(numbers),
            "plain" => computed.plain = (!numbers.is_empty()).then_some(numbers),
            "own" => computed.own = (!numbers.is_empty()).then_some(numbers),
            "slopes" => computed.slopes.push(numbers),
            "curvatures" => computed.curvatures.push(numbers),
            "verified" => computed.is_told = numbers == [1.0],
            "gradient" => computed.values.push(("gradient", first.to_vec())),
            "derivatives" => {
                computed.values.push(("derivatives", first.to_vec()));
                let (gradient, second) = rest.split_at(2 * n);
                computed.gradients.push(gradient.to_vec());
                computed.hessians.push(symmetric(second, n));
            }
            "force" => {
                let (value, jacobian) = numbers.split_at(n);
                computed.values.push(("force", value.to_vec()));
                // Column by column: ∂fᵢ/∂xⱼ at i + n j.
                computed
                    .gradients
                    .extend((0..n).map(|i| (0..2 * n).map(|j| jacobian[i + n * j]).collect::<Vec<_>>()));
            }
            _ => return Err(format!("not understood: {line}")),
        }
    }
    Ok(())
}

/// The Hessian by (q, v) from the columns of its blocks.
fn symmetric(blocks: &[f64], n: usize) -> Vec<f64> {
    let block = |k: usize, i: usize, j: usize| blocks[k * n * n + i + n * j];
    let entry = |i: usize, j: usize| match (i < n, j < n) {
        (true, true) => block(0, i, j),
        (true, false) => block(1, i, j - n),
        (false, true) => block(1, j, i - n),
        (false, false) => block(2, i - n, j - n),
    };
    (0..4 * n * n).map(|k| entry(k / (2 * n), k % (2 * n))).collect()
}
