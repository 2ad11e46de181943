//! Systems built as a crate beside the workspace, and run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};

use super::beside::Beside;
use super::methods::{self, METHODS};
use super::system::System;

/// Systems of one crate.
const BATCH: u64 = 10;

/// Builds and runs so many systems from `seed` on; how many runs were refused.
pub fn run(count: u64, seed: u64, most: usize, time: f64) -> Result<usize> {
    let workspace =
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().context("the tests stand in a workspace")?;
    let folder = workspace.join("target/coming_to_rest");
    let mut counts: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for first in (seed..seed + count).step_by(BATCH as usize) {
        let systems: Vec<System> = (first..(first + BATCH).min(seed + count)).map(System::of).collect();
        let mut text = include_str!("harness.txt").to_owned();
        let mut calls = String::new();
        for system in &systems {
            let methods = methods::of_system(system, most);
            text += &methods::module(system, &methods, time);
            calls += &format!("s{}::all(); ", system.seed);
        }
        text += &format!("fn main() {{ {calls} }}\n");
        let printed = built(folder.join(format!("batch-{most}")), workspace, &text)?;
        for line in printed.lines() {
            let mut words = line.split(' ');
            let (end, _, name) = (words.next(), words.next(), words.next());
            let method =
                METHODS.iter().find(|method| Some(method.name) == name).context("an unknown method")?;
            let [runs, refused, steps] = counts.entry(method.name).or_default();
            *runs += 1;
            match end {
                Some("ended") => *steps += words.next().and_then(|word| word.parse().ok()).unwrap_or(0),
                _ => {
                    *refused += 1;
                    println!("{line}");
                }
            }
        }
    }
    let mut all = 0;
    for (method, [runs, refused, steps]) in &counts {
        println!("{method}: {runs} runs, {refused} refused, {steps} steps");
        all += refused;
    }
    Ok(all)
}

/// The output of the program.
fn built(folder: PathBuf, workspace: &Path, text: &str) -> Result<String> {
    let manifest = format!(
        "[package]\nname = \"coming-to-rest\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         dalembert = {{ path = {:?} }}\n\n[profile.dev]\nopt-level = 2\ndebug = false\nincremental = false\n",
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
