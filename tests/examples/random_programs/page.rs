//! `docs/evidence/random-programs.md`, from the counts that runs have left.

use std::fmt::Write;

use super::class::Class;
use super::mutation;
use super::run::{folder, workspace};
use super::tally::{Tally, general};
use super::written;

/// The ways that programs are tried, as files of runs begin, and as the page says it.
const WAYS: [(&str, &str); 18] = [
    ("graph-", "lowered, the graph evaluated"),
    ("compiled-expanded-", "compiled by rustc, `derivatives = expanded`"),
    ("compiled-auto-", "compiled by rustc, `derivatives = auto`"),
    ("compiled-num_dual-", "compiled by rustc, `derivatives = num_dual`"),
    ("compiled-fused-", "compiled by rustc, `multiply_add = fused`"),
    ("compiled-portable-", "compiled by rustc, elementary functions of the runtime (`libm`)"),
    ("compiled-renamed-", "compiled by rustc, every name a word of generated code"),
    ("compiled-one_word-", "compiled by rustc, one name a word of generated code, each word in turn"),
    ("compiled-lanes-", "compiled by rustc, as a force of eight members in lanes, each beside its own run"),
    (
        "compiled-gauss_lanes-",
        "compiled by rustc, eight members by Gauss rules in lanes, each beside its own run",
    ),
    (
        "compiled-midpoint_lanes-",
        "compiled by rustc, eight members by the midpoint rule in lanes, each beside its own run",
    ),
    ("written-expanded-", "as people write them, `derivatives = expanded`"),
    ("written-auto-", "as people write them, `derivatives = auto`"),
    ("written-num_dual-", "as people write them, `derivatives = num_dual`"),
    ("written-fused-", "as people write them, `multiply_add = fused`"),
    ("written-portable-", "as people write them, elementary functions of the runtime (`libm`)"),
    (
        "written-gauss_lanes-",
        "as people write them, eight members by Gauss rules in lanes, each beside its own run",
    ),
    (
        "written-midpoint_lanes-",
        "as people write them, eight members by the midpoint rule in lanes, each beside its own run",
    ),
];

/// How files of runs begin whose programs are counted in a section of their own.
const WRITTEN: &str = "written-";

/// All counts of a way, and whether there are any.
fn merged(way: &str) -> Result<Tally, String> {
    let mut all = Tally::default();
    let runs = folder()?.join("runs");
    for entry in std::fs::read_dir(runs).map_err(|error| error.to_string())? {
        let path = entry.map_err(|error| error.to_string())?.path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(way)) {
            all.merge(&Tally::read(&path).map_err(|error| error.to_string())?);
        }
    }
    Ok(all)
}

/// Writes the page.
pub fn write() -> Result<usize, String> {
    let mut page = String::from(include_str!("page.md"));
    let mut all = Tally::default();
    page += "| tried how | programs | agree | refused | fail | not read |\n|---|--:|--:|--:|--:|--:|\n";
    for (way, said) in WAYS {
        let tally = merged(way)?;
        let [programs, agreed, refused, failed, unread] =
            ["programs", "agreed", "refused", "failed", "unread"].map(|name| tally.count(name));
        if programs > 0 {
            writeln!(page, "| {said} | {programs} | {agreed} | {refused} | {failed} | {unread} |")
                .expect("a string takes all");
        }
        if !way.starts_with(WRITTEN) {
            all.merge(&tally);
        }
    }
    let [compared, near, large, discarded] =
        ["points compared", "points near a branch", "points too large", "discarded"]
            .map(|name| all.count(name));
    let total = (compared + near + large).max(1);
    writeln!(
        page,
        "\nDerivatives were compared at {compared} points. At {near} points ({:.2} %) a branch was too near, at {large} ({:.2} %) a\n\
         derivative on the way was above 10⁷; there the values alone were compared. {discarded} programs more were discarded because\n\
         their plain functions would panic, or rustc refuses them without the macro too.\n",
        100.0 * near as f64 / total as f64,
        100.0 * large as f64 / total as f64,
    )
    .expect("a string takes all");
    page += "## Refused\n\n| programs | reason |\n|--:|---|\n";
    let mut reasons = Tally::default();
    for (reason, count) in all.under("reason ") {
        reasons.add(general(&reason), count);
    }
    for (reason, count) in reasons.under("") {
        writeln!(page, "| {count} | {reason} |").expect("a string takes all");
    }
    page +=
        "\n## What the programs hold\n\n| construct | written | in programs that agree |\n|---|--:|--:|\n";
    for (class, _) in Class::ALL {
        let name = class.name();
        let (written, agreed) = (all.count(&format!("written {name}")), all.count(&format!("agreed {name}")));
        writeln!(page, "| {name} | {written} | {agreed} |").expect("a string takes all");
    }
    page += &written::page::section(&merged(WRITTEN)?);
    page += "\n";
    page += &mutation::table()?;
    let path = workspace().join("docs/evidence/random-programs.md");
    std::fs::write(path, page).map_err(|error| error.to_string())?;
    Ok(0)
}
