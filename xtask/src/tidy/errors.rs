//! `Debug` of a public error says what its `Display` says: a program whose `main` returns it prints that.
//!
//! An error is a type that implements `Error`. Its `Debug` is `debug_by_display!` in the runtime, and hands
//! on to `Display` elsewhere; a derived one would print the structure.

use anyhow::{Result, ensure};

use crate::project;

const FOLDERS: [&str; 5] =
    ["runtime/src", "ensemble/src", "bindings/c/src", "bindings/fmu/src", "bindings/python/binding/src"];

/// The errors there were at least, when this was written.
const FEWEST: usize = 20;

/// The names of the types that implement `Error` in a source.
fn errors(source: &str) -> impl Iterator<Item = &str> {
    let lines = source.lines().filter(|line| line.starts_with("impl"));
    lines.filter_map(|line| {
        let (_, rest) = line.split_once("error::Error for ")?;
        rest.split(['<', ' ']).next()
    })
}

/// Whether the source has the error's `Debug` as its `Display`.
fn says_its_text(source: &str, error: &str) -> bool {
    let by_hand = |line: &str| {
        let name = line.split_once("fmt::Debug for ").map(|(_, name)| name);
        name.is_some_and(|name| name.split(['<', ' ']).next() == Some(error))
    };
    source.contains(&format!("debug_by_display!({error});"))
        || (source.lines().any(by_hand) && source.contains("fmt::Display::fmt(self, f)"))
}

/// Errors with another `Debug`.
pub fn check() -> Result<Vec<String>> {
    let root = project::root();
    let (mut others, mut all) = (Vec::new(), 0);
    for folder in FOLDERS {
        for (name, source) in project::sources(root, &root.join(folder))? {
            for error in errors(&source) {
                all += 1;
                if !says_its_text(&source, error) {
                    others.push(format!(
                        "{name}: `Debug` of {error} is not its `Display`, which `main` and `unwrap` are to print"
                    ));
                }
            }
        }
    }
    ensure!(all >= FEWEST, "{all} errors alone were looked at");
    Ok(others)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_says_its_text() {
        assert_eq!(check().unwrap(), [""; 0]);
    }

    #[test]
    fn a_derived_debug_is_seen() {
        let told = "debug_by_display!(StepError);\n\nimpl core::error::Error for StepError {}\n";
        assert_eq!(errors(told).collect::<Vec<_>>(), ["StepError"]);
        assert!(says_its_text(told, "StepError") && !says_its_text(told, "TimeError"));
        let by_hand = "impl<S> fmt::Debug for Failure<S> {\n fmt::Display::fmt(self, f)\n}\nimpl<S> core::error::Error for Failure<S> {}\n";
        assert!(errors(by_hand).all(|error| says_its_text(by_hand, error)));
        let derived = "#[derive(Debug)]\npub enum TimeError {}\nimpl std::error::Error for TimeError {\n";
        assert!(errors(derived).all(|error| !says_its_text(derived, error)));
    }
}
