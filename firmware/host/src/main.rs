//! Holds the report of a microcontroller, on standard input, against the host: the same bits, and instructions and stack below
//! their ceilings. `firmware-host m7 3 < report`

mod ceilings;

use std::collections::HashMap;
use std::io::Read;
use std::process::ExitCode;

use ceilings::{Ceiling, ceiling, stack_ceiling};
use dalembert::{Discrete, Midpoint, State, Trajectory};
use firmware_scenes::{STEPS, digest, double, single};

/// The digest of the scene's states, by the same elementary functions as on the device.
fn expected<L, const N: usize>(system: &L, start: State<L::Scalar, N>, h: L::Scalar) -> u64
where
    L: Discrete<Midpoint, N>,
{
    Trajectory::new(system, Midpoint, h, start)
        .take(STEPS as usize)
        .fold(0, |hash, step| digest(hash, &step.expect("the scene steps").state))
}

/// The digests of all scenes, by the names that the device gives them.
fn all_expected() -> HashMap<&'static str, u64> {
    macro_rules! scene {
        ($name:literal $module:ident $system:ident) => {{
            let system = $module::$system::SCENE;
            ($name, expected(&system, system.start().expect("masses are regular"), $module::$system::STEP))
        }};
    }
    HashMap::from([
        scene!("double_pendulum_f32" single DoublePendulum),
        scene!("cart_pole_f32" single CartPole),
        scene!("double_pendulum_f64" double DoublePendulum),
        scene!("cart_pole_f64" double CartPole),
    ])
}

/// What is wrong with a line of the report; nothing if it holds.
fn mistake(words: &[&str], machine: &str, level: &str, expected: &HashMap<&str, u64>) -> Option<String> {
    let number = |word: &str| word.parse::<u32>().ok();
    match words {
        ["scene", name, bits, mean, worst, _] => {
            let own = format!("{:016x}", expected.get(name)?);
            if own != *bits {
                return Some(format!("{name}: bits {bits}, on the host {own}"));
            }
            let Ceiling { mean: mean_ceiling, worst: worst_ceiling } = ceiling(machine, level, name)?;
            let (mean, worst) = (number(mean)?, number(worst)?);
            if mean > mean_ceiling {
                return Some(format!("{name}: {mean} instructions a step, the ceiling is {mean_ceiling}"));
            }
            (worst > worst_ceiling).then(|| {
                format!("{name}: {worst} instructions in the worst step, the ceiling is {worst_ceiling}")
            })
        }
        ["stack", scalar, bytes] => {
            let ceiling = stack_ceiling(scalar)?;
            (number(bytes)? > ceiling)
                .then(|| format!("{scalar}: {bytes} bytes of stack, the ceiling is {ceiling}"))
        }
        ["failing", ..] | ["part", ..] => None,
        _ => Some(format!("not a line of a report: {words:?}")),
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [machine, level] = &arguments[..] else {
        eprintln!("firmware-host MACHINE OPT-LEVEL < report");
        return ExitCode::FAILURE;
    };
    let mut report = String::new();
    if std::io::stdin().read_to_string(&mut report).is_err() {
        eprintln!("the report cannot be read");
        return ExitCode::FAILURE;
    }
    let expected = all_expected();
    let lines: Vec<Vec<&str>> = report.lines().map(|line| line.split_whitespace().collect()).collect();
    let scenes = lines.iter().filter(|words| words.first() == Some(&"scene")).count();
    let mut failed = scenes != expected.len();
    if failed {
        eprintln!("{machine}: {scenes} scenes reported, not {}", expected.len());
    }
    for words in &lines {
        if let Some(mistake) = mistake(words, machine, level, &expected) {
            eprintln!("{machine}, opt-level {level}: {mistake}");
            failed = true;
        }
        println!("{machine} {level} {}", words.join(" "));
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
