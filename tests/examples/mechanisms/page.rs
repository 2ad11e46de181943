//! The page of the study.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;

use super::counts::{COLUMNS, Counts, Row};

/// Columns that are rounded to a tenth, or are powers of 10.
const RATIOS: [usize; 3] = [16, 17, 18];

/// Writes `docs/evidence/mechanisms.md` from the counts of all draws.
pub fn write(workspace: &Path, counts: &Path) -> Result<PathBuf> {
    let (now, before) = (Counts::of_folder(&counts.join("now"))?, Counts::of_folder(&counts.join("before"))?);
    let mut page = include_str!("page.md").to_owned();
    let (by_kind, all) = now.by(|(_, kind)| kind);
    let (by_family, _) = now.by(|(family, _)| family);
    let (by_kind_before, _) = before.by(|(_, kind)| kind);
    writeln!(
        page,
        "## In all\n\n{} runs of {} steps, {} of them judged: {} runs off a constraint, {} with another velocity and {} with \
         another momentum than rounding\nexplains, {} steps next to no root. {} runs were refused, of them **{} falsely** from the state \
         alone and {} in a run; {} of {} roots followed\nfrom h = 0 were not those taken.\n",
        all[0], all[2], all[4], all[3], all[5], all[6], all[7], all[10], all[11], all[12], all[9], all[8]
    )?;
    table(&mut page, "By kind of run", "kind", &by_kind)?;
    page.push('\n');
    table(&mut page, "By family of shapes", "family", &by_family)?;
    page.push('\n');
    table(&mut page, "Before", "kind", &by_kind_before)?;
    let path = workspace.join("docs/evidence/mechanisms.md");
    std::fs::write(&path, page)?;
    Ok(path)
}

fn table(page: &mut String, title: &str, of: &str, rows: &BTreeMap<String, Row>) -> Result<()> {
    writeln!(page, "## {title}\n\n| {of} | {} |", COLUMNS.join(" | "))?;
    writeln!(page, "|---|{}", "--:|".repeat(COLUMNS.len()))?;
    for (name, row) in rows {
        let cells = row.iter().enumerate().map(|(k, entry)| match k {
            _ if RATIOS.contains(&k) => format!("{entry:.1}"),
            _ if k + 1 == COLUMNS.len() => format!("{entry:.0e}"),
            _ => entry.to_string(),
        });
        writeln!(page, "| {name} | {} |", cells.collect::<Vec<_>>().join(" | "))?;
    }
    Ok(())
}
