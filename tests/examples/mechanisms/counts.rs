//! Counts of runs, kept in files so that those of several draws add up.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result, ensure};
use dalembert_tests::mechanisms::{MOST, MOST_OFF};

/// What is counted of runs, in the order of [`COLUMNS`].
pub type Row = [f64; COLUMNS.len()];

/// Counts, of which the last four are the largest of all runs.
pub const COLUMNS: [&str; 20] = [
    "runs",
    "without a start",
    "steps",
    "off the constraints",
    "judged",
    "velocity wrong",
    "momentum wrong",
    "no root next to it",
    "followed",
    "another root",
    "refused",
    "falsely",
    "falsely, in a run alone",
    "came to rest",
    "gained energy",
    "composed",
    "most off",
    "largest ratio of v",
    "largest ratio of p",
    "largest relative",
];

/// Columns that are sums.
const SUMS: usize = COLUMNS.len() - 4;

/// Columns that have to be 0.
pub const FAULTS: [usize; 7] = [3, 5, 6, 7, 9, 11, 12];

/// Counts of some draws, by families of shapes and by kinds of runs.
#[derive(Default)]
pub struct Counts {
    pub rows: BTreeMap<(String, String), Row>,
}

fn added(sum: &mut Row, row: &Row) {
    for (k, (sum, entry)) in sum.iter_mut().zip(row).enumerate() {
        *sum = if k < SUMS { *sum + entry } else { sum.max(*entry) };
    }
}

impl Counts {
    /// Adds the line of a run; whether something is wrong with it.
    pub fn add(&mut self, line: &str) -> Result<bool> {
        let (counted, _) = line.split_once(" | ").context("a line of a run")?;
        let words: Vec<&str> = counted.split(' ').collect();
        let [
            family,
            kind,
            by,
            started,
            steps,
            off,
            judged,
            velocity,
            momentum,
            relative,
            rootless,
            followed,
            elsewhere,
            refused,
            gained,
            rest,
        ] = words[..]
        else {
            anyhow::bail!("not the line of a run: {line}");
        };
        let flag = |is: bool| f64::from(u8::from(is));
        let number = |word: &str| word.parse::<f64>().with_context(|| format!("{word:?} is no number"));
        let [off, velocity, momentum] = [number(off)?, number(velocity)?, number(momentum)?];
        let row = [
            1.0,
            flag(started == "false"),
            number(steps)?,
            flag(off > MOST_OFF),
            number(judged)?,
            flag(velocity > MOST),
            flag(momentum > MOST),
            number(rootless)?,
            number(followed)?,
            number(elsewhere)?,
            flag(refused != "none"),
            flag(refused == "falsely"),
            flag(refused == "in_run"),
            flag(rest == "true"),
            flag(gained == "true"),
            flag(by == "composed"),
            off,
            velocity,
            momentum,
            number(relative)?,
        ];
        let of = self.rows.entry((family.replace('_', " "), kind.replace('_', " "))).or_default();
        added(of, &row);
        Ok(FAULTS.iter().any(|fault| row[*fault] != 0.0))
    }

    /// Whether no fault was found.
    pub fn is_sound(&self) -> bool {
        self.rows.values().all(|row| FAULTS.iter().all(|fault| row[*fault] == 0.0))
    }

    /// The rows by family, or by kind, and their sum.
    pub fn by(&self, key: impl Fn(&(String, String)) -> &String) -> (BTreeMap<String, Row>, Row) {
        let (mut rows, mut all): (BTreeMap<String, Row>, Row) = Default::default();
        for (of, row) in &self.rows {
            added(rows.entry(key(of).clone()).or_default(), row);
            added(&mut all, row);
        }
        (rows, all)
    }

    /// A line for each family and kind.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for ((family, kind), row) in &self.rows {
            let cells: Vec<String> = row.iter().map(ToString::to_string).collect();
            writeln!(text, "{family};{kind};{}", cells.join(";")).expect("a string takes all");
        }
        text
    }

    /// The counts of all files of a folder.
    pub fn of_folder(folder: &Path) -> Result<Self> {
        let mut counts = Self::default();
        for file in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
            for line in std::fs::read_to_string(file?.path())?.lines() {
                let cells: Vec<&str> = line.split(';').collect();
                ensure!(cells.len() == COLUMNS.len() + 2, "not a row: {line}");
                let mut row = Row::default();
                for (entry, cell) in row.iter_mut().zip(&cells[2..]) {
                    *entry = cell.parse()?;
                }
                added(counts.rows.entry((cells[0].to_owned(), cells[1].to_owned())).or_default(), &row);
            }
        }
        Ok(counts)
    }
}
