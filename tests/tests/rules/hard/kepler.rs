//! Orbits that almost collide.

use std::f64::consts::TAU;

use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, StepError, Trapezoidal};
use dalembert_examples::baseline::{self, Method};
use dalembert_tests::hard::{EccentricKepler, Kepler, drive, kepler};

const FREE: Kepler = Kepler { k: 0.0 };

/// Near sides that most runs pass.
const ORBITS: u64 = if cfg!(debug_assertions) { 1 } else { 3 };

/// Largest errors of E and of J, the latter in units of what rounding of q × p explains.
fn errors<R: Copy>(rule: R, e: f64, steps: u64, orbits: u64) -> (f64, f64, Option<StepError>)
where
    Kepler: Discrete<R, 2, Scalar = f64>,
{
    let start = Kepler::aphelion(e);
    let (mut energy, mut momentum, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
    let effort = drive(&FREE, rule, TAU / steps as f64, start, [orbits * steps, 1], |at| {
        energy = energy.max((Kepler::energy_of(&at.state) + 0.5).abs());
        size = size.max(at.state.q.norm() * at.state.p.norm());
        let change = Kepler::angular_momentum(&at.state) - Kepler::angular_momentum(&start);
        // A random walk of the roundings of the largest q × p so far.
        momentum = momentum.max(change.abs() / (size * f64::EPSILON * (at.steps as f64).sqrt()));
    });
    (energy, momentum, effort.stopped)
}

/// J is kept whatever the step, also where the orbit is nonsense.
#[test]
fn angular_momentum_is_kept_to_rounding_at_any_step() {
    for e in [0.9, 0.99, 0.999] {
        for steps in [1_000, 10_000] {
            for (_, momentum, _) in
                [errors(Midpoint, e, steps, ORBITS), errors(Trapezoidal, e, steps, ORBITS)]
            {
                assert!(momentum < 4.0, "e = {e}, {steps} steps: {momentum}");
            }
        }
    }
}

/// The same for explicit Euler and Runge–Kutta: the control.
#[test]
fn naive_codes_lose_it() {
    let start = Kepler::aphelion(0.9);
    for (method, least) in [(Method::Euler, 1e-2), (Method::RungeKutta4, 1e-6)] {
        let states = baseline::states(&FREE, method, TAU / 1000.0, start).unwrap().take(3000);
        let lost = states
            .map(|state| {
                let change = state.map(|s| Kepler::angular_momentum(&s) - Kepler::angular_momentum(&start));
                change.map_or(f64::INFINITY, f64::abs)
            })
            .fold(0.0, f64::max);
        assert!(lost > least, "{method:?} {lost:e}");
    }
}

#[test]
fn energy_is_of_order_two_once_the_near_side_is_resolved() {
    let order = |coarse: f64, fine: f64| (coarse / fine).log2();
    let midpoint = [5_000, 10_000].map(|steps| errors(Midpoint, 0.9, steps, ORBITS).0);
    let trapezoidal = [5_000, 10_000].map(|steps| errors(Trapezoidal, 0.9, steps, ORBITS).0);
    for [coarse, fine] in [midpoint, trapezoidal] {
        assert!((order(coarse, fine) - 2.0).abs() < 0.05, "{coarse:e} {fine:e}");
    }
}

/// At e = 0.999 a thousandth of the period jumps over the near side: the midpoint step there has no real
/// solution, or leads to an orbit that is not bound; the former is a named error, and a shorter step passes.
#[test]
fn a_step_over_the_collision_is_a_named_error_and_shorter_ones_pass() {
    let h = TAU / 1000.0;
    let start = Kepler::aphelion(0.999);
    let mut trajectory = FREE.by(Midpoint, h).run(start);
    let mut good = start;
    let error = loop {
        match trajectory.next().unwrap() {
            Ok(step) => good = step.state,
            Err(error) => break error,
        }
        assert!(trajectory.time() < TAU, "it passed");
    };
    assert!(matches!(error, StepError::NoRealSolution { .. }), "{error:?}");
    assert_eq!(trajectory.state(), &good, "the last good state");
    // Less than a step from the near side, to which the time is half a period.
    assert!((trajectory.time() - 0.5 * TAU).abs() < 2.0 * h);

    trajectory.change_step_size(h / 4096.0);
    for _ in 0..16 * 4096 {
        trajectory.next().unwrap().unwrap();
    }
    // On the far side again, with the energy that the coarse steps had left.
    assert!(trajectory.state().q[0] > 0.05, "{:?}", trajectory.state());
    let change = Kepler::energy_of(trajectory.state()) - Kepler::energy_of(&good);
    assert!(change.abs() < 1e-3, "{change:e}");
    assert!(
        (Kepler::angular_momentum(trajectory.state()) / Kepler::angular_momentum(&start) - 1.0).abs() < 1e-11
    );
}

/// Isotropic drag: J(t) = J(0) e^{−kt} on every orbit.
#[test]
fn drag_takes_angular_momentum_as_it_should() {
    let k = 0.05;
    let error = |rule_is_midpoint: bool, steps: u64| {
        let start = Kepler::aphelion(0.9);
        let mut worst = 0.0_f64;
        let h = TAU / steps as f64;
        let look = |at: dalembert_tests::hard::Progress<2>| {
            let exact = Kepler::angular_momentum(&start) * (-k * at.time).exp();
            worst = worst.max((Kepler::angular_momentum(&at.state) / exact - 1.0).abs());
        };
        let effort = if rule_is_midpoint {
            drive(&Kepler { k }, Midpoint, h, start, [ORBITS * steps, 1], look)
        } else {
            drive(&Kepler { k }, Trapezoidal, h, start, [ORBITS * steps, 1], look)
        };
        assert_eq!(effort.stopped, None);
        worst
    };
    for midpoint in [true, false] {
        // In the third orbit the near side is at 0.015, passed at a speed of 11: steps must be shorter.
        let (coarse, fine) = (error(midpoint, 10_000), error(midpoint, 20_000));
        assert!(fine < 1e-4, "{fine:e}");
        assert!(((coarse / fine).log2() - 2.0).abs() < 0.1, "{coarse:e} {fine:e}");
    }
}

/// The largest error of E, and of J relatively, on so many orbits by steps that follow the motion, and their
/// number.
fn errors_in_scaled_time<const S: usize>(e: f64, step: f64, orbits: f64) -> (f64, f64, u32) {
    let (start, system) = (Kepler::aphelion(e), EccentricKepler { k: 0.0 });
    let j = Kepler::angular_momentum(&start);
    let mut run = system.by(Gauss::<S>, step).run(start).in_scaled_time();
    let (mut energy, mut momentum, mut steps) = (0.0_f64, 0.0_f64, 0);
    while run.time() < orbits * TAU {
        let state = run.next().unwrap().unwrap().state;
        energy = energy.max((Kepler::energy_of(&state) + 0.5).abs());
        momentum = momentum.max((Kepler::angular_momentum(&state) / j - 1.0).abs());
        steps += 1;
    }
    (energy, momentum, steps)
}

/// At e = 0.99 and 0.999 J is kept to rounding at any Δτ, and E to what the rule leaves of a passage, however
/// many there are.
#[test]
fn orbits_that_almost_collide_keep_momentum_and_energy() {
    let orbits = if cfg!(debug_assertions) { 10.0 } else { 30.0 };
    for (e, bound, rounding) in [(0.99, 5e-12, 4e-15), (0.999, 1e-10, 2e-14)] {
        let (few, of_few, _) = errors_in_scaled_time::<8>(e, 0.3, 3.0);
        let (many, of_many, steps) = errors_in_scaled_time::<8>(e, 0.3, orbits);
        assert!(many < bound && many < 1.3 * few + 1e-12, "{e}: {few:e} {many:e}");
        assert!(of_few < rounding && of_many < 2.0 * rounding, "{e}: {of_few:e} {of_many:e}");
        let (_, coarse, _) = errors_in_scaled_time::<3>(e, 0.6, 3.0);
        assert!(coarse < 2.0 * rounding, "{e}: {coarse:e}");
        // The control: as many steps of one size.
        let start = Kepler::aphelion(e);
        let h = orbits * TAU / f64::from(steps);
        let mut lost = 0.0_f64;
        for step in FREE.by(Gauss::<8>, h).run(start).take(steps as usize / 10) {
            lost = lost.max(step.map_or(f64::INFINITY, |step| (Kepler::energy_of(&step.state) + 0.5).abs()));
        }
        assert!(lost > 1e-2, "{e}: {lost:e}");
    }
}

/// Order 2S at Δτ → 0, here of the energy: the steps as a whole are of the method's order.
#[test]
fn the_order_is_that_of_the_method() {
    let worst = |step: f64| errors_in_scaled_time::<2>(0.99, step, 1.0).0;
    let order = (worst(0.05) / worst(0.025)).log2();
    assert!((order - 4.0).abs() < 0.1, "{order}");
}

/// The free function and the energy of the state agree: what the other tests measure with.
#[test]
fn energies_of_the_scene() {
    let state = State { q: [0.6, -0.3].into(), p: [0.2, 0.5].into() };
    let (l, _) = kepler(state.q.into(), state.p.into(), 0.0);
    let energy = Kepler::energy_of(&state);
    assert!((energy - (state.p.norm_squared() - l)).abs() < 1e-15);
    assert!((energy - state.energy(&FREE).unwrap()).abs() < 1e-15);
}
