//! The README's table of speed says what it is copied from.

use anyhow::{Context, Result, ensure};

use crate::project;

const HEADING: &str = "| scene | n | by hand, ns | generated, ns | generated / by hand | num-dual, ns |";

/// The README's columns of the rows of scenes in the table of speeds.
fn rows_of_scenes(page: &str) -> Result<Vec<String>> {
    let table = page.split_once(HEADING).context("the table of speeds is gone")?.1;
    let scenes = ["ring", "double pendulum", "FPUT chain", "spring chain", "pendulum chain", "arm"];
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let cells = rows.map(|row| row.split('|').map(str::trim).skip(1).take(6).collect::<Vec<_>>());
    Ok(cells.filter(|cells| scenes.contains(&cells[0])).map(|cells| cells.join(" | ")).collect())
}

/// Rows of the README's table of speed that are not those of the page of performance, which the bench prints.
pub fn check() -> Result<Vec<String>> {
    differences(&project::text("README.md")?, &project::text("docs/performance.md")?)
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
        assert_eq!(check().unwrap(), [""; 0]);
    }

    #[test]
    fn a_figure_that_is_another_is_seen() {
        let readme = project::text("README.md").unwrap();
        let other = readme.replacen("| ring | 2 | ", "| ring | 2 | 1", 1);
        assert_eq!(differences(&other, &readme).unwrap().len(), 1);
    }
}
