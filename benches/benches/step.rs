//! One midpoint step: generated code against hand-derived code, interleaved in one run.
//!
//! `cargo bench -p dalembert-benches --bench step`
//!
//! "by hand" is a step written out for one system: analytic residual and Newton matrix, 2×2 solve in closed form, the same
//! unknown, guess and tolerance; after the last correction it extrapolates the force instead of evaluating it again.

use std::hint::black_box;

use dalembert::{Discrete, Midpoint, State, Trajectory};
use dalembert_benches::{by_hand, interleaved, scenes};

const STEPS: u32 = 20_000;

fn main() {
    let ring = scenes::Ring { k: 1e-3 };
    let start = [[0.0, 1.15549918674982], [0.5, 0.0]];
    compare("ring", &ring, 0.2, start, |q, p, steps| by_hand::ring(1e-3, 0.2, q, p, steps));

    let pendulum = scenes::DoublePendulum { m: [1.0, 0.7], l: [1.0, 0.8], g: 9.81, c: [0.05, 0.03] };
    let start = [[0.8, -0.4], [0.0, 0.5]];
    compare("double pendulum", &pendulum, 0.01, start, |q, p, steps| {
        by_hand::double_pendulum([1.0, 0.7], [1.0, 0.8], 9.81, [0.05, 0.03], 0.01, q, p, steps)
    });
}

/// Times both ways and prints the ratio, after checking that they compute the same trajectory.
fn compare<L>(
    name: &str,
    system: &L,
    h: f64,
    [q, v]: [[f64; 2]; 2],
    by_hand: impl Fn([f64; 2], [f64; 2], u32) -> ([f64; 2], [f64; 2]),
) where
    L: Discrete<Midpoint, 2, Scalar = f64>,
{
    let start = State::from_velocity(system, q, v).expect("the scene is regular");
    let generated = || {
        let mut trajectory = Trajectory::new(system, Midpoint, h, black_box(start));
        for step in (&mut trajectory).take(STEPS as usize) {
            black_box(step.expect("the scene can be stepped"));
        }
        *trajectory.state()
    };
    let hand = || by_hand(black_box(start.q.into()), black_box(start.p.into()), STEPS);

    let (end, (q_hand, _)) = (generated(), by_hand(start.q.into(), start.p.into(), 200));
    let mut short = Trajectory::new(system, Midpoint, h, start);
    let state = (&mut short).take(200).last().expect("200 steps").expect("the scene can be stepped").state;
    let difference = (state.q - dalembert::nalgebra::SVector::from(q_hand)).amax();
    assert!(difference < 1e-11, "{name}: the two ways differ by {difference:e} after 200 steps");
    black_box(end);

    let [hand, generated] = interleaved([
        &|| {
            black_box(hand());
        },
        &|| {
            black_box(generated());
        },
    ]);
    let per_step = |time: f64| time / f64::from(STEPS) * 1e9;
    println!(
        "{name:16} by hand {:7.1} ns   generated {:7.1} ns   ratio {:.2}",
        per_step(hand),
        per_step(generated),
        generated / hand
    );
}
