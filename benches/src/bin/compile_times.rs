//! How long one system takes to compile: `cargo check` and a release build of a program that steps it, everything it depends
//! on being built already. Prints the table of `docs/performance.md`.
//!
//! `cargo run --release -p dalembert-benches --bin compile_times`

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;
use std::{env, fs};

/// The scenes and what a program has to know of them: the macro of the file, and the fields.
const SCENES: [(&str, &str, &str); 2] = [
    ("spring_chain", "SpringChain", "m: [1.0; N], stiffness: 40.0, hardening: 8.0, friction: 0.3"),
    ("pendulum_chain", "PendulumChain", "m: [1.0; N], l: 0.25, g: 9.81, c: 0.02"),
];

const DEGREES: [usize; 4] = [2, 8, 16, 32];

/// Builds of each; the median is printed.
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
    let crate_under_test = Package::create()?;
    crate_under_test.write("fn main() {}")?;
    for command in ["check", "build"] {
        crate_under_test.seconds(command)?;
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    println!("| scene | n | `cargo check`, s | release build, s |");
    println!("|---|--:|--:|--:|");
    for (scene, name, fields) in SCENES {
        for n in DEGREES {
            crate_under_test.write(&program(scene, name, fields, n))?;
            let [check, build] = ["check", "build"].map(|command| crate_under_test.median(command));
            println!("| {} | {n} | {:.2} | {:.2} |", scene.replace('_', " "), check?, build?);
        }
    }
    println!("\non {cores} cores; median of {REPEATS} clean builds");
    Ok(())
}

/// A program that steps the scene.
fn program(scene: &str, name: &str, fields: &str, n: usize) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("src/scenes/{scene}.rs"));
    format!(
        r#"use dalembert::{{Midpoint, State, Trajectory, rayleigh_system}};

#[macro_use]
#[path = "{}"]
mod scene;

{scene}!(expanded, {n});

const N: usize = {n};

fn main() -> Result<(), dalembert::StepError> {{
    let system = {name} {{ {fields} }};
    let start = State::from_velocity(&system, [0.1; N], [0.0; N])?;
    for sample in Trajectory::new(&system, Midpoint, 0.01, start).sample_every(10).take(10) {{
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
        let workspace = benches.parent().ok_or("the benchmarks are in the workspace")?;
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

    fn median(&self, command: &str) -> Result<f64, String> {
        let mut times = [0.0; REPEATS];
        for time in &mut times {
            self.cargo(&["clean", "--package", "compiled", "--profile", profile(command)])?;
            *time = self.seconds(command)?;
        }
        times.sort_by(f64::total_cmp);
        Ok(times[REPEATS / 2])
    }

    fn seconds(&self, command: &str) -> Result<f64, String> {
        let start = Instant::now();
        self.cargo(&[command, "--profile", profile(command)])?;
        Ok(start.elapsed().as_secs_f64())
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

fn profile(command: &str) -> &'static str {
    if command == "build" { "release" } else { "dev" }
}
