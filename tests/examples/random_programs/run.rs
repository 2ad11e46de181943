//! Runs over ranges of seeds.

use std::path::{Path, PathBuf};

use super::batch::Workshop;
use super::engine::features;
use super::rayleigh_system::Runtime;
use super::syntax::Program;
use super::tally::Tally;
use super::trial::{self, Trial};
use super::{generate, members, mistake, print, renamed, shrink};

/// Programs of one crate.
const BATCH: usize = 150;

/// The root of the workspace that cargo runs the study in.
pub fn workspace() -> PathBuf {
    let tests = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    let tests = Path::new(&tests);
    tests.parent().unwrap_or(tests).to_owned()
}

/// Where runs leave their counts and failures.
pub fn folder() -> Result<PathBuf, String> {
    let folder = workspace().join("target/random-programs");
    std::fs::create_dir_all(folder.join("runs")).map_err(|error| error.to_string())?;
    Ok(folder)
}

/// A failing program cut down, as Rust, with what is wrong.
pub fn smallest(program: &Program) -> String {
    let kind = |trial: &Trial| match trial {
        Trial::Failed(words) => words.split(':').next().map(str::to_owned),
        _ => None,
    };
    let first = kind(&trial::by_graph(program));
    if first.is_none() {
        return format!("the graph of seed {} is right", program.seed);
    }
    let small = shrink::shrunk(program, |candidate| kind(&trial::by_graph(candidate)) == first);
    let Trial::Failed(words) = trial::by_graph(&small) else { return "shrunk to nothing".to_owned() };
    format!("// seed {}: {words}\n{}", program.seed, print::formatted(&small, "expanded"))
}

/// Programs through the macro's stages, their graphs evaluated.
pub fn by_graph(count: u64, seed: u64) -> Result<usize, String> {
    let mut tally = Tally::default();
    let mut failures = Vec::new();
    for seed in seed..seed + count {
        let program = generate::program(seed);
        let trial = trial::by_graph(&program);
        tally.take(&program, &trial);
        if let Trial::Failed(words) = &trial {
            println!("seed {seed}: {words}");
            failures.push(program);
        }
    }
    keep(&tally, "graph", seed, count)?;
    summary(&tally);
    Ok(failures.len())
}

/// The classes of mistakes that programs show, each with the number of programs tried until then.
pub fn mistakes(count: u64, seed: u64) {
    let mut found: Vec<(&str, u64)> = Vec::new();
    let mut tried = 0;
    for seed in seed..seed + count {
        let program = generate::program(seed);
        let trial = trial::by_graph(&program);
        tried += u64::from(trial != Trial::Discarded);
        if matches!(trial, Trial::Failed(_)) {
            let text = smallest(&program);
            let class = mistake::of(&text);
            if class == "another" || !found.iter().any(|(known, _)| *known == class) {
                found.push((class, tried));
                println!("{class}: program {tried}\n{text}");
            }
        }
    }
    println!("{tried} programs");
    for (class, at) in found {
        println!("| {class} | {at} |");
    }
}

/// Programs until one fails: how many were tried, and its smallest part.
pub fn until(count: u64, seed: u64) {
    let mut tried = 0;
    for seed in seed..seed + count {
        let program = generate::program(seed);
        let trial = trial::by_graph(&program);
        tried += u64::from(trial != Trial::Discarded);
        if matches!(trial, Trial::Failed(_)) {
            println!("{tried}\n{}", smallest(&program));
            return;
        }
    }
    println!("{tried}");
}

/// Programs built by rustc with the macro, and run.
pub fn compiled(count: u64, seed: u64, engine: &str) -> Result<usize, String> {
    let folder = folder()?;
    let runtime = if engine == "portable" { Runtime::PORTABLE } else { Runtime::STD };
    let workshop = Workshop::new(&folder.join(format!("batch-{engine}")), &workspace(), features(engine));
    let mut failures = 0;
    let mut next = seed;
    while next < seed + count {
        let start = next;
        let mut tally = Tally::default();
        let (mut programs, mut all_expected) = (Vec::new(), Vec::new());
        while next < seed + count && programs.len() < BATCH {
            let program = generate::program(next);
            next += 1;
            let Some(expected) = trial::expected(&program) else {
                tally.take(&program, &Trial::Discarded);
                continue;
            };
            match trial::reaction(&program, engine, runtime) {
                Some(end) => {
                    if let Trial::Failed(words) = &end {
                        println!("seed {}: {words}", program.seed);
                        failures += 1;
                    }
                    tally.take(&program, &end);
                }
                None => {
                    programs.push(program);
                    all_expected.push(expected);
                }
            }
        }
        let outcome = workshop.run(&programs, engine)?;
        if runtime.is_portable {
            // The plain functions call the runtime's elementary functions, the interpreter those of std.
            for (index, expected) in all_expected.iter_mut().enumerate() {
                for (point, expected) in expected.iter_mut().enumerate() {
                    let plain = outcome.computed.get(&(index, point)).and_then(|found| found.plain.clone());
                    expected.values = plain.unwrap_or_default();
                }
            }
        }
        for (index, program) in programs.iter().enumerate() {
            let trial = match outcome.errors.get(&index) {
                Some(_) if outcome.not_rust.contains(&index) => Trial::Discarded,
                // Names in both kinds of letters are types to the macro.
                Some(error) if renamed::by(engine).is_some() && error.contains("cannot be written out") => {
                    Trial::Refused(error.clone())
                }
                Some(error) => trial::told_by_rustc(error),
                None if members::Way::named(engine).is_some() => {
                    trial::judged_in_lanes(program.seed, outcome.computed.get(&(index, 0)))
                }
                None => trial::judged(program, &all_expected[index], |point| {
                    outcome.computed.get(&(index, point))
                }),
            };
            if let Trial::Failed(words) = &trial {
                println!("seed {}: {words}", program.seed);
                failures += 1;
            }
            tally.take(program, &trial);
        }
        keep(&tally, &format!("compiled-{engine}"), start, next - start)?;
        summary(&tally);
    }
    Ok(failures)
}

pub fn keep(tally: &Tally, way: &str, seed: u64, count: u64) -> Result<(), String> {
    let path = folder()?.join(format!("runs/{way}-{seed}-{count}.txt"));
    tally.write(&path).map_err(|error| error.to_string())
}

pub fn summary(tally: &Tally) {
    let [programs, agreed, refused, failed, unread, discarded] =
        ["programs", "agreed", "refused", "failed", "unread", "discarded"].map(|name| tally.count(name));
    println!(
        "{programs} programs: {agreed} agree, {refused} refused, {failed} fail, {unread} unread; {discarded} discarded; points {} compared, {} near a branch, {} too large",
        tally.count("points compared"),
        tally.count("points near a branch"),
        tally.count("points too large")
    );
}
