//! The code that a program of one system has to compile, the functions that it instantiates and their KiB of
//! LLVM IR before optimisation, in sixteen parts as a release build has them, below a ceiling. Both count
//! the same on every machine; seconds do not.
//!
//! `cargo test -p dalembert-tests --test project -- --ignored --nocapture` prints the table. The ceilings are
//! a twentieth above what was found; what no program asked for should never raise them.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A system, and the most functions and KiB of code of two programs: by the midpoint rule and by three rules,
/// or by one and by two Gauss rules in eight lanes.
struct Ceiling {
    name: &'static str,
    n: usize,
    system: &'static str,
    is_in_lanes: bool,
    one: [usize; 2],
    more: [usize; 2],
}

const CEILINGS: [Ceiling; 3] = [
    Ceiling {
        name: "double pendulum",
        n: 2,
        system: "fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let c = (q[0] - q[1]).cos();
            v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * c + 9.81 * (2.0 * q[0].cos() + q[1].cos())
        }
        fn rayleigh(&self, v: [f64; 2]) -> f64 {
            0.5 * self.drag * (v[0] * v[0] + (v[1] - v[0]).powi(2))
        }",
        is_in_lanes: false,
        one: [2715, 5350],
        more: [6165, 13305],
    },
    Ceiling {
        name: "spring in space",
        n: 3,
        system: "fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
            let r = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt();
            0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 20.0 * (r - 1.0) * (r - 1.0) - 9.81 * q[2]
        }
        fn rayleigh(&self, v: [f64; 3]) -> f64 {
            self.drag * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        }",
        is_in_lanes: false,
        one: [3175, 6300],
        more: [6710, 14700],
    },
    Ceiling {
        name: "seven links",
        n: 7,
        system: "fn lagrangian(&self, q: [f64; 7], v: [f64; 7]) -> f64 {
            let (mut x, mut y, mut sum) = (0.0, 0.0, 0.0);
            for i in 0..7 {
                x += v[i] * q[i].cos();
                y += v[i] * q[i].sin();
                sum += 0.5 * (x * x + y * y) + 9.81 * (7 - i) as f64 * q[i].cos();
            }
            sum
        }
        fn rayleigh(&self, v: [f64; 7]) -> f64 {
            let mut sum = v[0] * v[0];
            for i in 1..7 {
                sum += (v[i] - v[i - 1]).powi(2);
            }
            0.5 * self.drag * sum
        }",
        is_in_lanes: true,
        one: [6290, 14940],
        more: [7450, 19375],
    },
];

