//! What fuzzing the step has found, kept: `tests/fuzz/` has the fuzzer.

use dalembert::step::Flow;
use dalembert::step::Step;
use dalembert::{Discretise, Gauss, Lagrangian, Midpoint, State, rayleigh_system};

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

/// The steps that are taken from rest and from the velocity as guesses, with h halved again and again.
fn steps(system: &Chain, state: State<f64, 8>, h: f64) -> Vec<Step<f64, 8>> {
    let guesses = [[0.0; 8].into(), state.p / system.m];
    let sizes = (0..60).map(|k| h * 0.5_f64.powi(k));
    sizes
        .flat_map(|h| guesses.map(|guess| system.by(Midpoint, h).near(&guess).step(&state).ok()))
        .flatten()
        .collect()
}

/// A shortened iterate whose matrix is singular is passed by, and counted once only where it is not: `damped`
/// was above `iterations`.
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

/// Three masses whose inertia grows with q₀.
#[rayleigh_system]
fn coupled(q: [f64; 3], v: [f64; 3], m: f64, a: f64) -> f64 {
    let sum = v[0] + v[1] + v[2];
    let kinetic = 0.5 * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + 0.5 * (1.0 + q[0] * q[0]) * sum * sum;
    kinetic - a * (q[0] * q[1] * q[2]).cos()
}

/// From a guess that is out by 76 orders of magnitude the matrix, and with it the floor, was that of far out:
/// a step was taken whose residual was a third of the momentum.
#[test]
fn a_wild_guess_does_not_lower_the_demands() {
    let system = Coupled { m: 3.89013671875, a: 0.25 };
    let state = State {
        q: [8.4930666804e-314, 0.0, -0.000244140625].into(),
        p: [3.860595703125, -7.235107421875, 0.0].into(),
    };
    let guess = [2.3583984375, -6.866455078125, 1e77].into();
    for guess in [Some(&guess), None] {
        let step = Flow::<Midpoint, 3>::step(&system, &state, 1.0387856152602565e-13, guess);
        match step {
            Ok(step) => assert!(step.report.residual < 1e-12, "{:?}", step.report),
            Err(_) => assert!(guess.is_some()),
        }
    }
}

#[rayleigh_system(rule = gauss)]
fn free(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] + 0.0 * q[0]
}

/// At the end of all numbers the mean velocity can overflow while the state does not.
#[test]
fn a_gauss_step_has_a_finite_velocity() {
    let taken = |p: f64| {
        let state = State { q: [-0.88916015625].into(), p: [p].into() };
        Free {}.by(Gauss::<3>, -1.6274861991405487e-5).step(&state)
    };
    assert!(taken(1e300).unwrap().velocity[0].is_finite());
    assert!(taken(f64::MAX).is_ok_and(|step| step.velocity[0].is_finite()) || taken(f64::MAX).is_err());
}

/// 0.5mv² − 0.5kq², with a damper.
#[rayleigh_system(rule = gauss)]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// Where the force overflows, so did the floor, and no residual was large beside it.
#[test]
fn an_infinite_floor_hides_no_residual() {
    let system = Oscillator { m: 4.976960679201e274, k: f64::MAX, r: 2.580078125 };
    let start = State { q: [0.4612579345703125].into(), p: [1.0].into() };
    let mut run = system.by(Gauss::<3>, 7.2041015625).run(start);
    let mut taken = 0;
    for _ in 0..64 {
        match run.next().unwrap() {
            Ok(step) => {
                taken += 1;
                assert!(step.report.residual.is_finite() && step.report.floor.is_finite(), "{step:?}");
            }
            Err(_) => run.change_step_size(0.5 * run.step_size()),
        }
    }
    assert!(taken > 0, "no step is taken: this tests nothing");
}

/// A constant that overflows where it is folded stays the infinity that it is.
#[rayleigh_system(derivatives = expanded)]
fn overflowing(q: [f64; 1], v: [f64; 1], m: f64) -> f64 {
    let large = 1e200 * 1e200;
    let none = 0.0 * large;
    let depth = if q[0] > 1.0 { large } else { m };
    0.5 * m * v[0] * v[0] - depth * q[0] + if q[0] < -1.0 { none * q[0] } else { 0.0 }
}

#[test]
fn constants_may_overflow() {
    let system = Overflowing { m: 2.0 };
    let slope = |q: f64| system.lagrangian_gradient(&[q].into(), &[0.0].into()).d1[0];
    assert_eq!(slope(0.5), -2.0);
    assert_eq!(slope(2.0), f64::NEG_INFINITY);
    assert!(slope(-2.0).is_nan());
}
