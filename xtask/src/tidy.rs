//! `tidy`: checks that only read, in seconds.

mod beside;
mod circles;
mod corrections_page;
mod errors;
mod floors;
mod formatting;
pub mod guide_pictures;
mod kept;
mod links;
mod pages;
mod paths;
pub mod places;
mod prose;
mod root;
mod widths;

use std::thread;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use xshell::Shell;

use crate::project;

/// A check: what it found, each on a line of its own.
type Check = fn(&Shell) -> Result<Vec<String>>;

const CHECKS: [(&str, Check); 12] = [
    ("line widths of comments", widths::check),
    ("circles of modules", circles::check),
    ("floors of the runtime", |_| floors::check()),
    ("public names", root::check),
    ("texts of errors", |_| errors::check()),
    ("openings of documentation", |_| prose::check()),
    ("links of pages", links::check),
    ("pictures of the guide", guide_pictures::check),
    ("tests that pages name", |_| corrections_page::check()),
    ("figures and dependencies in the README", pages::check),
    ("places to touch", |_| places::check()),
    ("the table of tests", |shell| crate::quick::check(shell)),
];

/// Runs all checks beside each other, and prints what they find.
pub fn run() -> Result<()> {
    let start = Instant::now();
    let of_texts = || -> Result<usize> {
        let shell = project::shell()?;
        let mut failed = 0;
        for (name, check) in CHECKS {
            let found = check(&shell).context(name)?;
            print(name, &found);
            failed += usize::from(!found.is_empty());
        }
        Ok(failed)
    };
    let (unformatted, failed) = thread::scope(|scope| {
        let of_texts = scope.spawn(of_texts);
        let unformatted = formatting::check();
        (unformatted, of_texts.join().expect("no check panics"))
    });
    let (unformatted, failed) = (unformatted?, failed?);
    print("formatting", &unformatted);
    let seconds = start.elapsed().as_secs_f64();
    ensure!(failed == 0 && unformatted.is_empty(), "not tidy, after {seconds:.1} s");
    println!("tidy, after {seconds:.1} s");
    Ok(())
}

fn print(name: &str, found: &[String]) {
    if !found.is_empty() {
        println!("== {name}\n{}\n", found.join("\n"));
    }
}
