//! Mistakes put back: the macro's source with one of them, and how many programs it takes to find it.

use std::fmt::Write;
use std::process::Command;
use std::sync::OnceLock;

use super::rebuilt::{self, Edit};
use super::run::{folder, workspace};

/// Programs tried at most, and the first of them: after the oldest those that know ranges to the bounds of
/// their types.
const PROGRAMS: [[&str; 2]; 2] = [["8000", "1"], ["16000", "20000001"]];

/// A mistake, as edits of `macros/src/rayleigh_system`, each of which asks [`is_made`] whether it is in
/// force.
struct Mutation {
    mistake: &'static str,
    edits: &'static [Edit],
}

/// The number of the mistake that a rebuilt study makes, from its environment.
const VARIABLE: &str = "MISTAKE";

/// Whether the mistake of this number is in force.
#[allow(dead_code, reason = "called by the edited source alone")]
pub fn is_made(number: usize) -> bool {
    static MADE: OnceLock<Option<usize>> = OnceLock::new();
    *MADE.get_or_init(|| std::env::var(VARIABLE).ok().and_then(|text| text.parse().ok())) == Some(number)
}

const fn edit(file: &'static str, old: &'static str, new: &'static str) -> Edit {
    Edit { file, old, new }
}

/// Those that were once made, and after them some that might be.
const MUTATIONS: &[Mutation] = &[
    Mutation {
        mistake: "a name in a pattern matches everything, a constant's and a variant's too",
        edits: &[edit(
            "lower/pattern/matching.rs",
            "let is_small = name.ident",
            "let is_small = crate::mutation::is_made(0) || name.ident",
        )],
    },
    Mutation {
        mistake: "`#[cfg]` inside the block is ignored",
        edits: &[edit(
            "conditions.rs",
            "if [\"cfg\", \"cfg_attr\"]",
            "if !crate::mutation::is_made(1) && [\"cfg\", \"cfg_attr\"]",
        )],
    },
    Mutation {
        mistake: "casts between integers do not wrap",
        edits: &[edit(
            "lower/integer/arithmetic.rs",
            "match ty.wrapped(value) {\n            Some(value) => self.integer(at, value, Some(ty)),",
            "match ty.wrapped(value) {\n            Some(_) if crate::mutation::is_made(2) => self.integer(at, value, None),\n            Some(value) => self.integer(at, value, Some(ty)),",
        )],
    },
    Mutation {
        mistake: "`saturating_sub` stops at 0",
        edits: &[edit(
            "lower/integer/arithmetic.rs",
            "\"saturating\" => exact",
            "\"saturating\" if crate::mutation::is_made(3) => exact.map(|exact| exact.max(0)),\n                    \"saturating\" => exact",
        )],
    },
    Mutation {
        mistake: "an `f32` is widened as if it had been an f64",
        edits: &[edit(
            "lower/expression.rs",
            "if is_float && !suffix.is_empty() && self.scalar != suffix {",
            "if is_float && !suffix.is_empty() && self.scalar != suffix && !crate::mutation::is_made(4) {",
        )],
    },
    Mutation {
        mistake: "`by_ref` does not advance its iterator",
        edits: &[edit(
            "lower/sequence.rs",
            "let entries: Vec<Value> = match (name.as_str(), &arguments[..]) {",
            "let entries: Vec<Value> = match (name.as_str(), &arguments[..]) {\n            (\"by_ref\", []) if crate::mutation::is_made(5) => entries,",
        )],
    },
    Mutation {
        mistake: "what stands right of `&&` and `||` always happens",
        edits: &[
            edit(
                "lower/operator.rs",
                "Truth::Known(a) if a != is_and => {",
                "Truth::Known(a) if a != is_and => {\n                    if crate::mutation::is_made(6) {\n                        right_side(self)?;\n                    }",
            ),
            edit(
                "lower/operator.rs",
                "let decided = |_: &mut Self| Ok(Value::Truth(Truth::Known(!is_and)));",
                "if crate::mutation::is_made(6) {\n                        let Value::Truth(b) = right_side(self)? else { return refuse(binary, \"no condition\") };\n                        let (a, graph) = (Truth::Where(a), &mut self.graph);\n                        return Ok(Value::Truth(if is_and { a.and(graph, b) } else { a.or(graph, b) }));\n                    }\n                    let decided = |_: &mut Self| Ok(Value::Truth(Truth::Known(!is_and)));",
            ),
        ],
    },
    Mutation {
        mistake: "the index of a compound assignment runs twice",
        edits: &[edit(
            "lower/operator.rs",
            "let place = self.place(left)?;\n            let left_value",
            "if crate::mutation::is_made(7) {\n                self.place(left)?;\n            }\n            let place = self.place(left)?;\n            let left_value",
        )],
    },
    Mutation {
        mistake: "a closed range ends before its end",
        edits: &[edit(
            "lower/access.rs",
            "if is_closed && range.end.is_some() {",
            "if is_closed && range.end.is_some() && !crate::mutation::is_made(8) {",
        )],
    },
    Mutation {
        mistake: "a name means the outermost of its locals",
        edits: &[edit(
            "lower.rs",
            "self.locals.iter().rev().find(|(known, _)| *known == name).map(|(_, value)| value)",
            "if crate::mutation::is_made(9) {\n            return self.locals.iter().find(|(known, _)| *known == name).map(|(_, value)| value);\n        }\n        self.locals.iter().rev().find(|(known, _)| *known == name).map(|(_, value)| value)",
        )],
    },
    Mutation {
        mistake: "an early return is taken where it is not",
        edits: &[edit(
            "lower/call.rs",
            "Returned::Where(condition, value) => self.select(at, condition, value, tail),",
            "Returned::Where(condition, value) if crate::mutation::is_made(10) => self.select(at, condition, tail, value),\n            Returned::Where(condition, value) => self.select(at, condition, value, tail),",
        )],
    },
    Mutation {
        mistake: "the second derivative of sin has the wrong sign",
        edits: &[edit(
            "differentiate/partials.rs",
            "Function::Sin => (",
            "Function::Sin if crate::mutation::is_made(11) => (graph.function(Function::Cos, x), y),\n        Function::Sin => (",
        )],
    },
    Mutation {
        mistake: "a closed range to the largest integer is empty",
        edits: &[edit(
            "lower/access.rs",
            "let Some(behind) = end.value.checked_add(1) else {",
            "let wrapped = crate::mutation::is_made(12).then_some(end.value.wrapping_add(1));\n            let Some(behind) = end.value.checked_add(1).or(wrapped) else {",
        )],
    },
];

