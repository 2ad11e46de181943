//! Stiff springs in slow motions.

use std::f64::consts::PI;

use dalembert::{Discretise, Midpoint, StepError, Trapezoidal};
use dalembert_examples::baseline::{self, Method};
use dalembert_tests::hard::{FERMI, Fermi, SpringPendulum, drive};

/// Twice the quarter period of the rigid pendulum from rest at the angle `a`: π/agm(1, cos a/2), by Gauss.
fn half_period(a: f64) -> f64 {
    let (mut x, mut y) = (1.0_f64, (0.5 * a).cos());
    for _ in 0..8 {
        (x, y) = (0.5 * (x + y), (x * y).sqrt());
    }
    PI / x
}

/// While ωh² is below 1 the motion is that of the rigid pendulum, though h is far above the period of the
/// spring.
#[test]
fn the_spring_pendulum_swings_as_a_rigid_one() {
    let h = 0.01;
    for ratio in [1e2, 1e3, 1e4] {
        let system = SpringPendulum { k: ratio * ratio, r: 0.0 };
        let start = system.at_angle(1.0);
        let mut trajectory = system.by(Midpoint, h).run(start);
        let mut before = (0.0, 1.0);
        // The first passage of the vertical, twice which is half the period.
        let passage = loop {
            let step = trajectory.next().unwrap().unwrap();
            assert!(step.report.iterations <= 12, "{:?}", step.report);
            let now = (trajectory.time(), SpringPendulum::angle(&step.state));
            if now.1 <= 0.0 {
                break before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1);
            }
            before = now;
        };
        // The spring is longer by (cos θ + v²)/k < 2/k, and the rule has an error of order h².
        let error = (2.0 * passage / half_period(1.0) - 1.0).abs();
        assert!(error < 2.0 / system.k + h * h, "{ratio:e}: {error:e}");
    }
}

#[test]
fn its_energy_is_bounded_while_the_chord_stays_within_the_spring() {
    let (h, steps) = (0.01, if cfg!(debug_assertions) { 5_000 } else { 20_000 });
    for ratio in [1e2, 1e3, 1e4] {
        let system = SpringPendulum { k: ratio * ratio, r: 0.0 };
        let start = system.at_angle(1.0);
        let energy = system.energy_of(&start);
        let mut largest = 0.0_f64;
        let effort = drive(&system, Midpoint, h, start, [steps, 1], |at| {
            largest = largest.max((system.energy_of(&at.state) - energy).abs());
        });
        assert_eq!(effort.stopped, None);
        // The spring has its length at the middle of the chord, so that nodes lie outside by h²v²/8, v² ≤
        // 2(1 − cos 1).
        let sagitta = h * h / 8.0 * 2.0 * (1.0 - 1.0_f64.cos());
        assert!(largest < system.k * sagitta * sagitta + h * h, "{ratio:e}: {largest:e}");
    }
}

/// Explicit steps longer than the spring's period are not stable: the trapezoidal rule is no help here, nor
/// is Runge–Kutta.
#[test]
fn explicit_rules_are_not_for_this() {
    let system = SpringPendulum { k: 1e6, r: 0.0 };
    let start = system.at_angle(1.0);
    let mut worst = 0.0_f64;
    let effort = drive(&system, Trapezoidal, 0.01, start, [2_000, 1], |at| {
        worst = worst.max(system.energy_of(&at.state).abs());
    });
    assert!(effort.stopped.is_some() || worst > 1e3, "{worst:e}");
    let runge_kutta = baseline::states(&system, Method::RungeKutta4, 0.01, start).unwrap().take(2_000);
    let bounded = runge_kutta
        .map(|state| state.map_or(f64::INFINITY, |state| system.energy_of(&state).abs()))
        .all(|energy| energy < 1e3);
    assert!(!bounded);
}

/// The spring's force at the last place of q is larger than gravity: still the step is solved, and does not
/// stand still.
#[test]
fn a_spring_as_stiff_as_the_last_place_of_q() {
    let system = SpringPendulum { k: 1e16, r: 0.0 };
    let mut trajectory = system.by(Midpoint, 0.01).run(system.at_angle(1.0));
    for step in 1..=20_u32 {
        let taken = trajectory.next().unwrap().unwrap();
        // θ = 1 − ½ sin(1) t²
        let expected = 1.0 - 0.5 * 1.0_f64.sin() * (0.01 * f64::from(step)).powi(2);
        let angle = SpringPendulum::angle(&taken.state);
        assert!((angle - expected).abs() < 1e-4, "{step}: {angle} {expected}");
    }
}

