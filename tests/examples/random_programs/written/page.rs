//! The section of `docs/evidence/random-programs.md` on programs as people write them.

use std::fmt::Write as _;

use super::super::tally::{Tally, general};
use super::manner::Manner;

/// What is refused, and what the programs hold, from the counts of all engines.
pub fn section(counts: &Tally) -> String {
    let mut page = format!(
        "\n## As people write them\n\n{}\n| refused | reason |\n|--:|---|\n",
        include_str!("page.md")
    );
    let mut reasons = Tally::default();
    for (reason, count) in counts.under("reason ") {
        reasons.add(general(&reason), count);
    }
    for (reason, count) in reasons.under("") {
        writeln!(page, "| {count} | {reason} |").expect("a string takes all");
    }
    page += "\n| way of writing | written | in programs that agree |\n|---|--:|--:|\n";
    for (manner, _) in Manner::ALL {
        let name = manner.name();
        let (written, agreed) =
            (counts.count(&format!("written {name}")), counts.count(&format!("agreed {name}")));
        writeln!(page, "| {name} | {written} | {agreed} |").expect("a string takes all");
    }
    page
}
