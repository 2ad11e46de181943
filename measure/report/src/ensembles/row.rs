//! Rows of the page's table: a build for any x86-64 writes all of a row but its last two cells, one for the
//! machine those alone.

use anyhow::{Context, Result};

/// Ours beside heyoka's batch, for a scene and an error.
pub struct Row {
    /// Scene and error, as the row begins.
    pub key: String,
    /// The cheapest of ours, µs a trajectory, and its worst lane.
    pub ours: [String; 2],
    pub batch: [String; 2],
    pub ratio: String,
}

impl Row {
    /// The line of a build for any x86-64, with the last cells that the page had `before`.
    pub fn line(&self, before: &str) -> String {
        let [ours, worst] = &self.ours;
        let [batch, worst_of_batch] = &self.batch;
        let [native, ratio] = line_of(before, &self.key).and_then(last_two).unwrap_or_default();
        let Self { key, ratio: portable, .. } = self;
        format!("{key} {ours} | {worst} | {batch} | {worst_of_batch} | {portable} | {native} | {ratio} |\n")
    }

    /// The page with the last cells of this row, of a build for the machine.
    ///
    /// # Errors
    /// The page has no such row.
    pub fn replaced_in(&self, page: &str) -> Result<String> {
        let line = line_of(page, &self.key).with_context(|| format!("the page has no row {}", self.key))?;
        let mut cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        cells.truncate(cells.len().saturating_sub(2));
        let native = format!("| {} | {} | {} |", cells.join(" | "), self.ours[0], self.ratio);
        Ok(page.replacen(line, &native, 1))
    }
}

fn line_of<'a>(page: &'a str, key: &str) -> Option<&'a str> {
    page.lines().find(|line| line.starts_with(key))
}

fn last_two(line: &str) -> Option<[String; 2]> {
    let mut cells = line.trim_end_matches('|').rsplit('|').map(|cell| cell.trim().to_owned());
    let (last, before) = (cells.next()?, cells.next()?);
    Some([before, last])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_build_keeps_the_cells_of_the_other() {
        let cell = |text: &str| text.to_owned();
        let row = Row {
            key: cell("| ring | 1e-6 |"),
            ours: [cell("ours 5.0"), cell("9e-7")],
            batch: [cell("batch 50.0"), cell("1e-8")],
            ratio: cell("0.10"),
        };
        let first = row.line("");
        assert_eq!(first, "| ring | 1e-6 | ours 5.0 | 9e-7 | batch 50.0 | 1e-8 | 0.10 |  |  |\n");
        let native = Row { ours: [cell("native 4.0"), cell("8e-7")], ratio: cell("0.08"), ..row };
        let both = native.replaced_in(&first).unwrap();
        assert_eq!(
            both,
            "| ring | 1e-6 | ours 5.0 | 9e-7 | batch 50.0 | 1e-8 | 0.10 | native 4.0 | 0.08 |\n"
        );
        let again = Row { ours: [cell("ours 6.0"), cell("9e-7")], ratio: cell("0.12"), ..native };
        assert_eq!(
            again.line(&both),
            "| ring | 1e-6 | ours 6.0 | 9e-7 | batch 50.0 | 1e-8 | 0.12 | native 4.0 | 0.08 |\n"
        );
        // Of another scene there is no row.
        assert!(again.replaced_in("| Kepler | 1e-6 | a | b |").is_err());
    }
}
