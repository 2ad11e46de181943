//! What fuzzing the step has found, kept: `fuzz/` has the fuzzer.

use dalembert::{Midpoint, State, Step, Trajectory, rayleigh_system};

/// Masses on springs of degree 2 and 4, with dampers.
#[rayleigh_system]
fn chain(q: [f64; 8], v: [f64; 8], m: f64, a: f64, r: f64) -> (f64, f64) {
    let mut lagrangian = 0.5 * m * v[0] * v[0] - 0.5 * q[0] * q[0];
    let mut rayleigh = 0.5 * r * v[0] * v[0];
    for i in 1..8 {
        let d = q[i] - q[i - 1];
        lagrangian += 0.5 * m * v[i] * v[i] - 0.5 * d * d - 0.25 * a * d * d * d * d;
        rayleigh += 0.5 * r * (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
    }
    (lagrangian, rayleigh)
}

/// A run of eight steps, with half the step size after each that cannot be taken.
fn steps(system: &Chain, state: State<f64, 8>, h: f64) -> Vec<Step<f64, 8>> {
    let mut run = Trajectory::new(system, Midpoint, h, state);
    let mut taken = Vec::new();
    for _ in 0..8 {
        match run.next().unwrap() {
            Ok(step) => taken.push(step),
            Err(_) => run.change_step_size(0.5 * run.step_size()),
        }
    }
    taken
}

/// A shortened iterate whose matrix is singular is passed by, and counted once only where it is not: `damped` was above `iterations`.
#[test]
fn no_more_iterations_are_shortened_than_made() {
    let system = Chain { m: 3.827392578125, a: 3.827392578125, r: 3.827392578125 };
    let q = [
        0.0,
        f64::EPSILON,
        5.496826171875,
        -7.64404296875,
        6.859375,
        -3.705322265625,
        -0.80615234375,
        -3.6416015625,
    ];
    let p = [
        -1.1923828125,
        -6.127685546875,
        -3.532958984375,
        -7.05126953125,
        -2.759765625,
        3.315341078647449e22,
        5.92822265625,
        -7.330810546875,
    ];
    let taken = steps(&system, State { q: q.into(), p: p.into() }, 2.639892578125);
    assert!(taken.iter().any(|step| step.report.damped > 0), "nothing is shortened: this tests nothing");
    for step in taken {
        assert!(step.report.damped <= step.report.iterations, "{:?}", step.report);
    }
}
