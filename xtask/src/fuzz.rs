//! `fuzz`: every target for some seconds, from the corpus kept in `tests/fuzz/corpus/`: how many inputs were
//! tried, and how many failed.
//!
//! A failing input stays in `tests/fuzz/artifacts/TARGET/`; with it as argument the program of the target, in
//! `tests/fuzz/target/TRIPLE/release/`, fails again, and `FUZZ_SHOW=1` says what it means for the step.

mod corpus;

use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use xshell::{Cmd, Shell, cmd};

use crate::{project, tools};

/// A target with its limits: the longest input in bytes, and the seconds after which an input hangs.
struct Target {
    name: &'static str,
    limits: &'static [&'static str],
    /// The most bytes of its corpus: the repository is no place for more.
    most: usize,
}

const TARGETS: [Target; 3] = [
    Target { name: "macro_tokens", limits: &["-max_len=3000", "-timeout=20"], most: 100_000 },
    Target { name: "step", limits: &["-max_len=250", "-timeout=10", "-len_control=0"], most: 5000 },
    Target { name: "saved_state", limits: &["-max_len=400", "-timeout=5", "-len_control=0"], most: 5000 },
];

/// A target at work.
struct Fuzzing<'a> {
    shell: &'a Shell,
    target: &'a Target,
    program: PathBuf,
    /// The corpus kept, and the inputs found.
    kept: String,
    found: String,
}

/// Takes the words behind `fuzz`: seconds, and whether the corpus is renewed.
pub fn run(words: &[&str]) -> Result<()> {
    let (seconds, keeps) = match words {
        [] => ("60", false),
        [seconds] => (*seconds, false),
        [seconds, "keep"] => (*seconds, true),
        _ => bail!("fuzz takes seconds, and `keep`"),
    };
    let seconds = Duration::from_secs(seconds.parse().context("seconds")?);
    let shell = project::shell()?;
    shell.change_dir("tests/fuzz");
    // No sanitizer: no crate fuzzed here has unsafe code. Coverage, debug assertions and overflow checks
    // stay.
    cmd!(shell, "cargo +nightly fuzz build --fuzz-dir . --sanitizer none").run()?;
    let version = cmd!(shell, "rustc -vV").quiet().read()?;
    let triple = version.lines().find_map(|line| line.strip_prefix("host: ")).context("rustc's host")?;
    let programs = shell.current_dir().join("target").join(triple).join("release");

    println!("\n{:<14} {:>12} {:>10}", "target", "inputs", "failures");
    let mut failed = 0;
    for target in &TARGETS {
        let name = target.name;
        let (kept, found) = (format!("target/corpus/{name}"), format!("target/found/{name}"));
        let fuzzing = Fuzzing { shell: &shell, target, program: programs.join(name), kept, found };
        let (inputs, failures) = fuzzing.run(seconds)?;
        println!("{name:<14} {inputs:>12} {failures:>10}");
        failed += failures;
        if keeps {
            fuzzing.renew()?;
        }
    }
    ensure!(failed == 0, "{failed} failures");
    Ok(())
}

impl Fuzzing<'_> {
    fn command(&self) -> Cmd<'_> {
        self.shell.cmd(&self.program).args(self.target.limits).quiet().ignore_status()
    }

    /// The corpus, one input a line in hexadecimal digits.
    fn page(&self) -> PathBuf {
        self.shell.current_dir().join(format!("corpus/{}.txt", self.target.name))
    }

    /// Tries inputs for so long: how many, and how many failed.
    fn run(&self, time: Duration) -> Result<(u64, u64)> {
        let folder = self.shell.current_dir();
        let artifacts = format!("artifacts/{}/", self.target.name);
        self.shell.remove_path(&self.kept)?;
        for of in [&artifacts, &self.found, &self.kept] {
            self.shell.create_dir(of)?;
        }
        corpus::unpack(&fs::read_to_string(self.page())?, &folder.join(&self.kept))?;
        let (mut inputs, mut failures) = (0, 0);
        let end = Instant::now() + time;
        // A failure ends the program, not the run.
        while let left = end.saturating_duration_since(Instant::now()).as_secs_f64().ceil()
            && left > 0.0
        {
            let options = ["-rss_limit_mb=3000", "-print_final_stats=1"];
            let run = self.command().args(options).arg(format!("-artifact_prefix={artifacts}"));
            let run = run.arg(format!("-max_total_time={left}")).args([&self.found, &self.kept]).output()?;
            let log = tools::said(&run);
            fs::write(folder.join(format!("{}.log", self.found)), log.as_bytes())?;
            inputs += tried(&log);
            if run.status.success() {
                break;
            }
            failures += 1;
        }
        Ok((inputs, failures))
    }

    /// Renews the corpus: few and short inputs that reach what was reached.
    fn renew(&self) -> Result<()> {
        let least = self.shell.current_dir().join("target/least");
        self.shell.remove_path(&least)?;
        self.shell.create_dir(&least)?;
        let merge = self.command().arg("-set_cover_merge=1").arg(&least);
        merge.args([&self.kept, &self.found]).output()?;
        Ok(fs::write(self.page(), corpus::pack(&least, self.target.most)?)?)
    }
}

/// The inputs that libFuzzer says it has tried.
fn tried(log: &str) -> u64 {
    let counts = log.lines().filter_map(|line| line.strip_prefix("stat::number_of_executed_units:"));
    counts.filter_map(|count| count.trim().parse::<u64>().ok()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_counted() {
        assert_eq!(
            tried("#2 INITED\nstat::number_of_executed_units: 271\nstat::average_exec_per_sec:     9\n"),
            271
        );
        assert_eq!(tried("==1== ERROR"), 0);
    }
}
