//! Chaotic motions: neighbouring orbits part at once, the energy stays.

use dalembert::{Discrete, Midpoint, State, Trapezoidal};
use dalembert_examples::baseline::{self, Method};
use dalembert_tests::hard::{HenonHeiles, TwoPendulums, drive};

/// Largest energy error in the first and the second half of a run.
fn halves<S, R, const N: usize>(system: &S, rule: R, h: f64, start: State<f64, N>, steps: u64) -> [f64; 2]
where
    S: Discrete<R, N, Scalar = f64>,
{
    let energy = start.energy(system).unwrap();
    let mut largest = [0.0_f64; 2];
    let effort = drive(system, rule, h, start, [steps, 1], |at| {
        let half = &mut largest[usize::from(2 * at.steps > steps)];
        *half = half.max((at.state.energy(system).unwrap() - energy).abs());
    });
    assert_eq!((effort.steps, effort.stopped), (steps, None));
    assert!(effort.worst_residual <= 4.0, "{effort:?}");
    largest
}

#[test]
fn the_double_pendulum_at_high_energy_keeps_it() {
    let system = TwoPendulums { r: 0.0 };
    let start = system.high_energy();
    assert!((start.energy(&system).unwrap() - 7.0).abs() < 1e-14);
    let steps = if cfg!(debug_assertions) { 2_000 } else { 100_000 };
    for h in [0.02, 0.01] {
        for [first, second] in
            [halves(&system, Midpoint, h, start, steps), halves(&system, Trapezoidal, h, start, steps)]
        {
            assert!(first < 250.0 * h * h && second < 1.2 * first, "h = {h}: {first:e}, then {second:e}");
        }
    }
    // The control: Runge–Kutta drifts.
    let mut drift = [0.0_f64; 2];
    let steps = if cfg!(debug_assertions) { 20_000 } else { 100_000 };
    for (k, state) in
        baseline::states(&system, Method::RungeKutta4, 0.02, start).unwrap().take(steps).enumerate()
    {
        let error = (state.unwrap().energy(&system).unwrap() - 7.0).abs();
        let half = &mut drift[usize::from(k >= steps / 2)];
        *half = half.max(error);
    }
    assert!(drift[1] > 1.5 * drift[0], "{drift:?}");
}

/// E next to 1/6, by twice what the rules' energies err: the motion is almost everywhere chaotic and comes
/// near the rim of the well, which it must not leave. At 1/6 itself the saddles are open to it.
#[test]
fn henon_heiles_at_the_energy_of_escape() {
    let system = HenonHeiles { r: 0.0 };
    let steps = if cfg!(debug_assertions) { 8_000 } else { 200_000 };
    let energy = 1.0 / 6.0 - 4e-4;
    let start = HenonHeiles::start(energy, -0.1, 0.1);
    assert!((HenonHeiles::energy_of(&start) - energy).abs() < 1e-15);
    for [first, second] in
        [halves(&system, Midpoint, 0.05, start, steps), halves(&system, Trapezoidal, 0.05, start, steps)]
    {
        assert!(first < 2e-4 && second < 1.2 * first, "{first:e}, then {second:e}");
    }
}

/// Its chaos: a change in the last place becomes one of order 1. The energy does not feel it.
#[test]
fn neighbouring_orbits_part() {
    let system = TwoPendulums { r: 0.0 };
    let start = system.high_energy();
    let mut ends = Vec::new();
    for start in [start, State { q: start.q * (1.0 + f64::EPSILON), ..start }] {
        let mut end = start;
        drive(&system, Midpoint, 0.02, start, [10_000, 10_000], |at| end = at.state);
        ends.push(end);
    }
    assert!((ends[0].q - ends[1].q).amax() > 0.1);
    let energies: Vec<f64> = ends.iter().map(|end| end.energy(&system).unwrap()).collect();
    assert!((energies[0] - energies[1]).abs() < 0.1);
}
