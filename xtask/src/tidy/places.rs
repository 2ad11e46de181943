//! The table "I want to add …" of ARCHITECTURE.md: its files are there, name the example of their row by the
//! very word, and are no more than they were. `cargo xtask places` prints how many each row has.

use anyhow::{Context, Result, ensure};

use crate::project;

const PAGE: &str = "ARCHITECTURE.md";
const HEADING: &str = "| to add | files |\n|---|---|\n";

/// Folders that the table abbreviates.
const FOLDERS: [(&str, &str); 3] =
    [("M", "macros/src/rayleigh_system/"), ("R", "runtime/src/"), ("P", "bindings/python/binding/src/")];

/// Rows with an example, by its names, of which each file has one as a word of its own; and how many files
/// there may be.
const EXAMPLES: [(&str, &[&str], usize); 6] = [
    ("a rule,", &["one_sided", "OneSided"], 7),
    ("a function of the block,", &["constraints", "Constraints", "ConstraintGradients"], 10),
    ("one of which values alone are asked,", &["events", "Events", "event_functions"], 7),
    ("a function, as", &["cbrt", "Cbrt", "CubeRoot"], 7),
    ("an option,", &["multiply_add", "fused", "fused_multiply_add"], 10),
    ("a method of runs,", &["blanes_moan_6", "BlanesMoan6"], 6),
];

/// The files of each row: of a row without a name they are those of the row above.
fn rows(page: &str) -> Result<Vec<(String, Vec<String>)>> {
    let (_, table) = page.split_once(HEADING).context("the table is not there")?;
    let mut rows: Vec<(String, Vec<String>)> = Vec::new();
    for line in table.lines().take_while(|line| line.starts_with('|')) {
        let mut cells = line.trim_matches('|').splitn(2, '|').map(str::trim);
        let (name, files) = (cells.next().unwrap_or_default(), cells.next().unwrap_or_default());
        if !name.is_empty() {
            rows.push((name.to_owned(), Vec::new()));
        }
        let (_, all) = rows.last_mut().context("a row without a name is the first")?;
        all.extend(files_of(files));
    }
    Ok(rows)
}

/// The paths in a cell, such as "M: `rules.rs`; R: `rules/{NEW,joint}.rs`".
fn files_of(cell: &str) -> Vec<String> {
    let mut folder = "";
    let mut files = Vec::new();
    for (index, part) in cell.split('`').enumerate() {
        if index % 2 == 0 {
            let named = FOLDERS.iter().find(|(name, _)| part.contains(&format!("{name}:")));
            folder = named.map_or(folder, |(_, folder)| folder);
        } else if part.ends_with(".rs") || part.ends_with('}') || part.ends_with(".pyi") {
            let folder = if part.starts_with("measure/") { "" } else { folder };
            files.extend(spread(part).into_iter().map(|path| format!("{folder}{path}")));
        }
    }
    files
}

/// `a{b,c}.rs` as two.
fn spread(path: &str) -> Vec<String> {
    match path.split_once('{').and_then(|(before, rest)| Some((before, rest.split_once('}')?))) {
        None => vec![path.to_owned()],
        Some((before, (names, after))) => {
            names.split(',').flat_map(|name| spread(&format!("{before}{name}{after}"))).collect()
        }
    }
}

/// Rows that have grown, and files that are not there or do not name the example.
pub fn check() -> Result<Vec<String>> {
    wrong(&rows(&project::text(PAGE)?)?, &|path| project::text(path).ok())
}

fn wrong(rows: &[(String, Vec<String>)], text_of: &dyn Fn(&str) -> Option<String>) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for (beginning, names, most) in EXAMPLES {
        let row = rows.iter().find(|(name, _)| name.starts_with(beginning));
        let (name, files) = row.with_context(|| format!("no row is called {beginning:?}"))?;
        ensure!(!files.is_empty(), "{name}: no file was seen");
        if files.len() > most {
            found.push(format!("{PAGE}: {name}: {} files, and {most} may be", files.len()));
        }
        for file in files.iter().map(|file| file.replace("NEW", names[0])) {
            match text_of(&file) {
                None => found.push(format!("{PAGE}: {name}: {file} is not there")),
                Some(text) if names.iter().any(|example| has_word(&text, example)) => {}
                Some(_) => found.push(format!("{PAGE}: {name}: {file} has none of the words {names:?}")),
            }
        }
    }
    Ok(found)
}

/// Whether the text has the name, and not as a part of a longer one.
fn has_word(text: &str, name: &str) -> bool {
    text.split(|sign: char| !sign.is_alphanumeric() && sign != '_').any(|word| word == name)
}

/// Prints how many files each row has.
pub fn print() -> Result<()> {
    for (name, files) in rows(&project::text(PAGE)?)? {
        println!("{:3}  {name}", files.len());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braces_and_folders_are_spread() {
        assert_eq!(
            files_of("M: `rules.rs`; R: `rules/{NEW,a}.rs`, `lib.rs`; P: `lib.rs` (`offers!`)"),
            [
                "macros/src/rayleigh_system/rules.rs",
                "runtime/src/rules/NEW.rs",
                "runtime/src/rules/a.rs",
                "runtime/src/lib.rs",
                "bindings/python/binding/src/lib.rs",
            ]
        );
    }

    #[test]
    fn a_file_that_is_gone_and_one_that_does_not_name_the_example_are_seen() {
        let rows: Vec<_> = EXAMPLES
            .iter()
            .map(|(beginning, ..)| ((*beginning).to_owned(), vec!["a.rs".to_owned()]))
            .collect();
        let all = "one_sided, Constraints; Events; x.cbrt() is_fused: fused(blanes_moan_6)".to_owned();
        assert_eq!(wrong(&rows, &|_| Some(all.clone())).unwrap(), [""; 0]);
        assert_eq!(wrong(&rows, &|_| None).unwrap().len(), EXAMPLES.len());
        let near = "one_sided_rule onstrain event brt cbrtf Operation functions Fused is_fused lanes_moan_6"
            .to_owned();
        assert_eq!(wrong(&rows, &|_| Some(near.clone())).unwrap().len(), EXAMPLES.len());
        let mut grown = rows;
        grown[0].1 = vec!["a.rs".to_owned(); EXAMPLES[0].2 + 1];
        assert_eq!(wrong(&grown, &|_| Some(all.clone())).unwrap().len(), 1);
    }

    #[test]
    fn the_table_is_true() {
        assert_eq!(check().unwrap(), [""; 0]);
    }
}
