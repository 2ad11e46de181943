//! How round-off grows over a long run of `Gauss<8>`: the energy error of the ring without friction, over orbits.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p dalembert-benches --bench round_off` (some minutes).
//!
//! The truncation error of the method is below rounding at this step size. Without memory nothing is compensated: the positive
//! control. A random walk grows with the square root of the number of steps, a drift with the number itself.

use dalembert::{Discrete, Gauss, Lagrangian, State, Trajectory, rayleigh_system};

/// Particle in the ring potential.
#[rayleigh_system(rule = gauss, derivatives = expanded)]
fn ring(q: [f64; 2], v: [f64; 2]) -> f64 {
    let s = q[0] * q[0] + q[1] * q[1];
    0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
}

const H: f64 = 0.1;
const ORBITS: usize = 12;
const LONGEST: u32 = 7;

/// Energy errors after 10³, 10⁴, … steps.
fn errors(start: State<f64, 2>, is_compensated: bool) -> Vec<f64> {
    // The momentum of a unit mass is its velocity.
    let energy = |state: &State<f64, 2>| Ring {}.energy(&state.q, &state.p);
    let first = energy(&start);
    let mut trajectory = Trajectory::new(&Ring {}, Gauss::<8>, H, start);
    let (mut state, mut velocity) = (start, None);
    let mut errors = Vec::new();
    for step in 1..=10_u64.pow(LONGEST) {
        if is_compensated {
            trajectory.next();
            state = *trajectory.state();
        } else {
            let next = Discrete::<Gauss<8>, 2>::step(&Ring {}, &state, H, velocity.as_ref());
            let next = next.expect("the ring can be stepped");
            (state, velocity) = (next.state, Some(next.velocity));
        }
        if step >= 1000 && step == 10_u64.pow(step.ilog10()) {
            errors.push((energy(&state) - first) / first);
        }
    }
    errors
}

fn main() {
    println!("Relative energy error, {ORBITS} orbits, h = {H}\n");
    println!("| steps | compensated: rms | mean | without: rms | mean |\n|---|---|---|---|---|");
    let starts: Vec<State<f64, 2>> = (0..ORBITS)
        .map(|orbit| {
            let shift = 0.01 * orbit as f64;
            State { q: [0.0, 1.15549918674982 - shift].into(), p: [0.5 + 0.7 * shift, 0.3 * shift].into() }
        })
        .collect();
    let runs = [true, false]
        .map(|is_compensated| starts.iter().map(|&start| errors(start, is_compensated)).collect::<Vec<_>>());
    for (row, power) in (3..=LONGEST).enumerate() {
        let statistics = runs.each_ref().map(|runs| {
            let column: Vec<f64> = runs.iter().map(|errors| errors[row]).collect();
            let mean = column.iter().sum::<f64>() / ORBITS as f64;
            let square = column.iter().map(|error| error * error).sum::<f64>() / ORBITS as f64;
            format!("{:.1e} | {mean:+.1e}", square.sqrt())
        });
        println!("| 1e{power} | {} | {} |", statistics[0], statistics[1]);
    }
}
