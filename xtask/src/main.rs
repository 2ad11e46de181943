//! The tasks of this repository: `cargo xtask --help` lists them.

mod bench;
mod bless;
mod core_sources;
mod cross_tools;
mod firmware;
mod fuzz;
mod markdown;
mod no_panic;
mod one_machine;
mod page;
mod project;
mod publish;
mod python_environment;
mod quick;
mod slurm;
mod tidy;
mod tools;

use std::env;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, bail};
use lexopt::Arg::{Long, Short, Value};

use tools::NotChecked;

const HELP: &str = "\
cargo xtask TASK

tidy                    formatting, line widths, circles of modules, prose, public names, links: in seconds
quick [PATH…]           the tests that belong to edited paths, or to those that git status names
places                  how many files a new rule, function or option touches, by ARCHITECTURE.md
bless [pictures]        writes the snapshots of expansions, the messages of diagnostics and the guide's pictures anew
page c                  follows the chapter of docs/ on C, by gcc and by clang
page fmu                … on functional mock-up units, and holds the unit against FMPy
page firmware-c         … on C on a microcontroller, for emulated ones
page browser [PICTURE]  … on the browser, holds the page against runs of this machine, and writes its picture
page python             … on Python and on clusters, with tests, types and gallery
page clusters           the study of docs/clusters.md by workers here, over SSH and by Slurm
firmware [MACHINE]      steps on emulated microcontrollers: m4f, m7, m33, rv, or all
no-panic [LEVEL]        the proof that no step panics, at opt-level 3, s, or both
slurm [TRIES]           an ensemble as an array of Slurm, of which tasks are requeued and killed; so often beside a living one
fuzz [SECONDS] [keep]   fuzzes each target for 60 s, or as many as said; `keep` renews the corpus
bench casadi|python|friction   measures beside CasADi, libraries of Python, or SciPy, and writes the page
publish [all]           what must hold before the crates are published; `all` takes longer

A task that cannot have its tools says so and checks nothing; it fails then where the variable CI is set.
";

fn main() -> ExitCode {
    let Err(error) = run() else { return ExitCode::SUCCESS };
    if let Some(error) = error.downcast_ref::<NotChecked>() {
        eprintln!("\n{error}");
        return ExitCode::from(u8::from(tools::is_ci()));
    }
    eprintln!("error: {error:#}");
    ExitCode::FAILURE
}

fn run() -> Result<()> {
    let mut words = Vec::new();
    let mut arguments = lexopt::Parser::from_env();
    while let Some(argument) = arguments.next()? {
        match argument {
            Value(word) => words.push(word.to_string_lossy().into_owned()),
            Long("help") | Short('h') => words = vec!["help".to_owned()],
            other => return Err(other.unexpected().into()),
        }
    }
    let words: Vec<_> = words.iter().map(String::as_str).collect();
    match words[..] {
        [] | ["help", ..] => print!("{HELP}"),
        ["tidy"] => tidy::run()?,
        ["quick", ref paths @ ..] => quick::run(paths)?,
        ["places"] => tidy::places::print()?,
        ["bless"] => bless::run()?,
        ["bless", "pictures"] => tidy::guide_pictures::write(&project::shell()?)?,
        ["page", "c"] => page::c::run()?,
        ["page", "fmu"] => page::fmu::run()?,
        ["page", "firmware-c"] => page::firmware_c::run()?,
        ["page", "browser"] => page::browser::run(None)?,
        ["page", "browser", picture] => page::browser::run(Some(from_here(picture)?))?,
        ["page", "python"] => page::python::run()?,
        ["page", "clusters"] => page::clusters::run(&project::shell()?)?,
        ["firmware"] => firmware::run(None)?,
        ["firmware", machine] => firmware::run(Some(machine))?,
        ["no-panic"] => no_panic::run(&["3", "s"])?,
        ["no-panic", level] => no_panic::run(&[level])?,
        ["slurm"] => slurm::run(None)?,
        ["slurm", requeued] => slurm::run(Some(requeued))?,
        ["fuzz", ref rest @ ..] => fuzz::run(rest)?,
        ["bench", "casadi"] => bench::casadi::run()?,
        ["bench", "python"] => bench::python::run()?,
        ["bench", "friction"] => bench::python::friction()?,
        ["publish"] => publish::run(false)?,
        ["publish", "all"] => publish::run(true)?,
        _ => bail!("no task is `{}`: cargo xtask --help lists them", words.join(" ")),
    }
    Ok(())
}

/// The path of a file that the user names from where he is.
fn from_here(path: &str) -> Result<PathBuf> {
    Ok(env::current_dir()?.join(path))
}
