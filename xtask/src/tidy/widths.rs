//! Comments and documentation are no wider than code: rustfmt holds only code to its `max_width`.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use xshell::Shell;

use crate::project;

/// Folders with comments that are wider today, and how many lines. It only ever goes down.
const CEILINGS: &[(&str, usize)] = &[
    ("bindings", 15),
    ("ensemble", 3),
    ("examples", 5),
    ("firmware", 2),
    ("macros", 5),
    ("measure", 1),
    ("runtime", 45),
    ("scenes", 5),
    ("tests", 6),
];

/// So many fewer there may be in a folder before its ceiling has to follow.
const SLACK: usize = 3;

/// Code that is written, not typed.
const LEFT_OUT: &str = "macros/src/tests/snapshots/";

/// The width that rustfmt is told.
fn max_width() -> Result<usize> {
    let text = project::text("rustfmt.toml")?;
    let width = text.lines().find_map(|line| line.strip_prefix("max_width = "));
    width.context("rustfmt.toml has no max_width")?.trim().parse().context("max_width")
}

/// Lines of comments that are wider than `width`, from 1, with their widths.
fn wide(source: &str, width: usize) -> impl Iterator<Item = (usize, usize)> {
    let widths = source.lines().enumerate().map(|(index, line)| (index + 1, line, line.chars().count()));
    widths
        .filter(move |(_, line, found)| *found > width && line.trim_start().starts_with("//"))
        .map(|(number, _, found)| (number, found))
}

/// Comments that are too wide, in folders with more of them than ever.
pub fn check(shell: &Shell) -> Result<Vec<String>> {
    let width = max_width()?;
    let (mut places, mut files) = (BTreeMap::<String, Vec<String>>::new(), 0);
    for path in project::files(shell, ".rs")? {
        if path.starts_with(LEFT_OUT) {
            continue;
        }
        files += 1;
        let folder = path.split('/').next().unwrap_or_default().to_owned();
        let text = project::text(&path)?;
        let found = wide(&text, width).map(|(line, wide)| format!("{path}:{line}: {wide} wide"));
        places.entry(folder).or_default().extend(found);
    }
    ensure!(files > 500, "{files} files alone were looked at");
    Ok(places.iter().flat_map(|(folder, places)| against(folder, places, CEILINGS)).collect())
}

/// Messages about a folder's places.
fn against(folder: &str, places: &[String], ceilings: &[(&str, usize)]) -> Vec<String> {
    let ceiling = ceilings.iter().find(|of| of.0 == folder).map_or(0, |of| of.1);
    let count = places.len();
    if count > ceiling {
        let all = format!("{folder}: {count} comments are too wide, and {ceiling} may be");
        places.iter().cloned().chain([all]).collect()
    } else if count + SLACK < ceiling {
        vec![format!("{folder}: {count} comments are too wide: lower the ceiling of {ceiling} in widths.rs")]
    } else {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_within_the_width() {
        assert_eq!(check(&project::shell().unwrap()).unwrap(), [""; 0]);
    }

    #[test]
    fn wide_comments_alone_are_seen() {
        let source = "// ééééééé\n// éééééééé\n    /// 12345\nlet x = \"a long text\";\n";
        assert_eq!(wide(source, 10).collect::<Vec<_>>(), [(2, 11), (3, 13)]);
        let places = ["a.rs:2: 11 wide".to_owned()];
        assert_eq!(against("a", &places, &[]).len(), 2);
        assert_eq!(against("a", &places, &[("a", 4)]), [""; 0]);
        assert_eq!(against("a", &places, &[("a", 5)]).len(), 1);
    }
}
