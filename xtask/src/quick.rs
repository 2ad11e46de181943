//! `quick`: the tests that belong to edited paths, by the table of CONTRIBUTING.md.

use std::collections::BTreeSet;
use std::env;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use xshell::{Shell, cmd};

use crate::project;

const PAGE: &str = "CONTRIBUTING.md";
const HEADING: &str = "| after an edit in | run | and at length |\n";

/// A row of the table.
#[derive(Debug, PartialEq)]
struct Row {
    /// Paths of folders, which end with `/`, and of files.
    paths: Vec<String>,
    run: Vec<String>,
    at_length: Vec<String>,
}

impl Row {
    /// Whether a path is one of the row's, or stands in one of its folders; a module's file does, beside its
    /// folder.
    fn is_for(&self, path: &str) -> bool {
        self.paths.iter().any(|of| match of.strip_suffix('/') {
            Some(folder) => path
                .strip_prefix(folder)
                .is_some_and(|rest| ["", ".rs"].contains(&rest) || rest.starts_with('/')),
            None => path == of,
        })
    }
}

/// Runs the commands of the rows that the paths belong to, and says what they run at length. Without paths it
/// takes the files that git names as changed.
pub fn run(paths: &[&str]) -> Result<()> {
    let shell = project::shell()?;
    let rows = rows(&project::text(PAGE)?)?;
    let paths = if paths.is_empty() {
        changed(&shell)?
    } else {
        paths.iter().map(from_root).collect::<Result<_>>()?
    };
    ensure!(!paths.is_empty(), "no file is changed: name a path");
    for path in paths.iter().filter(|path| !rows.iter().any(|row| row.is_for(path))) {
        println!("no test of the table in {PAGE} belongs to {path}");
    }
    let chosen: Vec<_> = rows.iter().filter(|row| paths.iter().any(|path| row.is_for(path))).collect();
    for command in once(chosen.iter().flat_map(|row| &row.run)) {
        println!("$ {command}");
        cmd!(shell, "bash -euo pipefail -c {command}").quiet().run()?;
    }
    for command in once(chosen.iter().flat_map(|row| &row.at_length)) {
        println!("and at length: {command}");
    }
    Ok(())
}

/// Commands in their order, each once.
fn once<'r>(commands: impl Iterator<Item = &'r String>) -> impl Iterator<Item = &'r String> {
    let mut seen = BTreeSet::new();
    commands.filter(move |command| seen.insert(*command))
}

/// The files that are changed or new.
fn changed(shell: &Shell) -> Result<Vec<String>> {
    let changed = cmd!(shell, "git diff --name-only HEAD").quiet().read()?;
    let new = cmd!(shell, "git ls-files --others --exclude-standard").quiet().read()?;
    Ok(changed.lines().chain(new.lines()).map(str::to_owned).collect())
}

/// The path from the root of one that the user names from where he is.
fn from_root(path: &&str) -> Result<String> {
    let path = env::current_dir()?.join(path);
    let path = path.canonicalize().unwrap_or(path);
    let from_root = path.strip_prefix(project::root().canonicalize()?);
    let from_root = from_root.with_context(|| format!("{} is not in the repository", path.display()))?;
    Ok(from_root.display().to_string())
}

/// The rows of the table on a page.
fn rows(page: &str) -> Result<Vec<Row>> {
    let table = page.split_once(HEADING).with_context(|| format!("{PAGE} has lost its table of tests"))?.1;
    let quoted = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    let row = |line: &str| {
        let cells: Vec<_> = line.trim_matches('|').split('|').collect();
        let [paths, run, at_length] = cells[..] else {
            bail!("{PAGE}: a row of the table has three cells: {line}")
        };
        Ok(Row {
            paths: quoted(paths).iter().flat_map(|paths| each(paths)).collect(),
            run: quoted(run),
            at_length: quoted(at_length),
        })
    };
    table
        .lines()
        .skip(1)
        .take_while(|line| line.starts_with('|'))
        .flat_map(spread)
        .map(|line| row(&line))
        .collect()
}

