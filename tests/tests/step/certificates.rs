//! What a caller may ask for beyond a step: a certificate, bounded work, parts.

mod branches;

use dalembert::derivative::Certificate;
use dalembert::nalgebra::vector;
use dalembert::{Discrete, Discretise, Midpoint, State, StepError, rayleigh_system};
use dalembert_tests::hard::{CubicDrag, DampedMass, SpringPendulum, TwoPendulums};
use dalembert_tests::systems::DoublePendulum;

/// Two masses that one spring holds together.
#[rayleigh_system]
fn coupled(q: [f64; 2], v: [f64; 2], m: [f64; 2], k: f64) -> f64 {
    0.5 * (m[0] * v[0] * v[0] + m[1] * v[1] * v[1]) - 0.5 * k * (q[1] - q[0]).powi(2)
}

fn certificate<S, const N: usize>(system: &S, state: &State<f64, N>, h: f64) -> Certificate<f64>
where
    S: Discrete<Midpoint, N, Scalar = f64>,
{
    let step = system.by(Midpoint, h).step(state).unwrap();
    system.by(Midpoint, h).certificate(state, &step).unwrap()
}

#[test]
fn the_condition_number_is_that_of_the_matrix_in_kinetic_units() {
    let state = State { q: vector![0.1, 0.4], p: vector![0.3, -0.2] };
    // I + (h²k/4)[[1, −1], [−1, 1]] in units of the masses: with a = h²k/4 the 1-norm is 1 + 2a, that of the
    // inverse 1.
    for (a, m) in [(1e-6, 1.0), (0.7, 1.0), (1e6, 1.0), (0.7, 1e-12), (1e6, 1e12)] {
        let system = Coupled { m: [m, m], k: 4.0 * a * m };
        let found = certificate(&system, &state, 1.0);
        assert!((found.condition / (1.0 + 2.0 * a) - 1.0).abs() < 1e-9, "{a:e} {m:e}: {found:?}");
        assert!(found.on_the_branch_of_the_flow && found.correction < 1e-9, "{found:?}");
    }
    // The unit of one coordinate does not matter: masses 24 decades apart, without the spring.
    let found = certificate(&Coupled { m: [1e-12, 1e12], k: 0.0 }, &state, 1.0);
    assert!((found.condition - 1.0).abs() < 1e-12, "{found:?}");
}

#[test]
fn a_root_past_a_fold_is_told() {
    let state = State { q: vector![0.0], p: vector![1.0] };
    for (r, on_the_branch) in [(0.5, true), (-1.9, true), (-2.1, false), (-40.0, false)] {
        let found = certificate(&DampedMass { m: 1.0, r }, &state, 1.0);
        assert_eq!(found.on_the_branch_of_the_flow, on_the_branch, "{r}");
    }
    // Cubic drag: the root on the other branch of the parabola, forced by a guess.
    let system = CubicDrag { m: 1.3, r: 0.6 };
    let state = State { q: vector![0.0], p: vector![-1.0] };
    for (guess, on_the_branch) in [(0.0, true), (-30.0, false)] {
        let step = system.by(Midpoint, 0.4).near(&vector![guess]).step(&state).unwrap();
        let found = system.by(Midpoint, 0.4).certificate(&state, &step).unwrap();
        assert_eq!(found.on_the_branch_of_the_flow, on_the_branch, "{guess}: {step:?}");
    }
}

/// The residual of too few iterations shows in the report and in the certificate; with enough the step is
/// that of `step`.
#[test]
fn steps_of_bounded_work() {
    let system = DoublePendulum::EXAMPLE;
    let state = State { q: vector![1.1, -0.6], p: vector![0.8, 1.9] };
    let full = system.by(Midpoint, 0.3).step(&state).unwrap();
    let mut before = f64::INFINITY;
    for iterations in 1..=12 {
        let bounded = system.by(Midpoint, 0.3).step_within(&state, iterations).unwrap();
        let error = (bounded.step.velocity - full.velocity).amax();
        assert!(bounded.step.report.iterations <= iterations);
        assert_eq!(bounded.converged, error < 1e-13, "{iterations}: {error:e}");
        assert!(error <= before.max(1e-14), "{iterations}: {error:e}");
        let found = system.by(Midpoint, 0.3).certificate(&state, &bounded.step).unwrap();
        // The correction left is the error, to second order.
        let size = error / full.velocity.amax();
        assert!(
            bounded.converged || found.correction > 0.1 * size && found.correction < 10.0 * size,
            "{found:?} {size:e}"
        );
        before = error;
    }
    assert!(before < 1e-14);
    let error = system.by(Midpoint, 0.0).step_within(&state, 3).unwrap_err();
    assert_eq!(error, StepError::StepSize { h: 0.0 });
}

/// A real-time loop: two iterations a step, each from the last velocity, follow the motion.
#[test]
fn two_iterations_a_step_follow_the_motion() {
    let system = TwoPendulums { r: 0.1 };
    let start = State { q: vector![0.8, -0.3], p: vector![0.2, 0.4] };
    let (mut state, mut guess) = (start, vector![0.0, 0.0]);
    for exact in system.by(Midpoint, 0.01).run(start).take(2_000) {
        let exact = exact.unwrap();
        let bounded = system.by(Midpoint, 0.01).near(&guess).step_within(&state, 2).unwrap();
        (state, guess) = (bounded.step.state, bounded.step.velocity);
        assert!((state.q - exact.state.q).amax() < 1e-9);
    }
}

#[test]
fn a_step_in_parts() {
    // p = v + hv²/2 has a root iff 1 + 2hp ≥ 0; p itself runs off as p/(1 + pt) does.
    let system = CubicDrag { m: 1.0, r: 1.0 };
    let start = State { q: vector![0.0], p: vector![-0.7] };
    let mut trajectory = system.by(Midpoint, 1.0).run(start);
    let parted = trajectory.next_in_parts(10).unwrap();
    assert!(parted.parts >= 2, "{parted:?}");
    assert_eq!((trajectory.time(), trajectory.state()), (1.0, &parted.step.state));
    // The same by hand.
    let part = 1.0 / f64::from(parted.parts);
    let last = system.by(Midpoint, part).run(start).take(parted.parts as usize).last().unwrap().unwrap();
    assert_eq!(last.state, parted.step.state);
    // Past the blow-up at t = 1/0.7 nothing helps: the error of the whole step, the state kept, the run
    // ended.
    let state = *trajectory.state();
    let error = trajectory.next_in_parts(10).unwrap_err();
    assert!(matches!(error, StepError::NoRealSolution { .. }), "{error:?}");
    assert_eq!((trajectory.state(), trajectory.time()), (&state, 1.0));
    assert!(trajectory.next().is_none());
    // A step that can be taken at once is.
    let easy = SpringPendulum { k: 1e2, r: 0.0 };
    let mut trajectory = easy.by(Midpoint, 0.01).run(easy.at_angle(0.5));
    assert_eq!(trajectory.next_in_parts(3).unwrap().parts, 1);
}
