//! One midpoint step of every scene: derivatives by hand, generated, and by dual numbers, on one solver;
//! times of interleaved runs and counted instructions, as the tables of `docs/performance.md`.
//!
//! `cargo bench -p dalembert-benches --bench step`
//!
//! Instructions are counted where valgrind is installed.

use std::env;

use dalembert_benches::candidates::{self, Scene, Way};
use dalembert_benches::instructions::{self, Part};
use dalembert_benches::interleaved;

fn main() {
    let arguments: Vec<String> = env::args().collect();
    if let Some(at) = arguments.iter().position(|argument| argument == instructions::COUNTED) {
        return counted(&arguments[at + 1..]);
    }
    let scenes = candidates::scenes();
    for scene in &scenes {
        scene.assert_agreement();
    }
    times(&scenes);
    println!();
    starts(scenes.iter().chain(&candidates::others()));
    println!();
    counts(&scenes);
    println!();
    costs_per_degree();
}

/// The run that valgrind watches.
fn counted(arguments: &[String]) {
    let [scene, way, part, times] = arguments else { panic!("a scene, a way, a part and a number of times") };
    let scene = (candidates::scenes().into_iter())
        .chain(candidates::chains().into_iter().flatten())
        .find(|known| known.name == *scene)
        .expect("a scene");
    let way = Way::ALL.into_iter().find(|known| known.name() == *way).expect("a way");
    let times = times.parse().expect("a number of times");
    match Part::ALL.into_iter().find(|known| known.name() == *part).expect("a part") {
        Part::Step => scene.way(way).expect("a way of this scene")(times),
        Part::Evaluation => scene.evaluations(way).expect("a way of this scene")(times),
    }
}

/// Nanoseconds per step.
fn times(scenes: &[Scene]) {
    println!(
        "| scene | n | by hand, ns | generated, ns | generated / by hand | num-dual, ns | num-dual / generated | stripped, ns |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    let mut ratios = Vec::new();
    for scene in scenes {
        let ways = Way::ALL.map(|way| scene.way(way));
        let runs: Vec<&dyn Fn(usize)> = ways.iter().flatten().map(|run| run as &dyn Fn(usize)).collect();
        let medians: Vec<f64> =
            interleaved::medians(&runs).into_iter().map(|seconds| seconds * 1e9).collect();
        let [by_hand, generated, dual] = [medians[0], medians[1], medians[2]];
        let stripped = medians.get(3).map_or(String::new(), |time| digits(*time));
        ratios.push(generated / by_hand);
        println!(
            "| {} | {} | {} | {} | {:.2} | {} | {:.1} | {stripped} |",
            scene.name,
            scene.degrees,
            digits(by_hand),
            digits(generated),
            generated / by_hand,
            digits(dual),
            dual / generated
        );
    }
    println!("\ngeometric mean of generated / by hand: {:.2}", geometric_mean(&ratios));
}

/// What a run verifies before its first step, beside a thousand steps.
fn starts<'s>(scenes: impl Iterator<Item = &'s Scene>) {
    println!("| scene | n | engine | start, ns | 1000 steps, ns | start / 1000 steps, % |");
    println!("|---|--:|---|--:|--:|--:|");
    for scene in scenes {
        for way in [Way::Generated, Way::NumDual] {
            let (Some(start), Some(steps)) = (scene.starts(way), scene.way(way)) else { continue };
            let medians = interleaved::medians(&[start, &steps]);
            let [start, steps] = [medians[0] * 1e9, medians[1] * 1e12];
            println!(
                "| {} | {} | {} | {start:.0} | {steps:.0} | {:.2} |",
                scene.name,
                scene.degrees,
                way.name(),
                100.0 * start / steps
            );
        }
    }
}

/// Instructions per step, and of one evaluation of what a step evaluates.
fn counts(scenes: &[Scene]) {
    println!("| scene | n | part | by hand | generated | generated / by hand | num-dual |");
    println!("|---|--:|---|--:|--:|--:|--:|");
    for part in Part::ALL {
        let mut ratios = Vec::new();
        for scene in scenes {
            let count = |way: Way, times| instructions::each(scene.name, way.name(), part, times);
            let (Some(by_hand), Some(generated), Some(dual)) =
                (count(Way::ByHand, 1000), count(Way::Generated, 1000), count(Way::NumDual, 20))
            else {
                println!("\nno valgrind: instructions not counted");
                return;
            };
            ratios.push(generated / by_hand);
            println!(
                "| {} | {} | {} | {by_hand:.0} | {generated:.0} | {:.2} | {dual:.0} |",
                scene.name,
                scene.degrees,
                part.name(),
                generated / by_hand
            );
        }
        println!("| geometric mean | | {} | | | {:.2} | |", part.name(), geometric_mean(&ratios));
    }
}

/// Steps of a chain in one turn: of 8 masses and of 32 the same stretch of the motion.
const STEPS: usize = 1000;

/// What one degree of freedom of a chain costs, at n = 8 and at n = 32.
fn costs_per_degree() {
    let costs = |nanoseconds: f64, instructions: Option<f64>| {
        let instructions = instructions.map_or(String::new(), |count| format!("{count:.0}"));
        format!("{} | {instructions}", digits(nanoseconds))
    };
    println!(
        "| chain | ns per degree of freedom, n = 8 | instructions | ns per degree of freedom, n = 32 | instructions | ns, n = 32 / n = 8 |"
    );
    println!("|---|--:|--:|--:|--:|--:|");
    for chains in candidates::chains() {
        let runs = chains.each_ref().map(|chain| chain.way(Way::Generated).expect("generated"));
        let runs = runs.each_ref().map(|run| run as &dyn Fn(usize));
        let times = interleaved::medians_over(&runs, &[STEPS; 2]);
        let [short, long] = [0, 1].map(|k| {
            let (chain, degrees) = (&chains[k], chains[k].degrees as f64);
            let count = instructions::each(chain.name, Way::Generated.name(), Part::Step, STEPS);
            (times[k] * 1e9 / degrees, count.map(|count| count / degrees))
        });
        let name = chains[0].name.trim_end_matches(" of 8");
        let ratio = long.0 / short.0;
        println!("| {name} | {} | {} | {ratio:.2} |", costs(short.0, short.1), costs(long.0, long.1));
    }
}

fn geometric_mean(ratios: &[f64]) -> f64 {
    (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp()
}

/// Three digits.
fn digits(value: f64) -> String {
    let decimals = (2 - value.log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}