/// The rules of a program, as the attribute names them, and its methods: of a ceiling the one and the other.
type Programs = [(&'static str, &'static [&'static str]); 2];

const ALONE: Programs = [
    ("midpoint", &["Midpoint"]),
    ("[midpoint, trapezoidal, gauss]", &["Midpoint", "Trapezoidal", "Gauss::<4>"]),
];

const IN_LANES: Programs =
    [("gauss, lanes = gauss", &["Gauss::<3>"]), ("gauss, lanes = gauss", &["Gauss::<3>", "Gauss::<4>"])];

/// A program that takes steps of the system by each method.
fn program(of: &Ceiling, rules: &str, methods: &[&str]) -> String {
    let run = |method: &&str| match of.is_in_lanes {
        false => {
            format!("system.by({method}, 0.01).run(start).take(100).try_for_each(|step| step.map(drop))?;")
        }
        true => format!(
            "LaneRuns::new({method}, [&system; 8], &[start; 8], 0.01).solved_for(1e-9, 1.0).advance(100);"
        ),
    };
    let (n, system) = (of.n, of.system);
    let runs = methods.iter().map(run).collect::<Vec<_>>().join("\n    ");
    format!(
        "#![allow(unused_imports)]
use dalembert::{{Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system, run::LaneRuns}};
pub struct System {{ pub drag: f64 }}
#[rayleigh_system(rule = {rules})]
impl System {{
        {system}
}}
fn main() -> Result<(), dalembert::StepError> {{
    let system = System {{ drag: 1e-3 }};
    let start = State::from_velocity(&system, [0.7; {n}], [0.1; {n}])?;
    {runs}
    Ok(())
}}
"
    )
}

/// Dependencies unoptimised, which is faster, but with the code of a release build.
const AS_RELEASED: [(&str, &str); 3] = [
    ("CARGO_PROFILE_DEV_DEBUG", "none"),
    ("CARGO_PROFILE_DEV_DEBUG_ASSERTIONS", "false"),
    ("CARGO_PROFILE_DEV_OVERFLOW_CHECKS", "false"),
];

/// A folder for programs that use dalembert alone, without `std`: what a program instantiates does not depend
/// on it.
struct Folder {
    root: PathBuf,
    /// The crate, built; what it depends on lies beside it.
    dalembert: PathBuf,
}

impl Folder {
    fn new() -> Self {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compiled");
        fs::create_dir_all(root.join("src")).unwrap();
        let manifest = format!(
            "[package]\nname = \"compiled\"\nedition = \"2024\"\n[dependencies.dalembert]\npath = {:?}\ndefault-features = false\n[workspace]\n",
            workspace.join("runtime")
        );
        fs::write(root.join("Cargo.toml"), manifest).unwrap();
        fs::write(root.join("src/lib.rs"), "").unwrap();
        // The workspace's versions.
        fs::copy(workspace.join("Cargo.lock"), root.join("Cargo.lock")).unwrap();
        let built = Command::new(env!("CARGO"))
            .args(["build", "--lib", "--offline", "--quiet", "--message-format", "json", "--target-dir"])
            .arg(root.join("target"))
            .envs(AS_RELEASED)
            .current_dir(&root)
            .output()
            .unwrap();
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        let messages = String::from_utf8_lossy(&built.stdout);
        let is_dalembert = |file: &&str| file.contains("libdalembert-") && file.ends_with(".rlib");
        let dalembert = messages.split('"').find(is_dalembert).expect("the crate is built").into();
        Self { root, dalembert }
    }

    /// The functions and the KiB of code of a program.
    fn size(&self, program: &str) -> [usize; 2] {
        let (source, code) = (self.root.join("src/main.rs"), self.root.join("code"));
        fs::write(&source, program).unwrap();
        let _ = fs::remove_dir_all(&code);
        fs::create_dir(&code).unwrap();
        // Without machine code, of which rustc makes the most. One file a part of the program: what is marked
        // #[inline] is compiled in each part that calls it.
        let output = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
            .args(["--edition", "2024", "--emit", "llvm-ir", "-C", "opt-level=3", "-C", "codegen-units=16"])
            .args(["-C", "no-prepopulate-passes", "-C", "save-temps", "--out-dir"])
            .arg(&code)
            .arg("-L")
            .arg(self.dalembert.parent().unwrap())
            .arg("--extern")
            .arg(format!("dalembert={}", self.dalembert.display()))
            .arg(source)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let files = fs::read_dir(&code).unwrap().map(|file| file.unwrap().path());
        let of_parts = files.filter(|file| file.extension().is_some_and(|extension| extension == "ll"));
        let text: String = of_parts.map(|file| fs::read_to_string(file).unwrap()).collect();
        [text.lines().filter(|line| line.starts_with("define ")).count(), text.len() / 1024]
    }
}

#[test]
#[ignore = "compiles for half a minute: CI takes it"]
fn a_program_compiles_what_its_system_asks_for() {
    let folder = Folder::new();
    let mut above = Vec::new();
    println!("{:18}{:>24}{:>24}", "", "one rule", "more");
    for of in &CEILINGS {
        let programs = if of.is_in_lanes { IN_LANES } else { ALONE };
        let [one, more] = programs.map(|(rules, methods)| folder.size(&program(of, rules, methods)));
        println!("{:18}{:>14}, {:>4} KiB{:>14}, {:>4} KiB", of.name, one[0], one[1], more[0], more[1]);
        let exceeds = |found: [usize; 2], most: [usize; 2]| found[0] > most[0] || found[1] > most[1];
        if exceeds(one, of.one) || exceeds(more, of.more) {
            above.push(of.name);
        }
        // The control: what more a program asks for is counted.
        assert!(exceeds(more, of.one));
    }
    assert!(
        above.is_empty(),
        "{above:?} instantiate more than their ceilings: what seldom runs belongs to `numbers/nonlinear`"
    );
}
