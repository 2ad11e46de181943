//! How long one system takes to compile: `cargo check` and a release build of a program that steps it,
//! everything it depends on being built already. Prints the table of `docs/performance.md`.
//!
//! `cargo run --release -p dalembert-benches --bin compile_times`, with the number of builds of each behind
//! `--` if not 3

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

/// Seconds on the clock and, where the system tells, of processor time.
#[derive(Clone, Copy, Default)]
struct Seconds {
    clock: f64,
    processor: Option<f64>,
}

impl std::fmt::Display for Seconds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.2}", self.clock)?;
        self.processor.map_or(Ok(()), |processor| write!(f, " ({processor:.2})"))
    }
}
use std::{env, fs};

/// The scenes and what a program has to know of them: the macro of the file, and the fields.
const SCENES: [(&str, &str, &str); 2] = [
    ("spring_chain", "SpringChain", "m: [1.0; N], stiffness: 40.0, hardening: 8.0, friction: 0.3"),
    ("pendulum_chain", "PendulumChain", "m: [1.0; N], l: 0.25, g: 9.81, c: 0.02"),
];

const DEGREES: [usize; 4] = [2, 8, 16, 32];

/// Builds of each, unless the command line says otherwise; the median is printed.
const REPEATS: usize = 3;

fn main() -> ExitCode {
    match table() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn table() -> Result<(), String> {
    let repeats = match env::args().nth(1) {
        Some(number) => number.parse().map_err(|_| format!("`{number}` is not a number of builds"))?,
        None => REPEATS,
    };
    let crate_under_test = Package::create()?;
    crate_under_test.write("fn main() {}")?;
    for command in ["check", "build"] {
        crate_under_test.seconds(command)?;
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    println!("| scene | n | `cargo check`, s (of processor time) | release build, s (of processor time) |");
    println!("|---|--:|--:|--:|");
    for (scene, structure, fields) in SCENES {
        for n in DEGREES {
            crate_under_test.write(&program(scene, structure, fields, n))?;
            let (name, check) = (scene.replace('_', " "), crate_under_test.median("check", repeats));
            match check {
                Ok(check) => {
                    println!("| {name} | {n} | {check} | {} |", crate_under_test.median("build", repeats)?)
                }
                Err(error) => println!(
                    "| {name} | {n} | {} | |",
                    error.lines().find(|line| line.starts_with("error")).unwrap_or(&error)
                ),
            }
        }
    }
    println!("\non {cores} cores; median of {repeats} clean builds");
    Ok(())
}

/// A program that steps the scene.
fn program(scene: &str, name: &str, fields: &str, n: usize) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/src/{scene}.rs"));
    format!(
        r#"use dalembert::{{Discretise, Midpoint, State}};

#[macro_use]
#[path = "{}"]
mod scene;

{scene}!({name}: {n}, expanded, [midpoint]);

const N: usize = {n};

fn main() -> Result<(), dalembert::StepError> {{
    let system = {name} {{ {fields} }};
    let start = State::from_velocity(&system, [0.1; N], [0.0; N])?;
    for sample in system.by(Midpoint, 0.01).run(start).sample_every(10).take(10) {{
        println!("{{}}", sample?.state.q);
    }}
    Ok(())
}}
"#,
        file.display()
    )
}

/// A crate of its own, with a target directory of its own.
struct Package(PathBuf);

impl Package {
    fn create() -> Result<Self, String> {
        let benches = Path::new(env!("CARGO_MANIFEST_DIR"));
        let workspace = benches.ancestors().nth(2).ok_or("the benchmarks are in the workspace")?;
        let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.join("target"), PathBuf::from);
        let root = target.join("compile_times");
        fs::create_dir_all(root.join("src")).map_err(|error| error.to_string())?;
        let manifest = format!(
            "[package]\nname = \"compiled\"\nedition = \"2024\"\n\n[dependencies]\ndalembert = {{ path = \"{}\" }}\n\n[workspace]\n",
            workspace.join("runtime").display()
        );
        fs::write(root.join("Cargo.toml"), manifest).map_err(|error| error.to_string())?;
        // The workspace's versions.
        fs::copy(workspace.join("Cargo.lock"), root.join("Cargo.lock")).map_err(|error| error.to_string())?;
        Ok(Self(root))
    }

    fn write(&self, program: &str) -> Result<(), String> {
        fs::write(self.0.join("src/main.rs"), program).map_err(|error| error.to_string())
    }

    fn median(&self, command: &str, repeats: usize) -> Result<Seconds, String> {
        let mut times = vec![Seconds::default(); repeats.max(1)];
        for time in &mut times {
            self.cargo(&["clean", "--package", "compiled", "--profile", profile(command)])?;
            *time = self.seconds(command)?;
        }
        times.sort_by(|a, b| a.clock.total_cmp(&b.clock));
        Ok(times[times.len() / 2])
    }

    fn seconds(&self, command: &str) -> Result<Seconds, String> {
        let (start, before) = (Instant::now(), processor_time());
        self.cargo(&[command, "--profile", profile(command)])?;
        let processor = processor_time().zip(before).map(|(after, before)| after - before);
        Ok(Seconds { clock: start.elapsed().as_secs_f64(), processor })
    }

    fn cargo(&self, arguments: &[&str]) -> Result<(), String> {
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(arguments)
            .current_dir(&self.0)
            .env("CARGO_TARGET_DIR", self.0.join("target"))
            .env("CARGO_INCREMENTAL", "0")
            .output()
            .map_err(|error| error.to_string())?;
        if output.status.success() {
            Ok(())
        } else {
            Err(String::from_utf8_lossy(&output.stderr).into_owned())
        }
    }
}

/// Processor time of the programs that this one has started and waited for, on Linux.
fn processor_time() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/stat").ok()?;
    // After the name in parentheses: fields 16 and 17 of proc(5), in hundredths of a second.
    let fields: Vec<&str> = status.rsplit(')').next()?.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<f64>().ok();
    Some((ticks(13)? + ticks(14)?) / 100.0)
}

fn profile(command: &str) -> &'static str {
    if command == "build" { "release" } else { "dev" }
}
