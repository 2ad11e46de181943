//! The code that a program of one system has to compile, the functions that it instantiates and their KiB of LLVM
//! IR before optimisation, below a ceiling. Both count the same on every machine; seconds do not.
//!
//! `cargo test -p dalembert-tests --test project compiled -- --nocapture` prints the table. The ceilings are a
//! twentieth above what was found; what no program asked for should never raise them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A system, and for the midpoint rule and for three rules: the most functions, and the most KiB of code.
struct Ceiling {
    name: &'static str,
    n: usize,
    system: &'static str,
    midpoint: [usize; 2],
    three_rules: [usize; 2],
}

const CEILINGS: [Ceiling; 2] = [
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
        midpoint: [625, 1610],
        three_rules: [1500, 4410],
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
        midpoint: [725, 1900],
        three_rules: [1605, 4790],
    },
];

/// A program that takes steps of the system by each rule.
fn program(of: &Ceiling, rules: &[(&str, &str)]) -> String {
    let attribute = rules.iter().map(|rule| rule.0).collect::<Vec<_>>().join(", ");
    let imports = rules.iter().map(|rule| rule.1.split(':').next().unwrap()).collect::<Vec<_>>().join(", ");
    let runs: String = rules
        .iter()
        .map(|rule| {
            format!(
                "    system.by({}, 0.01).run(start).take(100).try_for_each(|step| step.map(drop))?;\n",
                rule.1
            )
        })
        .collect();
    let (n, system) = (of.n, of.system);
    format!(
        "use dalembert::{{Discretise, State, rayleigh_system, {imports}}};
pub struct System {{ pub drag: f64 }}
#[rayleigh_system(rule = [{attribute}])]
impl System {{
        {system}
}}
fn main() -> Result<(), dalembert::StepError> {{
    let system = System {{ drag: 1e-3 }};
    let start = State::from_velocity(&system, [0.7; {n}], [0.1; {n}])?;
{runs}    Ok(())
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

/// A crate that depends on dalembert alone, without `std`: what a program instantiates does not depend on it.
struct Package(PathBuf);

impl Package {
    fn new() -> Self {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compiled");
        fs::create_dir_all(root.join("src")).unwrap();
        let manifest = format!(
            "[package]\nname = \"compiled\"\nedition = \"2024\"\n[dependencies.dalembert]\npath = {:?}\ndefault-features = false\n[workspace]\n",
            workspace.join("runtime")
        );
        fs::write(root.join("Cargo.toml"), manifest).unwrap();
        // The workspace's versions.
        fs::copy(workspace.join("Cargo.lock"), root.join("Cargo.lock")).unwrap();
        Self(root)
    }

    /// The functions and the KiB of code of a program.
    fn size(&self, program: &str) -> [usize; 2] {
        fs::write(self.0.join("src/main.rs"), program).unwrap();
        let code = self.0.join("code.ll");
        let _ = fs::remove_file(&code);
        let output = Command::new(env!("CARGO"))
            .args(["rustc", "--offline", "--quiet", "--target-dir"])
            .arg(self.0.join("target"))
            .args(["--", "-C", "opt-level=3", "-C", "codegen-units=1", "-C", "no-prepopulate-passes"])
            .arg(format!("--emit=llvm-ir={}", code.display()))
            .envs(AS_RELEASED)
            .current_dir(&self.0)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = fs::read_to_string(&code).unwrap();
        [text.lines().filter(|line| line.starts_with("define ")).count(), text.len() / 1024]
    }
}

#[test]
fn a_program_compiles_what_its_system_asks_for() {
    let package = Package::new();
    let rules = [("midpoint", "Midpoint"), ("trapezoidal", "Trapezoidal"), ("gauss", "Gauss::<4>")];
    let mut above = Vec::new();
    println!("{:18}{:>24}{:>24}", "", "midpoint", "three rules");
    for of in &CEILINGS {
        let found = [&rules[..1], &rules[..]].map(|rules| package.size(&program(of, rules)));
        println!(
            "{:18}{:>14}, {:>4} KiB{:>14}, {:>4} KiB",
            of.name, found[0][0], found[0][1], found[1][0], found[1][1]
        );
        let exceeds = |found: [usize; 2], most: [usize; 2]| found[0] > most[0] || found[1] > most[1];
        if exceeds(found[0], of.midpoint) || exceeds(found[1], of.three_rules) {
            above.push(of.name);
        }
        // The control: what more a program asks for is counted.
        assert!(exceeds(found[1], of.midpoint));
    }
    assert!(
        above.is_empty(),
        "{above:?} instantiate more than their ceilings: what seldom runs belongs to `numbers/nonlinear`"
    );
}
