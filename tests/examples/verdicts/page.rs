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

fn all(lines: &[Line]) -> Tally {
    lines.iter().fold(Tally::NONE, |sum, line| sum.plus(line.tally))
}

/// Writes `docs/verdicts.md`.
pub fn write() -> Result<PathBuf> {
    let (now, before) = (lines("now")?, lines("before")?);
    ensure!(!now.is_empty() && !before.is_empty(), "there are no counts: run the study first");
    let mut systems: Vec<String> = Vec::new();
    for line in &now {
        if !systems.contains(&line.system) {
            systems.push(line.system.clone());
        }
    }
    let ways = WAYS.map(str::to_owned);
    let mut page = include_str!("page.md").to_owned();
    let seeds = |lines: &[Line]| {
        let seeds = lines.iter().map(|line| line.seed);
        let [first, last] = [seeds.clone().min(), seeds.max()].map(Option::unwrap_or_default);
        format!("{first} to {last}")
    };
    let [of_now, of_before] = [&now, &before].map(|lines| all(lines));
    let share = |tally: &Tally| 1e6 * tally.violations as f64 / tally.taken as f64;
    page += &format!(
        "## In all\n\n\
         | runtime | seeds | asked | taken | violations | of a million taken |\n|---|---|--:|--:|--:|--:|\n\
         | this one | {} | {} | {} | {} | {:.2} |\n\
         | the control, commit 7768890 | {} | {} | {} | {} | {:.2} |\n\n",
        seeds(&now),
        of_now.asked,
        of_now.taken,
        of_now.violations,
        share(&of_now),
        seeds(&before),
        of_before.asked,
        of_before.taken,
        of_before.violations,
        share(&of_before),
    );
    page += "## By way\n\n";
    page += &table("way", &ways, |line, name| WAYS[line.way] == name, &now);
    page += "\n## By system\n\n";
    page += &table("system", &systems, |line, name| line.system == name, &now);
    page += "\n## The control, by way\n\n";
    page += &table("way", &ways, |line, name| WAYS[line.way] == name, &before);
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).with_file_name("docs").join("verdicts.md");
    fs::write(&path, page)?;
    Ok(path)
}
