//! The tables of the study.

use crate::study::steps::{Row, Tally, WAYS};

fn line(name: &str, tally: &Tally) -> String {
    let Tally { asked, taken, violations, worst, undecided, beyond, refused, within_reach } = tally;
    format!(
        "| {name} | {asked} | {taken} | {violations} | {worst:.1} | {undecided} | {beyond} | {refused} | {within_reach} |\n"
    )
}

/// In all.
pub fn violations(rows: &[Row]) -> u64 {
    rows.iter().flat_map(|(_, _, tallies)| tallies).map(|tally| tally.violations).sum()
}

/// By system, by way to step, and in all.
pub fn table(rows: &[Row]) -> String {
    let head = |first: &str| {
        format!(
            "| {first} | asked | taken | violations | largest ratio | decided by rounding | not judged | refused, cold | of these within reach |\n\
             |---|--:|--:|--:|--:|--:|--:|--:|--:|\n"
        )
    };
    let total =
        |tallies: &mut dyn Iterator<Item = &Tally>| tallies.fold(Tally::NONE, |sum, of| sum.plus(*of));
    let mut text = head("system");
    for (name, n, tallies) in rows {
        text += &line(&format!("{name}, n = {n}"), &total(&mut tallies.iter()));
    }
    text.push('\n');
    text += &head("way");
    for (i, way) in WAYS.iter().enumerate() {
        text += &line(way, &total(&mut rows.iter().map(|(_, _, tallies)| &tallies[i])));
    }
    text += &line("**all**", &total(&mut rows.iter().flat_map(|(_, _, tallies)| tallies)));
    text
}