/// The rows that a row stands for: one for each of the names in braces that paths and commands share.
fn spread(line: &str) -> Vec<String> {
    let braces = line.split('{').skip(1).filter_map(|rest| rest.split_once('}')).map(|(names, _)| names);
    let of_commands = line.split('|').nth(2).unwrap_or_default();
    let shared =
        braces.map(|names| (names, format!("{{{names}}}"))).find(|(_, braces)| of_commands.contains(braces));
    let Some((names, braces)) = shared else { return vec![line.to_owned()] };
    names.split(',').map(|name| line.replace(&braces, name)).collect()
}

/// The paths that one with names in braces stands for.
fn each(path: &str) -> Vec<String> {
    let parts = path.split_once('{').and_then(|(before, rest)| Some((before, rest.split_once('}')?)));
    let Some((before, (names, after))) = parts else { return vec![path.to_owned()] };
    names.split(',').map(|name| format!("{before}{name}{after}")).collect()
}

/// Paths of the table that do not exist, and packages that no row is for.
pub fn check(shell: &Shell) -> Result<Vec<String>> {
    let rows = rows(&project::text(PAGE)?)?;
    let packages = project::files(shell, "/Cargo.toml")?;
    let packages = packages.iter().filter_map(|manifest| manifest.strip_suffix("Cargo.toml"));
    Ok(wrong(&rows, packages, |path| project::root().join(path).exists()))
}

fn wrong<'p>(
    rows: &[Row],
    packages: impl Iterator<Item = &'p str>,
    exists: impl Fn(&Path) -> bool,
) -> Vec<String> {
    let paths = rows.iter().flat_map(|row| &row.paths).filter(|path| !exists(Path::new(path)));
    let mut found: Vec<_> = paths.map(|path| format!("{PAGE}: {path} does not exist")).collect();
    let tested = |package: &str| rows.iter().any(|row| row.is_for(package));
    found.extend(
        packages.filter(|package| !tested(package)).map(|package| format!("{PAGE}: no row is for {package}")),
    );
    let empty = rows.iter().filter(|row| row.paths.is_empty() || row.run.is_empty());
    found.extend(empty.map(|row| format!("{PAGE}: a row has no paths, or nothing to run: {row:?}")));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "Text.\n\n| after an edit in | run | and at length |\n|---|---|---|\n\
                         | `a/`, `b/src/{x,y}.rs` | `cargo test -p a` | |\n\
                         | the `a/deep/` | `one`, then `two` | `three` |\n\nMore.\n";

    #[test]
    fn rows_are_for_folders_and_files() {
        let rows = rows(TABLE).unwrap();
        let of =
            |path| rows.iter().filter(|row| row.is_for(path)).flat_map(|row| &row.run).collect::<Vec<_>>();
        assert_eq!(of("a/src/lib.rs"), ["cargo test -p a"]);
        assert_eq!(of("a/deep/y.rs"), ["cargo test -p a", "one", "two"]);
        assert_eq!(of("a/deep"), ["cargo test -p a", "one", "two"]);
        assert_eq!([of("b/src/x.rs"), of("b/src/y.rs")].concat(), ["cargo test -p a"; 2]);
        assert_eq!(of("a/deep.rs"), of("a/deep/y.rs"));
        assert!(of("b/src/x.rs.orig").is_empty() && of("ab/c").is_empty());
        assert_eq!(rows[1].at_length, ["three"]);
    }

    #[test]
    fn names_in_braces_that_commands_share_are_rows() {
        let line = "| `{x,y}/{a,b}/` | `test {a,b}` | `long {a,b}` |";
        assert_eq!(
            spread(line),
            ["| `{x,y}/a/` | `test a` | `long a` |", "| `{x,y}/b/` | `test b` | `long b` |"]
        );
        assert_eq!(spread("| `{x,y}/` | `test` | |"), ["| `{x,y}/` | `test` | |"]);
    }

    #[test]
    fn the_table_fits_the_repository() {
        assert_eq!(check(&project::shell().unwrap()).unwrap(), [""; 0]);
    }

    #[test]
    fn paths_that_are_gone_and_packages_without_tests_are_seen() {
        let rows = rows(TABLE).unwrap();
        assert_eq!(wrong(&rows, ["a/", "a/deep/er/"].into_iter(), |_| true), [""; 0]);
        let found = wrong(&rows, ["c/"].into_iter(), |path| path != Path::new("a/deep/"));
        assert_eq!(found, ["CONTRIBUTING.md: a/deep/ does not exist", "CONTRIBUTING.md: no row is for c/"]);
    }
}
