//! The page of the study.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;

use super::counts::Counts;

/// Writes `docs/evidence/coming-to-rest.md` from the counts of all draws.
pub fn write(workspace: &Path, counts: &Path) -> Result<PathBuf> {
    let of = |runtime: &str| Counts::of_folder(&counts.join(runtime));
    let (all, now, before) = (of("all")?, of("now")?, of("before")?);
    let mut page = include_str!("page.md").to_owned();
    let [runs, refused, steps, outside] = sum(&all);
    write!(
        page,
        "## Every method, to T = 10⁴\n\n{} systems, {runs} runs of {steps} steps, **{refused} refused**, {outside} beyond the range of h.\n\n\
         | method | runs | refused | beyond the range | steps |\n|---|--:|--:|--:|--:|\n",
        all.systems
    )?;
    for (method, [runs, refused, steps, outside]) in &all.runs {
        writeln!(page, "| {} | {runs} | {refused} | {outside} | {steps} |", spaced(method))?;
    }
    page += include_str!("before.md");
    page += "| method | runs | refused | steps | before: runs | refused |\n|---|--:|--:|--:|--:|--:|\n";
    for (method, [runs, refused, steps, _]) in &now.runs {
        let [runs_before, refused_before, ..] = before.runs.get(method).copied().unwrap_or_default();
        let name = spaced(method);
        writeln!(page, "| {name} | {runs} | {refused} | {steps} | {runs_before} | {refused_before} |")?;
    }
    let ([runs, refused, steps, _], [runs_before, refused_before, ..]) = (sum(&now), sum(&before));
    writeln!(page, "| all | {runs} | {refused} | {steps} | {runs_before} | {refused_before} |")?;
    let path = workspace.join("docs/evidence/coming-to-rest.md");
    std::fs::write(&path, page)?;
    Ok(path)
}

fn spaced(method: &str) -> String {
    method.replace('_', " ")
}

fn sum(counts: &Counts) -> [u64; 4] {
    counts.runs.values().fold([0; 4], |sum, row| std::array::from_fn(|i| sum[i] + row[i]))
}
