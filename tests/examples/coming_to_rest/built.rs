//! Systems built as a crate beside the workspace, and run.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};

use super::beside::Beside;
use super::counts::{Counts, End};
use super::methods::{self, METHODS};
use super::system::System;

/// Systems of one crate.
const BATCH: u64 = 10;

/// Which systems, and how they are run.
pub struct Draw<'a> {
    /// Texts of systems.
    pub count: u64,
    pub seed: u64,
    /// Systems that read the same, where the constants are fields.
    pub members: u64,
    /// The most methods of each.
    pub most: usize,
    /// In units of time.
    pub time: f64,
    /// The workspace that has the runtime.
    pub workspace: &'a Path,
}

/// Builds and runs the systems.
pub fn run(Draw { count, seed, members, most, time, workspace }: &Draw<'_>) -> Result<Counts> {
    let (count, seed) = (*count, *seed);
    let folder = workspace.join("target/coming_to_rest");
    let mut counts = Counts::default();
    for first in (seed..seed + count).step_by(BATCH as usize) {
        let mut text = include_str!("harness.txt").to_owned();
        let mut calls = String::new();
        for seed in first..(first + BATCH).min(seed + count) {
            let systems = System::all_of(seed, *members);
            text += &methods::module(&systems, &methods::of_system(&systems[0], *most), *time);
            calls += &format!("s{seed}::all(); ");
            counts.systems += systems.len() as u64;
        }
        text += &format!("fn main() {{ {calls} }}\n");
        let printed = built(folder.join(format!("batch-{most}")), workspace, &text)?;
        for line in printed.lines() {
            let mut words = line.split(' ');
            let (end, _, name) = (words.next(), words.next(), words.next());
            let method =
                METHODS.iter().find(|method| Some(method.name) == name).context("an unknown method")?;
            let end = match end {
                Some("ended") => End::After(words.next().context("steps")?.parse()?),
                Some("outside") => End::OutsideTheRange,
                _ => End::Refused,
            };
            if !matches!(end, End::After(_)) {
                println!("{line}");
            }
            counts.add(method.name, &end);
        }
    }
    Ok(counts)
}

/// The output of the program.
fn built(folder: PathBuf, workspace: &Path, text: &str) -> Result<String> {
    let manifest = format!(
        "[package]\nname = \"coming-to-rest\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         dalembert = {{ path = {:?} }}\n\n[profile.dev]\nopt-level = 2\ndebug = false\ndebug-assertions = false\nincremental = false\n",
        workspace.join("runtime")
    );
    let target = folder.join("../target");
    let beside = Beside { folder, target };
    beside.begin(workspace, &manifest)?;
    std::fs::write(beside.folder.join("src/main.rs"), text)?;
    let output = beside.cargo(&["run"])?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Ok(String::from_utf8(output.stdout)?)
}
