//! Shapes built as a crate beside the workspace, and run.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

use anyhow::{Result, ensure};

use super::beside::Beside;
use super::text::Text;

/// Builds the shapes of these seeds, and makes so many runs of each, side by side; a line for each run.
pub fn run(workspace: &Path, seeds: Range<u64>, runs: u64) -> Result<String> {
    let mut text = include_str!("harness.txt").to_owned();
    let mut calls = String::new();
    for seed in seeds {
        let Text { family, name, coordinates, constraints, declared } = Text::of(seed);
        text += &declared;
        let from = seed * 1_000_000;
        writeln!(
            calls,
            "        scope.spawn(|| all::<{name}, {coordinates}, {constraints}>({family:?}, {from}, {runs}));"
        )?;
    }
    write!(text, "\nfn main() {{\n    std::thread::scope(|scope| {{\n{calls}    }});\n}}\n")?;
    let manifest = format!(
        "[package]\nname = \"mechanisms\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         dalembert = {{ path = {:?} }}\ndalembert-tests = {{ path = {:?}, default-features = false }}\n\n\
         [profile.dev]\nopt-level = 1\ndebug = false\ndebug-assertions = false\nincremental = false\n\n\
         [profile.dev.package.\"*\"]\nopt-level = 2\n",
        workspace.join("runtime"),
        workspace.join("tests")
    );
    let folder = workspace.join("target/mechanisms");
    let beside = Beside { folder: folder.join("batch"), target: folder.join("target") };
    beside.begin(workspace, &manifest)?;
    std::fs::write(beside.folder.join("src/main.rs"), text)?;
    let output = beside.cargo(&["run"])?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Ok(String::from_utf8(output.stdout)?)
}
