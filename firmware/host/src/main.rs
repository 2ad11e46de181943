//! Holds the report of a microcontroller, on standard input, against the host: the same bits, and
//! instructions and stack below their ceilings. `firmware-host m7 3 < report`

mod ceilings;

use std::collections::HashMap;
use std::io::Read;
use std::process::ExitCode;

use ceilings::{Ceiling, ceiling, stack_ceiling};
use dalembert::{Discrete, Discretise, Midpoint, State};
use firmware_scenes::{STEPS, Stepped, digest, double, single};

/// The digest of the scene's states, by the same elementary functions as on the device.
fn expected<L, const N: usize>(system: &L, start: State<L::Scalar, N>, h: L::Scalar) -> u64
where
    L: Discrete<Midpoint, N>,
{
    system
        .by(Midpoint, h)
        .run(start)
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
            let Some(own) = expected.get(name).map(|bits| format!("{bits:016x}")) else {
                return Some(format!("no scene is called {name}"));
            };
            if own != *bits {
                return Some(format!("{name}: bits {bits}, on the host {own}"));
            }
            let (Some(ceiling), Some(mean), Some(worst)) =
                (ceiling(machine, level, name), number(mean), number(worst))
            else {
                return Some(format!("{name}: no ceiling is known for it, or no count was reported"));
            };
            let Ceiling { mean: mean_ceiling, worst: worst_ceiling } = ceiling;
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
        ["part", name, "first_step", count] => {
            let most = ceiling(machine, level, name)?.first();
            (number(count)? > most)
                .then(|| format!("{name}: {count} instructions in the first step, the ceiling is {most}"))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_bits_and_higher_counts_are_mistakes() {
        let expected = all_expected();
        let bits = format!("{:016x}", expected["cart_pole_f64"]);
        let said = |bits: &str, mean: &str, worst: &str| {
            mistake(&["scene", "cart_pole_f64", bits, mean, worst, "400"], "m7", "3", &expected)
        };
        assert_eq!(said(&bits, "1000", "1000"), None);
        assert!(said("0000000000000000", "1000", "1000").is_some_and(|text| text.contains("on the host")));
        assert!(said(&bits, "9000", "9000").is_some_and(|text| text.contains("9000 instructions a step")));
        assert!(said(&bits, "1000", "9000").is_some_and(|text| text.contains("in the worst step")));
        let first =
            |count: &str| mistake(&["part", "cart_pole_f64", "first_step", count], "m7", "3", &expected);
        assert_eq!(first("1000"), None);
        assert!(first("90000").is_some_and(|text| text.contains("in the first step")));
        assert!(mistake(&["stack", "f64", "99999"], "m7", "3", &expected).is_some());
        assert!(mistake(&["fault"], "m7", "3", &expected).is_some());
    }
}