/// Hairer's start: three of the four masses' coordinates rest, without a force as yet.
#[test]
fn the_first_step_of_the_chain_is_found() {
    let system = Fermi { omega: 50.0, r: 0.0 };
    for h in [1e-3, 1e-2, 1e-1] {
        let step = system.by(Midpoint, h).step(&system.start()).unwrap();
        assert!(step.report.iterations <= 8 && step.report.damped == 0, "{h}: {:?}", step.report);
    }
}

/// The stiff springs hand their energies on in some hundreds of their periods, while the sum stays: compared
/// with Dormand–Prince as long as neighbouring motions stay together.
#[test]
fn the_chain_exchanges_stiff_energies() {
    let system = Fermi { omega: 50.0, r: 0.0 };
    let (end, stride) = (80.0, 2.0);
    // Averages over each two units of time, some sixteen periods of a stiff spring: the fast oscillation is
    // left out.
    let averages = |energies: &mut dyn Iterator<Item = [f64; FERMI]>, count: usize| {
        let mut rows = Vec::new();
        loop {
            let mut sum = [0.0; FERMI];
            for _ in 0..count {
                match energies.next() {
                    Some(row) => (0..FERMI).for_each(|j| sum[j] += row[j] / count as f64),
                    None => return rows,
                }
            }
            rows.push(sum);
        }
    };
    let fine = if cfg!(debug_assertions) { 0.05 } else { 0.02 };
    let mut exact = baseline::states(&system, Method::DormandPrince853(1e-8), fine, system.start())
        .unwrap()
        .take((end / fine).round() as usize)
        .map(|state| system.stiff_energies(&state.unwrap()));
    let exact = averages(&mut exact, (stride / fine).round() as usize);

    // Without optimisation half the way is compared, by longer steps.
    let (end, h) = if cfg!(debug_assertions) { (40.0, 1.0 / 128.0) } else { (end, 0.005) };
    let error = |h: f64| {
        let mut own = Vec::new();
        let mut total = [f64::INFINITY, 0.0_f64];
        let effort = drive(&system, Midpoint, h, system.start(), [(end / h).round() as u64, 1], |at| {
            let energies = system.stiff_energies(&at.state);
            let sum: f64 = energies.iter().sum();
            total = [total[0].min(sum), total[1].max(sum)];
            own.push(energies);
        });
        assert_eq!(effort.stopped, None);
        // The adiabatic invariant moves by O(1/ω).
        assert!(total[0] > 0.9 && total[1] < 1.1, "{total:?}");
        let own = averages(&mut own.into_iter(), (stride / h).round() as usize);
        assert_eq!(own.len(), (end / stride) as usize);
        let pairs = own.iter().zip(&exact);
        pairs.flat_map(|(a, b)| (0..FERMI).map(move |j| (a[j] - b[j]).abs())).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(h), error(0.5 * h));
    assert!(coarse < 0.02 && fine < 0.3 * coarse, "{coarse} {fine}");
    // The control: the energies do change hands.
    let handed_on = (0..FERMI).all(|j| {
        let low = exact.iter().map(|row| row[j]).fold(f64::INFINITY, f64::min);
        let high = exact.iter().map(|row| row[j]).fold(0.0, f64::max);
        high - low > 0.2
    });
    assert!(handed_on);
}

/// Far beyond, ωh² = 100: what happens is not the pendulum's motion, and the energy says so, or the step has
/// an error.
#[test]
fn beyond_the_chord_the_energy_or_an_error_tells() {
    let system = SpringPendulum { k: 1e8, r: 0.0 };
    let start = system.at_angle(1.0);
    let mut largest = 0.0_f64;
    let effort = drive(&system, Midpoint, 0.1, start, [1_000, 1], |at| {
        largest = largest.max(system.energy_of(&at.state));
    });
    assert!(largest > 1e3, "{largest}");
    if let Some(error) = effort.stopped {
        assert!(matches!(
            error,
            StepError::NoRealSolution { .. }
                | StepError::NotConverged { .. }
                | StepError::LostPrecision { .. }
        ));
    }
}
