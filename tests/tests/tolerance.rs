//! Order and step size from a requested error: reached, explained, and watched over along the run.

use dalembert::nalgebra::SVector;
use dalembert::{Discrete, Method, State, ToleranceError, Trapezoidal, rayleigh_system};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::reference;
use dalembert_tests::systems::{Chain, Pendulum};

/// The error at the end of the choice for `tolerance`, and whether its guard stayed silent.
fn reached<L, const N: usize>(system: &L, [q, v]: [[f64; N]; 2], time: f64, tolerance: f64) -> (f64, Method)
where
    L: ByHand<N> + Discrete<Trapezoidal, N, Scalar = f64>,
{
    let (q_end, _) = reference::motion(system, q, v, time);
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let choice = Method::for_tolerance(system, Trapezoidal, &start, time, tolerance).unwrap();
    let mut run = choice.trajectory(system, Trapezoidal, start);
    let end = run.by_ref().last().unwrap().unwrap();
    assert!((run.time() - time).abs() < 1e-9 * time, "the run ends at {}", run.time());
    assert!(run.breach().is_none(), "{}\n{choice}", run.breach().unwrap());
    ((end.q - SVector::from(q_end)).amax(), choice.method)
}

#[test]
fn the_error_asked_for_is_reached_and_not_by_brute_force() {
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
        let (error, _) = reached(&Pendulum::EXAMPLE, [[1.9], [-0.7]], 16.0, tolerance);
        assert!(error <= tolerance, "pendulum: {error:e} for {tolerance:e}");
        let chain = [[0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]];
        let (error, _) = reached(&Chain::EXAMPLE, chain, 16.0, tolerance);
        assert!(error <= tolerance, "chain: {error:e} for {tolerance:e}");
        // Not smaller by many orders either: the step was not just taken tiny.
        assert!(error >= 1e-5 * tolerance, "chain: {error:e} for {tolerance:e}");
    }
}

#[test]
fn small_errors_want_high_order() {
    let method = |tolerance| reached(&Pendulum::EXAMPLE, [[1.9], [-0.7]], 16.0, tolerance).1;
    assert_eq!(method(1e-10), Method::KahanLi8);
    assert_ne!(method(1e-2), Method::KahanLi8);
}

#[test]
fn a_choice_says_why() {
    let system = Pendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.9], [-0.7]).unwrap();
    let choice = Method::for_tolerance(&system, Trapezoidal, &start, 16.0, 1e-8).unwrap();
    let [least, ..] = choice.trials.map(|trial| trial.method);
    assert_eq!(least, Method::Rule);
    let chosen = choice.trials.iter().find(|trial| trial.method == choice.method).unwrap();
    assert!(choice.trials.iter().all(|trial| trial.substeps >= chosen.substeps || trial.expected > 1e-8));
    assert!((choice.step_size * choice.steps as f64 - 16.0).abs() < 1e-12);
    let text = choice.to_string();
    for part in [
        "order 8 in 17 substeps, h = ",
        "1.0e-8 asked for",
        "\n  order 2, the rule alone: h = ",
        "\n  order 6 in 9",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

/// A pendulum that starts at rest far out, where nothing happens, and later meets a stiff spring.
#[rayleigh_system(rule = trapezoidal)]
fn bumper(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    0.5 * v[0] * v[0] - k * (40.0 * q[0]).exp() / 1600.0 - 1e-2 * q[0] * q[0]
}

#[test]
fn the_guard_reports_what_the_start_did_not_show() {
    let start = |system: &Bumper| State::from_velocity(system, [-4.0], [1.0]).unwrap();
    let run = |k| {
        let system = Bumper { k };
        let choice = Method::for_tolerance(&system, Trapezoidal, &start(&system), 8.0, 1e-6).unwrap();
        let mut run = choice.trajectory(&system, Trapezoidal, start(&system));
        // The impact may also end the run.
        let _ = run.by_ref().all(|state| state.is_ok());
        run.breach().copied()
    };
    // Around t = 4 it meets the spring.
    let breach = run(1.0).expect("the spring makes the estimate void");
    assert!(breach.expected > 1e-6 && (3.0..5.5).contains(&breach.time), "{breach}");
    assert!(breach.to_string().contains("no longer holds at t = "));
    // Positive control: without the spring the estimate holds.
    assert_eq!(run(0.0), None);
}

#[test]
fn what_cannot_be_had_is_refused() {
    let system = Pendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.9], [-0.7]).unwrap();
    let ask = |time, tolerance| Method::for_tolerance(&system, Trapezoidal, &start, time, tolerance);
    assert!(matches!(ask(16.0, 0.0), Err(ToleranceError::Request { .. })));
    assert!(matches!(ask(f64::NAN, 1e-3), Err(ToleranceError::Request { .. })));
    let error = ask(16.0, 1e-17).unwrap_err();
    assert!(matches!(error, ToleranceError::OutOfReach { .. }), "{error}");
    assert!(error.to_string().starts_with("no method reaches the tolerance"));
}
