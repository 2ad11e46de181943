//! The page: one section a case, its pictures beside it.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use dalembert_examples::picture::{self, Panel};
use dalembert_examples::results;

use crate::text;

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
    /// The quick test, in `tests/tests/rules/hard/` or, with a folder, in `tests/tests/`.
    pub test: &'static str,
}

/// Folder of the repository's documents.
pub fn documents() -> PathBuf {
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
        let folder = if self.test.contains('/') { "" } else { "rules/hard/" };
        let _ = write!(text, "\nQuick version: `tests/tests/{folder}{}`.\n", self.test);
        text
    }

    /// Writes the picture to `folder`.
    pub fn draw(&self, name: &str, folder: &Path) -> Result<()> {
        if self.panels.is_empty() {
            return Ok(());
        }
        let columns = self.panels.len().min(2);
        let rows = self.panels.len().div_ceil(columns);
        // As wide as a page shows them, about: its text stays legible.
        let width = if columns == 1 { 800 } else { 620 };
        let svg = picture::svg([width * columns as u32, 580 * rows as u32], columns, &self.panels)?;
        results::save(&folder.join(name).with_extension("svg"), &svg)
    }
}

const HEAD: &str = "# Hard cases\n\n\
     What the rules do where codes break. All figures and pictures are of one run, of the code as it was then, by\n\n\
     ```sh\ncargo study hard_cases\n```\n\n\
     It takes some minutes of one core.\n\n\
     Each case has a quick version among the tests. All quantities are dimensionless. A step that cannot be taken returns a named\n\
     `StepError` and leaves the last good state; the tables say which error, and where.\n\n";

/// Writes the page of all cases, and their pictures.
pub fn write(cases: &[(&str, Case)]) -> Result<PathBuf> {
    let mut page = String::from(HEAD);
    for (name, case) in cases {
        page += &case.text(name);
        page.push('\n');
        case.draw(name, &documents().join("hard-cases"))?;
    }
    page += &text::without_figures();
    save(&page)
}

/// Writes the page with the figures that it has.
pub fn write_text() -> Result<PathBuf> {
    let path = documents().join("hard-cases.md");
    let page = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let figures = page.split_once("\n## ").and_then(|(_, rest)| rest.split_once(text::FIRST_HEADING));
    let (figures, _) =
        figures.with_context(|| format!("{} has no figures: run all cases", path.display()))?;
    save(&format!("{HEAD}## {figures}{}", text::without_figures()))
}

fn save(page: &str) -> Result<PathBuf> {
    let path = documents().join("hard-cases.md");
    results::save(&path, page)?;
    Ok(path)
}
