//! The page: one section a case, its pictures beside it.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;
use dalembert_examples::picture::{self, Panel};
use dalembert_examples::results;

/// One hard case, as it went.
pub struct Case {
    /// The heading.
    pub title: &'static str,
    /// What breaks other codes, in a sentence or two.
    pub breaks: &'static str,
    /// What this code does.
    pub ours: &'static str,
    /// The head of the table.
    pub head: &'static [&'static str],
    /// Its rows.
    pub rows: Vec<Vec<String>>,
    /// Panels of the picture, two in a row.
    pub panels: Vec<Panel<'static>>,
    /// The quick test, in `tests/tests/hard/`.
    pub test: &'static str,
}

/// Folder of the repository's documents.
fn documents() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("docs")
}

impl Case {
    /// The section.
    pub fn text(&self, name: &str) -> String {
        let mut text =
            format!("## {}\n\n**What breaks.** {}\n\n**Here.** {}\n\n", self.title, self.breaks, self.ours);
        let row = |cells: Vec<&str>| format!("| {} |\n", cells.join(" | "));
        text += &row(self.head.to_vec());
        text += &row(vec!["---"; self.head.len()]);
        for cells in &self.rows {
            text += &row(cells.iter().map(String::as_str).collect());
        }
        if !self.panels.is_empty() {
            let _ = write!(text, "\n![{}](hard-cases/{name}.svg)\n", self.title);
        }
        let _ = write!(text, "\nQuick version: `tests/tests/hard/{}`.\n", self.test);
        text
    }

    /// Writes the picture.
    pub fn draw(&self, name: &str) -> Result<()> {
        if self.panels.is_empty() {
            return Ok(());
        }
        let columns = self.panels.len().min(2);
        let rows = self.panels.len().div_ceil(columns);
        let svg = picture::svg([800 * columns as u32, 550 * rows as u32], columns, &self.panels)?;
        results::save(&documents().join("hard-cases").join(name).with_extension("svg"), &svg)
    }
}

/// Writes the page of all cases.
pub fn write(cases: &[(&str, Case)]) -> Result<PathBuf> {
    let mut text = String::from(
        "# Hard cases\n\n\
         What the rules do where codes break: figures from long runs, written by\n\n\
         ```sh\ncargo run --release -p dalembert-tests --example hard_cases\n```\n\n\
         Each case has a quick version among the tests. All quantities are dimensionless. A step that cannot be taken has an error\n\
         with a name, and leaves the last good state; the tables give it where it happened.\n\n",
    );
    for (name, case) in cases {
        text += &case.text(name);
        text.push('\n');
    }
    text += OTHERS;
    text += ADVERSARIAL;
    let path = documents().join("hard-cases.md");
    results::save(&path, &text)?;
    Ok(path)
}

/// What random and broken input does, and what faults do: from runs of their own.
const ADVERSARIAL: &str = include_str!("adversarial.md");

/// What has tests alone, with nothing to plot.
const OTHERS: &str = "## Also tested\n\n\
| case | what happens | test |\n\
| --- | --- | --- |\n\
| negative damping, z = hr/2m → −1 | grows by (1 + z)/(1 − z); at z = 1 `SingularNewtonMatrix`; past it the root exists and has the wrong sign: choose h < 2m/\\|r\\| | `damping.rs` |\n\
| damping of both signs (van der Pol, μ = 1, 50) | period and amplitude of the cycle to order 2 | `damping.rs` |\n\
| friction written carelessly: `cosh` overflows, 1 − 1 cancels | `NonFinite` of a derivative; `LostPrecision` | `damping.rs` |\n\
| ∂²L/∂v² singular, L linear in v | `DegenerateLagrangian` with its coordinate, at the first step | `singular.rs` |\n\
| \\|q\\|, \\|q\\|^{3/2}, √\\|q\\|, drag \\|v\\|^{3/2} at 0 | `NonFinite` exactly where no derivative exists, roots next to it | `singular.rs` |\n\
| coordinates in units of 2^{∓40} | the same motion to rounding, the same iterations | `scales.rs` |\n\
| h from ±1e-12 to ±1e12 | a step or an error; without friction −h leads back to rounding | `scales.rs` |\n\
| NaN, ±∞, subnormal and huge values in every argument | an error that names the argument, or a finite step | `scales.rs` |\n\
| a user function that panics, at any call | the trajectory holds its last state and goes on bit for bit | `faults.rs` |\n";
