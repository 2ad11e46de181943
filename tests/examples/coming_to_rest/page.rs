//! The page of the study.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;

use super::counts::Counts;

/// Writes `docs/coming-to-rest.md` from the counts of all draws.
pub fn write(workspace: &Path, counts: &Path) -> Result<PathBuf> {
    let [now, before] = ["now", "before"].map(|runtime| Counts::of_folder(&counts.join(runtime)));
    let (now, before) = (now?, before?);
    let mut page = include_str!("page.md").to_owned();
    page += "| method | runs | refused | steps | before: runs | refused |\n|---|--:|--:|--:|--:|--:|\n";
    let mut all = [0; 5];
    for (method, [runs, refused, steps]) in &now.runs {
        let [runs_before, refused_before, _] = before.runs.get(method).copied().unwrap_or_default();
        let row = [*runs, *refused, *steps, runs_before, refused_before];
        for (sum, count) in all.iter_mut().zip(row) {
            *sum += count;
        }
        write_row(&mut page, method, row);
    }
    write_row(&mut page, "all", all);
    let path = workspace.join("docs/coming-to-rest.md");
    std::fs::write(&path, page)?;
    Ok(path)
}

fn write_row(page: &mut String, name: &str, [runs, refused, steps, before, refused_before]: [u64; 5]) {
    let name = name.replace('_', " ");
    writeln!(page, "| {name} | {runs} | {refused} | {steps} | {before} | {refused_before} |")
        .expect("a string takes all");
}
