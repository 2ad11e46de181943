//! The page of the study.

use std::fs;
use std::path::PathBuf;

use anyhow::{Result, ensure};

use crate::counts::{Line, lines};
use crate::study::steps::{Tally, WAYS};

fn row(name: &str, tally: &Tally) -> String {
    let Tally { asked, taken, violations, worst, undecided, beyond, refused, within_reach } = tally;
    format!(
        "| {name} | {asked} | {taken} | {violations} | {worst:.1} | {undecided} | {beyond} | {refused} | {within_reach} |\n"
    )
}

fn table(first: &str, names: &[String], of: impl Fn(&Line, &str) -> bool, lines: &[Line]) -> String {
    let mut text = format!(
        "| {first} | asked | taken | violations | largest ratio | decided by rounding | not judged | refused, cold | of these within reach |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|\n"
    );
    for name in names {
        let of = lines.iter().filter(|line| of(line, name));
        text += &row(name, &of.fold(Tally::NONE, |sum, line| sum.plus(line.tally)));
    }
    text
}

/// Writes `docs/evidence/verdicts.md`.
pub fn write() -> Result<PathBuf> {
    let now = lines("now")?;
    ensure!(!now.is_empty(), "there are no counts: run the study first");
    let mut systems: Vec<String> = Vec::new();
    for line in &now {
        if !systems.contains(&line.system) {
            systems.push(line.system.clone());
        }
    }
    let ways = WAYS.map(str::to_owned);
    let mut page = include_str!("page.md").to_owned();
    let seeds = now.iter().map(|line| line.seed);
    let [first, last] = [seeds.clone().min(), seeds.max()].map(Option::unwrap_or_default);
    let Tally { asked, taken, violations, .. } =
        now.iter().fold(Tally::NONE, |sum, line| sum.plus(line.tally));
    page += &format!(
        "## In all\n\nSeeds {first} to {last}: {asked} steps asked for, {taken} taken, **{violations} violations**.\n\n"
    );
    page += "## By way\n\n";
    page += &table("way", &ways, |line, name| WAYS[line.way] == name, &now);
    page += "\n## By system\n\n";
    page += &table("system", &systems, |line, name| line.system == name, &now);
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).with_file_name("docs").join("evidence/verdicts.md");
    fs::write(&path, page)?;
    Ok(path)
}
