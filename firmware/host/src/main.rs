//! Holds the report of a microcontroller, on standard input, against the host: the same bits, and
//! instructions and stack below their ceilings. `firmware-host m7 3 < report`

mod ceilings;
mod in_c;

use std::collections::HashMap;
use std::io::Read;
use std::process::ExitCode;

use ceilings::{Ceiling, ceiling, stack_ceiling};
use dalembert::run::DrivenTrajectory;
use dalembert::step::Flow;
use dalembert::{Discretise, Midpoint, Proximal, State};
use firmware_scenes::{STEPS, Stepped, digest, double, single};

/// How many scenes the program in C steps.
const IN_C: usize = 2;

/// The digest of the scene's states, by the same elementary functions as on the device.
fn expected<L, M, const N: usize>((system, method): (&L, M), start: State<L::Scalar, N>, h: L::Scalar) -> u64
where
    L: Flow<M, N>,
{
    system
        .by(method, h)
        .run(start)
        .take(STEPS as usize)
        .fold(0, |hash, step| digest(hash, &step.expect("the scene steps").state))
}

/// The digests of all scenes, by the names that the device gives them.
fn all_expected() -> HashMap<&'static str, u64> {
    macro_rules! scene {
        ($name:literal $module:ident $system:ident) => { scene!($name $module $system Midpoint) };
        ($name:literal $module:ident $system:ident $rule:ident) => {{
            let system = $module::$system::SCENE;
            let start = system.start().expect("masses are regular");
            ($name, expected((&system, $rule), start, $module::$system::STEP))
        }};
    }
    macro_rules! pushed {
        ($name:literal $module:ident) => {{
            use $module::{DrivenPushedCartPole, PushedCartPole};
            let (system, h) = (PushedCartPole::SCENE, PushedCartPole::STEP);
            let start = system.start().expect("masses are regular");
            let mut run = DrivenTrajectory::<DrivenPushedCartPole<'static>, Midpoint, 2>::new(h, start);
            let of_step = |hash, index| {
                run.advance(&system.driven(PushedCartPole::input(index))).expect("the scene steps");
                digest(hash, run.state())
            };
            ($name, (0..STEPS).fold(0, of_step))
        }};
    }
    HashMap::from([
        scene!("double_pendulum_f32" single DoublePendulum),
        scene!("cart_pole_f32" single CartPole),
        pushed!("pushed_cart_pole_f32" single),
        scene!("double_pendulum_f64" double DoublePendulum),
        scene!("cart_pole_f64" double CartPole),
        pushed!("pushed_cart_pole_f64" double),
        scene!("bob_f32" single Bob),
        scene!("block_f32" single Block Proximal),
        scene!("bob_f64" double Bob),
        scene!("block_f64" double Block Proximal),
    ])
}

/// Where a scene's `bits` are not those of the host.
fn other_bits(name: &str, bits: &str, expected: &HashMap<&str, u64>) -> Option<String> {
    let Some(own) = expected.get(name).map(|bits| format!("{bits:016x}")) else {
        return Some(format!("no scene is called {name}"));
    };
    (own != bits).then(|| format!("{name}: bits {bits}, on the host {own}"))
}

/// What is wrong with a line of the report; nothing if it holds. `in_rust` is the mean of a scene's steps in
/// Rust.
fn mistake(
    words: &[&str],
    machine: &str,
    level: &str,
    expected: &HashMap<&str, u64>,
    in_rust: impl Fn(&str) -> Option<u32>,
) -> Option<String> {
    let number = |word: &str| word.parse::<u32>().ok();
    match words {
        ["c", name, bits, mean, _, _, _] => other_bits(name, bits, expected)
            .or_else(|| in_c::mistake(level, name, number(mean), in_rust(name))),
        ["bordered", name, bits, ..] => other_bits(name, bits, expected),
        ["scene", name, bits, mean, worst, _] => {
            if let Some(other) = other_bits(name, bits, expected) {
                return Some(other);
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
        ["stack" | "c_stack", scalar, bytes] => {
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
    let count = |of: &str| lines.iter().filter(|words| words.first() == Some(&of)).count();
    let (scenes, in_c) = (count("scene") + count("bordered"), count("c"));
    let mut failed = scenes != expected.len() || in_c != IN_C;
    if failed {
        eprintln!("{machine}: {scenes} scenes reported, not {}; {in_c} in C, not {IN_C}", expected.len());
    }
    let in_rust = |scene: &str| {
        lines.iter().find_map(|words| match words[..] {
            ["scene", name, _, mean, ..] if name == scene => mean.parse().ok(),
            _ => None,
        })
    };
    for words in &lines {
        if let Some(mistake) = mistake(words, machine, level, &expected, in_rust) {
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

    /// The scenes show their subjects: the bob swings on its rod, the block comes to rest and stays there.
    #[test]
    fn the_bob_is_on_its_rod_and_the_block_stands() {
        let (bob, block) = (double::Bob::SCENE, double::Block::SCENE);
        let mut steps = bob.by(Midpoint, double::Bob::STEP).run(bob.start().unwrap()).take(STEPS as usize);
        assert!(steps.all(|step| (step.unwrap().state.q.norm() - 0.5).abs() < 1e-15));
        let mut run = block.by(Proximal, double::Block::STEP).run(block.start().unwrap());
        let ends = [150, (STEPS - 152) as usize].map(|skipped| run.nth(skipped).unwrap().unwrap().state);
        assert!(ends[0] == ends[1] && ends[0].p[0] == 0.0 && ends[0].q[0] != 0.0, "{ends:?}");
    }

    #[test]
    fn other_bits_and_higher_counts_are_mistakes() {
        let expected = all_expected();
        let in_rust = |_: &str| Some(1000);
        let bits = format!("{:016x}", expected["cart_pole_f64"]);
        let said = |bits: &str, mean: &str, worst: &str| {
            mistake(&["scene", "cart_pole_f64", bits, mean, worst, "400"], "m7", "3", &expected, in_rust)
        };
        assert_eq!(said(&bits, "1000", "1000"), None);
        assert!(said("0000000000000000", "1000", "1000").is_some_and(|text| text.contains("on the host")));
        assert!(said(&bits, "9000", "9000").is_some_and(|text| text.contains("9000 instructions a step")));
        assert!(said(&bits, "1000", "9000").is_some_and(|text| text.contains("in the worst step")));
        let first = |count: &str| {
            mistake(&["part", "cart_pole_f64", "first_step", count], "m7", "3", &expected, in_rust)
        };
        assert_eq!(first("1000"), None);
        assert!(first("90000").is_some_and(|text| text.contains("in the first step")));
        assert!(mistake(&["stack", "f64", "99999"], "m7", "3", &expected, in_rust).is_some());
        assert!(mistake(&["fault"], "m7", "3", &expected, in_rust).is_some());
        let bits_of =
            |bits: &str| mistake(&["bordered", "bob_f64", bits, "9", "9"], "m7", "3", &expected, in_rust);
        assert_eq!(bits_of(&format!("{:016x}", expected["bob_f64"])), None);
        assert!(bits_of("0000000000000000").is_some_and(|text| text.contains("on the host")));
        let in_c = |bits: &str, mean: &str| {
            mistake(&["c", "cart_pole_f64", bits, mean, "1100", "400", "1200"], "m7", "3", &expected, in_rust)
        };
        assert_eq!(in_c(&bits, "1010"), None);
        assert!(in_c("0000000000000000", "1010").is_some_and(|text| text.contains("on the host")));
        assert!(in_c(&bits, "1100").is_some_and(|text| text.contains("1100 instructions a step")));
    }
}
