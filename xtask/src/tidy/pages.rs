//! The README's figures are those of the pages that they are copied from, and dependencies that pages name
//! are there.

use anyhow::{Context, Result, ensure};
use xshell::Shell;

use crate::project;

const HEADING: &str = "| scene | n | by hand, ns | generated, ns | generated / by hand |";

/// The README's columns of the rows of scenes in the table of speeds.
fn rows_of_scenes(page: &str) -> Result<Vec<String>> {
    let table = page.split_once(HEADING).context("the table of speeds is gone")?.1;
    let scenes = ["ring", "double pendulum", "FPUT chain", "spring chain", "pendulum chain", "arm"];
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let cells = rows.map(|row| row.split('|').map(str::trim).skip(1).take(5).collect::<Vec<_>>());
    Ok(cells.filter(|cells| scenes.contains(&cells[0])).map(|cells| cells.join(" | ")).collect())
}

const LONG_RUN: &str = "| µs per unit of time, with the energy within | 4e-3 | 1e-4 | 1e-6 |";
const LONG_RUN_OF_PAGE: &str = "| 4e-3, T = 200 | 4e-3, T = 2000 | 4e-3, T = 20000 | 1e-4, T = 200 |";

/// Claims of the README that are not so: rows of its tables that are not those of their pages, which programs
/// print, and a dependency that a reader would not find.
pub fn check(shell: &Shell) -> Result<Vec<String>> {
    let readme = project::text("README.md")?;
    let mut found = differences(&readme, &project::text("docs/performance.md")?)?;
    found.extend(other_long_runs(&readme, &project::text("docs/speed-against-error.md")?)?);
    found.extend(other_steps_in_c(&readme, &project::text("docs/evidence/casadi.md")?)?);
    for page in project::files(shell, ".md")? {
        found.extend(dependencies_not_found(&page, &project::text(&page)?)?);
    }
    Ok(found)
}

/// The cells of the table below the heading that has this text.
fn table<'a>(page: &'a str, heading: &str) -> Result<Vec<Vec<&'a str>>> {
    let table = page.split_once(heading).with_context(|| format!("the table {heading} is gone"))?.1;
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    Ok(rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect()).collect())
}

/// Rows of the README's long run that are not those of the page up to its last time.
fn other_long_runs(readme: &str, page: &str) -> Result<Vec<String>> {
    let (rows, page) = (table(readme, LONG_RUN)?, table(page, LONG_RUN_OF_PAGE)?);
    ensure!(rows.len() > 3 && page.len() > rows.len(), "{} and {} rows", rows.len(), page.len());
    let last =
        |row: &Vec<&str>| [0, 3, 6, 9].map(|cell| row.get(cell).copied().unwrap_or_default().to_owned());
    let page: Vec<_> = page.iter().map(last).collect();
    let other = rows.iter().filter(|row| !page.iter().any(|of| of[..] == row[..]));
    Ok(other
        .map(|row| format!("README.md: not in docs/speed-against-error.md: {}", row.join(" | ")))
        .collect())
}

/// Rows of the README's steps in C that do not begin those of their page.
fn other_steps_in_c(readme: &str, page: &str) -> Result<Vec<String>> {
    let (rows, page) =
        (table(readme, "| | step, ns | CasADi | ratio |")?, table(page, "| | step, ns | CasADi | ratio | ")?);
    ensure!(rows.len() > 3, "{} rows", rows.len());
    let other = rows.iter().filter(|row| !page.iter().any(|of| of.starts_with(row)));
    Ok(other.map(|row| format!("README.md: not in docs/evidence/casadi.md: {}", row.join(" | "))).collect())
}

/// Dependencies on this project's crates that lead to none of them from a project beside a clone, and
/// versions asked for without a path before the crates have a public address.
fn dependencies_not_found(page: &str, text: &str) -> Result<Vec<String>> {
    let is_published = project::text("Cargo.toml")?.lines().any(|line| line.starts_with("repository = "));
    let lines = text.lines().map(str::trim_start);
    let asked = lines.filter(|line| line.starts_with("dalembert") && line.contains(" = "));
    let is_there = |line: &&str| {
        let name = line.split(' ').next().unwrap_or_default();
        let Some((_, path)) = line.split_once("path = \"../dalembert/") else { return is_published };
        let manifest = format!("{}/Cargo.toml", path.split('"').next().unwrap_or_default());
        project::text(manifest).is_ok_and(|manifest| manifest.contains(&format!("name = \"{name}\"\n")))
    };
    let missing = asked.filter(|line| !is_there(line));
    Ok(missing.map(|line| format!("{page}: a stranger does not find {line}")).collect())
}

fn differences(readme: &str, performance: &str) -> Result<Vec<String>> {
    let (mut rows, page) = (rows_of_scenes(readme)?, rows_of_scenes(performance)?);
    ensure!(rows.len() == 6 && page.len() == 6, "{} and {} rows of six", rows.len(), page.len());
    rows.retain(|row| !page.contains(row));
    Ok(rows.iter().map(|row| format!("README.md: not in docs/performance.md: {row}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_readme_has_the_speeds_of_their_page() {
        assert_eq!(check(&project::shell().unwrap()).unwrap(), [""; 0]);
    }

    #[test]
    fn a_figure_that_is_another_is_seen() {
        let readme = project::text("README.md").unwrap();
        let other = readme.replacen("| ring | 2 | ", "| ring | 2 | 1", 1);
        assert_eq!(differences(&other, &readme).unwrap().len(), 1);
    }

    #[test]
    fn another_long_run_is_seen() {
        let [readme, page] =
            ["README.md", "docs/speed-against-error.md"].map(|page| project::text(page).unwrap());
        assert_eq!(other_long_runs(&readme, &page).unwrap(), [""; 0]);
        let other = readme.replacen("| heyoka | 1", "| heyoka | 2", 1);
        assert_eq!(other_long_runs(&other, &page).unwrap().len(), 1);
    }

    #[test]
    fn another_step_in_c_is_seen() {
        let [readme, page] =
            ["README.md", "docs/evidence/casadi.md"].map(|page| project::text(page).unwrap());
        let other = readme.replacen("| arm, midpoint | 397", "| arm, midpoint | 398", 1);
        assert_eq!(other_steps_in_c(&other, &page).unwrap().len(), 1);
    }

    #[test]
    fn a_dependency_that_nobody_finds_is_seen() {
        let of = |line: &str| dependencies_not_found("page", line).unwrap().len();
        assert_eq!(of("dalembert = { path = \"../dalembert/runtime\" }"), 0);
        assert_eq!(of("dalembert = { path = \"../dalembert\" }"), 1);
        assert_eq!(of("dalembert-c = { path = \"../dalembert/runtime\" }"), 1);
        assert_eq!(of("dalembert = \"0.1\""), 1);
    }
}
