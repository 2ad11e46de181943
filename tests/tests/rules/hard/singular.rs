//! Masses that are singular or nearly so; functions without derivatives somewhere.

use dalembert::nalgebra::vector;
use dalembert::system::Function;
use dalembert::{Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};
use dalembert_tests::hard::{Arm, Drag, FirstOrder, MathewsLakshmanan, Roots, drive};

/// The amplitude goes up to where the mass is infinite, at |λ|A² = 1: q = A sin ωt with ω² = 1/(1 + λA²).
#[test]
fn mathews_lakshmanan_up_to_its_singularity() {
    for (lambda, a) in [(0.7, 2.0), (-1.0, 0.5), (-1.0, 0.9), (-1.0, 0.99), (-1.0, 0.999)] {
        let system = MathewsLakshmanan { lambda, r: 0.0 };
        let omega = system.frequency(a);
        let error = |steps: u32| {
            let h = std::f64::consts::TAU / omega / f64::from(steps);
            let mut trajectory = system.by(Midpoint, h).run(system.start(a));
            let mut largest = 0.0_f64;
            for _ in 0..2 * steps {
                let step =
                    trajectory.next().unwrap().unwrap_or_else(|error| panic!("{lambda} {a}: {error:?}"));
                largest = largest.max((step.state.q[0] - a * (omega * trajectory.time()).sin()).abs());
            }
            largest
        };
        let (coarse, fine) = (error(2_000), error(4_000));
        assert!(
            fine < 1e-2 && ((coarse / fine).log2() - 2.0).abs() < 0.2,
            "λ = {lambda}, A = {a}: {coarse:e} {fine:e}"
        );
    }
}

/// Beyond the singularity L is another system: a state there is not reached by steps, and at the singularity
/// it has an error.
#[test]
fn the_singularity_itself_has_a_name() {
    let system = MathewsLakshmanan { lambda: -1.0, r: 0.0 };
    let made = State::from_velocity(&system, [1.0], [0.1]);
    assert!(
        matches!(made, Err(StepError::NoDerivative { function: Function::Lagrangian, place: Some(_), .. })),
        "{made:?}"
    );
    let state = State { q: vector![1.0], p: vector![0.1] };
    for h in [1e-3, 0.1] {
        let step = system.by(Midpoint, h).step(&state);
        assert!(
            matches!(
                step,
                Err(StepError::NoDerivative { function: Function::Lagrangian, place: Some(_), .. })
            ),
            "{step:?}"
        );
    }
}

/// The upper mass all but vanishes: det ∂²L/∂v² = m when the arms align, down to the last digits.
#[test]
fn an_arm_near_alignment() {
    let steps = if cfg!(debug_assertions) { 6_000 } else { 20_000 };
    for m in [1e-2, 1e-4, 1e-6] {
        let system = Arm { m, r: 0.0 };
        let start = State::from_velocity(&system, [0.3, 0.31], [0.2, 0.25]).unwrap();
        let energy = start.energy(&system).unwrap();
        // The small mass turns at a rate of 1/√m once the arms bend.
        let h = 0.02 * f64::sqrt(m);
        let mut worst = 0.0_f64;
        let effort = drive(&system, Midpoint, h, start, [steps, 1], |at| {
            worst = worst.max((at.state.energy(&system).unwrap() - energy).abs());
        });
        assert_eq!(effort.stopped, None, "m = {m:e}");
        assert!(worst < 1e-3, "m = {m:e}: {worst:e}");
    }
    // m = 0 and aligned: the masses do not determine the velocities, and do where the arms bend.
    let singular = Arm { m: 0.0, r: 0.0 };
    assert_eq!(
        State::from_velocity(&singular, [0.3, 0.3], [0.2, 0.25]),
        Err(StepError::SingularCoordinates { column: 1 })
    );
}

#[test]
fn a_lagrangian_of_first_order_is_refused() {
    let system = FirstOrder { r: 0.1 };
    let refused = Err(StepError::DegenerateLagrangian { column: 0 });
    assert_eq!(State::from_velocity(&system, [0.1, 0.2], [0.3, 0.4]), refused);
    let state = State { q: vector![0.1, 0.2], p: vector![0.3, 0.4] };
    assert_eq!(system.by(Midpoint, 0.1).step(&state).map(|step| step.state), refused);
    assert_eq!(system.by(Trapezoidal, 0.1).step(&state).map(|step| step.state), refused);
}

