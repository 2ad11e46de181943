//! Documentation opens with the noun that an item is, or with a verb: rustdoc shows each paragraph by itself,
//! and a reader who meets "Those of …" there does not know of what.

use anyhow::{Result, ensure};

use crate::project;

/// The most paragraphs that may open with one of [`OPENINGS`], of 499 that did at first: what is left are
/// sentences that Python's users read too, of fields of a report. It only ever goes down.
const CEILING: usize = 6;

/// So many fewer there may be before the ceiling has to follow.
const SLACK: usize = 3;

const OPENINGS: [&str; 7] = ["What", "The same", "Those", "Nothing", "Who", "Whose", "That of"];

const FOLDERS: [&str; 7] = [
    "macros/src",
    "runtime/src",
    "bindings/c/src",
    "bindings/fmu/src",
    "ensemble/src",
    "bindings/python/binding/src",
    "xtask/src",
];

/// Tests, and the text that the macro generates for them; and this file, which has bad openings to see.
const LEFT_OUT: [&str; 2] = ["macros/src/tests/", "xtask/src/tidy/prose.rs"];

/// A paragraph of documentation.
#[derive(Debug, PartialEq)]
struct Paragraph<'t> {
    /// The number of its first line, from 1.
    line: usize,
    /// Its first line.
    text: &'t str,
}

impl Paragraph<'_> {
    /// Whether its first words are one of [`OPENINGS`].
    fn opens_badly(&self) -> bool {
        OPENINGS.iter().any(|words| {
            let rest = self.text.strip_prefix(words);
            rest.is_some_and(|rest| !rest.starts_with(|next: char| next.is_alphanumeric() || next == '_'))
        })
    }
}

/// The paragraphs of a source file: runs of lines of documentation up to an empty one. Code between fences is
/// none; a list, a table or a heading begins one with its own mark, and the lines below belong to it.
fn paragraphs(source: &str) -> Vec<Paragraph<'_>> {
    let mut found = Vec::new();
    let (mut before, mut is_inside, mut is_code) = ("", false, false);
    for (index, line) in source.lines().enumerate() {
        let line = line.trim_start();
        let marks = ["///", "//!"].into_iter().find(|marks| line.starts_with(marks));
        let Some(marks) = marks.filter(|_| !line.starts_with("////")) else {
            (before, is_inside, is_code) = ("", false, false);
            continue;
        };
        if marks != before {
            (before, is_inside, is_code) = (marks, false, false);
        }
        let text = line[marks.len()..].trim();
        if text.starts_with("```") {
            (is_inside, is_code) = (false, !is_code);
        } else if !is_code {
            if !is_inside && !text.is_empty() {
                found.push(Paragraph { line: index + 1, text });
            }
            is_inside = !text.is_empty();
        }
    }
    found
}

/// Paragraphs that open with one of [`OPENINGS`], unless there are as many as ever.
pub fn check() -> Result<Vec<String>> {
    let root = project::root();
    let (mut places, mut all) = (Vec::new(), 0);
    for folder in FOLDERS {
        for (name, source) in project::sources(root, &root.join(folder))? {
            if LEFT_OUT.iter().any(|left_out| name.starts_with(left_out)) {
                continue;
            }
            let paragraphs = paragraphs(&source);
            all += paragraphs.len();
            let bad = paragraphs.iter().filter(|paragraph| paragraph.opens_badly());
            places.extend(bad.map(|Paragraph { line, text }| format!("{name}:{line}: {text}")));
        }
    }
    ensure!(all > 4_000, "{all} paragraphs alone were looked at");
    let count = places.len();
    if count > CEILING {
        places.push(format!(
            "{count} paragraphs open with one of {OPENINGS:?}, and {CEILING} may: say what the item is, as a noun, or \
             what it does"
        ));
    } else if count + SLACK >= CEILING {
        places.clear();
    } else {
        places =
            vec![format!("{count} paragraphs open with one of {OPENINGS:?}: lower the ceiling of {CEILING}")];
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paragraphs_open_with_what_the_item_is() {
        assert_eq!(check().unwrap(), [""; 0]);
    }

    #[test]
    fn only_what_opens_a_paragraph_is_counted() {
        let source = "\
//! Words of the file.
/// What opens.
/// What stands in the middle.
///
/// # Errors
/// Those below a heading.
///
/// ```
/// What is code.
///
/// Those are code.
/// ```
/// The same after a fence.
///
/// - Nothing in a list.
///
/// | Who | is in a table |
fn first() {
    // What is no documentation.
    //// What is none either.
}

    /// Whatever is another word.
    ///
    /// Whose line follows an empty one.
    struct Second;
";
        let all = paragraphs(source);
        assert_eq!(all.len(), 8, "{all:?}");
        let bad: Vec<_> = all.into_iter().filter(Paragraph::opens_badly).collect();
        let expected =
            [(2, "What opens."), (13, "The same after a fence."), (25, "Whose line follows an empty one.")];
        assert_eq!(bad, expected.map(|(line, text)| Paragraph { line, text }));
    }
}
