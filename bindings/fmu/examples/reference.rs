//! Prints runs of the template's system in Rust, for `tests/importer.py` to hold an importer's against: a
//! line for each communication point, of the bits of q, v, p and the energy.

#[path = "../../../examples/fmu/src/lib.rs"]
mod template;

use dalembert::{Discretise, Midpoint, State, StepError};
use template::CartPole;

/// u over communication step k.
fn input(k: u32) -> f64 {
    0.5 * (0.3 * f64::from(k)).sin()
}

fn run(
    name: &str,
    system: &CartPole,
    h: f64,
    (q, v): ([f64; 2], [f64; 2]),
    steps: u32,
    input: impl Fn(u32) -> f64,
) -> Result<(), StepError> {
    let start = State::from_velocity(system, q, v)?;
    let mut run = system.driven([0.0]).by(Midpoint, h).run_with_inputs(start);
    for k in 0..=steps {
        let (state, u) = (*run.state(), input(k));
        let (v, energy) = (state.velocity(system)?, state.energy(system)?);
        print!("{name} {:016x}", u.to_bits());
        for value in state.q.iter().chain(&v).chain(&state.p).chain([&energy]) {
            print!(" {:016x}", value.to_bits());
        }
        println!();
        run.advance(&system.driven([u]))?;
    }
    Ok(())
}

fn main() -> Result<(), StepError> {
    let stated = CartPole { cart: 1.0, rod: 0.1, half_length: 0.25, friction: [0.1, 0.002] };
    run("stated", &stated, 0.01, ([0.0, 0.1], [0.0, 0.0]), 300, |_| 0.0)?;
    let other = CartPole { cart: 2.5, friction: [0.1, 0.05], ..stated };
    run("other", &other, 0.005, ([0.3, -2.0], [0.1, 4.0]), 300, input)
}