/// |q|: the slope jumps. The step over the kink is found; the energy jumps by what a step of order h can miss, and no more.
#[test]
fn a_kink() {
    let system = Roots { kink: 1.0, a: 0.0, b: 0.0 };
    let start = State { q: vector![0.5], p: vector![0.0] };
    for h in [0.01, 0.001] {
        let mut worst = 0.0_f64;
        let steps = (20.0 / h) as u64;
        let effort = drive(&system, Midpoint, h, start, [steps, 1], |at| {
            worst = worst.max((0.5 * at.state.p[0].powi(2) + at.state.q[0].abs() - 0.5).abs());
        });
        match effort.stopped {
            // Each crossing, some seven of them, jumps by at most hv.
            None => assert!(worst < 10.0 * h, "{h}: {worst:e}"),
            // The equation is monotone but not continuous: where its jump spans p0 there is no root.
            Some(error) => assert!(matches!(error, StepError::NoRealSolution { .. }), "{error:?}"),
        }
    }
}

/// |q|^{3/2} at 0 has a derivative and no second one: no Newton matrix, but an equilibrium, at which a mass rests. √|q| has neither, which
/// is told at q = 0, and nothing next to it.
#[test]
fn roots_at_zero() {
    let at_zero = State { q: vector![0.0], p: vector![0.0] };
    let steep = Roots { kink: 0.0, a: 0.0, b: 1.0 };
    let error = steep.by(Midpoint, 0.01).step(&at_zero).unwrap_err();
    assert!(
        matches!(error, StepError::NoDerivative { function: Function::Lagrangian, place: Some(_), .. }),
        "{error}"
    );
    let system = Roots { kink: 0.0, a: 1.0, b: 0.0 };
    assert_eq!(system.by(Midpoint, 0.01).step(&at_zero).unwrap().state, at_zero);
    for q in [1e-24, 1e-12, -1e-3] {
        let state = State { q: vector![q], p: vector![0.5] };
        let step = system.by(Midpoint, 0.01).step(&state).unwrap();
        // p0 = v + (h/2) a √q̄
        let v = step.velocity[0];
        let mean = q + 0.005 * v;
        assert!((v + 0.005 * mean.signum() * mean.abs().sqrt() - 0.5).abs() < 1e-15, "{q:e} {v}");
    }
}

/// Drag c|v|^{1/2} sign v: at rest its slope is infinite, so that a mass at rest with p = 0 has no Newton
/// matrix, but rests; one that comes to rest is stopped within finite time.
#[test]
fn drag_with_an_infinite_slope_at_rest() {
    let system = Drag { c: 1.0 };
    let rest = State { q: vector![0.0], p: vector![0.0] };
    let step = system.by(Midpoint, 0.01).step(&rest).unwrap();
    assert_eq!((step.state, step.velocity, step.report.residual), (rest, vector![0.0], 0.0));
    let moving = State { q: vector![0.0], p: vector![0.25] };
    let step = system.by(Midpoint, 0.1).near(&vector![0.25]).step(&moving).unwrap();
    // v + (h/2)√v = p
    let root = (-0.05 + (0.05_f64 * 0.05 + 1.0).sqrt()) / 2.0;
    assert!((step.velocity[0] - root * root).abs() < 1e-15, "{}", step.velocity[0]);
}

/// Two masses with drag through a root, |v|^{3/2} and |v|^{6/5}: one rests, without force and momentum, while
/// the other moves.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn partly_at_rest(q: [f64; 2], v: [f64; 2], force: f64) -> (f64, f64) {
    let roots = v[0].abs().powf(1.5) + v[1].abs().powf(1.2);
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * q[0] * q[0] + force * q[1], 0.5 * roots)
}

#[test]
fn a_mass_rests_beside_one_that_moves() {
    let state = State { q: vector![0.3, 0.2], p: vector![0.7, 0.0] };
    for h in [0.01, 0.1, 1.0] {
        let free = PartlyAtRest { force: 0.0 };
        for step in [free.by(Midpoint, h).step(&state), free.by(Trapezoidal, h).step(&state)] {
            let step = step.unwrap();
            assert_eq!((step.velocity[1], step.state.p[1]), (0.0, 0.0), "{step:?}");
            assert!(step.velocity[0] > 0.0 && step.report.residual <= 4.0 * step.report.floor, "{step:?}");
        }
        // The control: a force sets it in motion, v + (h/2) 0.6 v^{1/5} = (h/2) force.
        let pulled = PartlyAtRest { force: 1.0 }.by(Midpoint, h).step(&state).unwrap();
        let v = pulled.velocity[1];
        assert!(v > 0.0 && (v + 0.5 * h * (0.6 * v.powf(0.2) - 1.0)).abs() < 1e-15, "{pulled:?}");
    }
}