/// Makes sure that the macro's source still holds what each mistake replaces.
pub fn are_current() -> Result<(), String> {
    let edits = MUTATIONS.iter().flat_map(|mutation| mutation.edits);
    edits.copied().try_for_each(|edit| {
        let path = workspace().join("macros/src/rayleigh_system").join(edit.file);
        let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", edit.file))?;
        edit.made_in(&text).map(drop)
    })
}

/// Puts each mistake back in turn; the number of those that no program shows.
pub fn try_all() -> Result<usize, String> {
    let (mut missed, mut rows) = (0, String::new());
    let edits: Vec<Edit> = MUTATIONS.iter().flat_map(|mutation| mutation.edits).copied().collect();
    let study = rebuilt::study(&workspace().join("macros/src"), &edits)?;
    for (number, Mutation { mistake, .. }) in MUTATIONS.iter().enumerate() {
        let (mut tried, mut is_found) = (0, false);
        for [count, first] in PROGRAMS {
            let output = Command::new(&study)
                .args(["until", count, first])
                .env(VARIABLE, number.to_string())
                .output()
                .map_err(|error| error.to_string())?;
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let (count, smallest) = text.split_once('\n').unwrap_or((&text, ""));
            tried += count.trim().parse::<u64>().map_err(|error| format!("{count}: {error}"))?;
            is_found = !smallest.trim().is_empty();
            println!("{mistake}: {tried}\n{smallest}");
            if is_found {
                break;
            }
        }
        missed += usize::from(!is_found);
        let found = if is_found { "" } else { "not found in" };
        writeln!(rows, "| {mistake} | {found} {tried} |").expect("a string takes all");
        std::fs::write(folder()?.join("mutations.md"), &rows).map_err(|error| error.to_string())?;
    }
    Ok(missed)
}

/// The table for the page.
pub fn table() -> Result<String, String> {
    let rows = std::fs::read_to_string(folder()?.join("mutations.md")).unwrap_or_default();
    Ok(format!(
        "## What it found\n\n{}\n## Mistakes put back\n\nThe study rebuilds itself with the macro's source edited, and tries programs until one fails.\n\n\
         | mistake | programs until it is found |\n|---|--:|\n{rows}",
        include_str!("found.md")
    ))
}
