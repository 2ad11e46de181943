//! Order and step size from a requested error: reached, explained, and watched over along the run.

use dalembert::nalgebra::SVector;
use dalembert::{
    Lagrangian, Method, Methods, State, ToleranceError, Trapezoidal, WithGauss, WithSplittings,
    rayleigh_system,
};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::reference;
use dalembert_tests::systems::{Chain, DoublePendulum, Pendulum};

/// The error at the end of the choice for `tolerance`, and whether its guard stayed silent.
fn reached<L, const N: usize>(system: &L, start: [[f64; N]; 2], time: f64, tolerance: f64) -> (f64, Method)
where
    L: ByHand<N> + Lagrangian<N, Scalar = f64>,
    Trapezoidal: Methods<L, N>,
{
    reached_among(system, Trapezoidal, start, time, tolerance)
}

fn reached_among<L, M, const N: usize>(
    system: &L,
    methods: M,
    [q, v]: [[f64; N]; 2],
    time: f64,
    tolerance: f64,
) -> (f64, Method)
where
    L: ByHand<N> + Lagrangian<N, Scalar = f64>,
    M: Methods<L, N>,
{
    let (q_end, _) = reference::motion(system, q, v, time);
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let choice = Method::for_tolerance(system, methods, &start, time, tolerance).unwrap();
    let mut run = choice.trajectory(system, methods, start);
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
fn gauss_methods_are_considered_where_they_are_offered() {
    let pendulum = [[1.9], [-0.7]];
    let chain = [[0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]];
    let arms = [[0.8, -0.4], [0.0, 0.5]];
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11] {
        let among = WithGauss(Trapezoidal);
        let of_pendulum = reached_among(&Pendulum::EXAMPLE, among, pendulum, 16.0, tolerance);
        let of_chain = reached_among(&Chain::EXAMPLE, among, chain, 16.0, tolerance);
        let of_arms = reached_among(&DoublePendulum::EXAMPLE, among, arms, 16.0, tolerance);
        for (error, method) in [of_pendulum, of_chain, of_arms] {
            assert!(error <= tolerance, "{method}: {error:e} for {tolerance:e}");
            if tolerance < 1e-8 {
                assert!(matches!(method, Method::Gauss4 | Method::Gauss8), "{method} for {tolerance:e}");
            }
        }
    }
    // Positive control: where they are not asked for, they are not chosen.
    assert_eq!(reached(&Pendulum::EXAMPLE, pendulum, 16.0, 1e-9).1, Method::KahanLi8);
}

#[test]
fn splittings_are_considered_where_they_are_offered() {
    let pendulum = [[1.9], [-0.7]];
    let among = WithGauss(WithSplittings(Trapezoidal));
    for (tolerance, is_split) in [(1e-3, true), (1e-5, true), (1e-6, true), (1e-11, false)] {
        let (error, method) = reached_among(&Pendulum::EXAMPLE, among, pendulum, 16.0, tolerance);
        assert!(error <= tolerance, "{method}: {error:e} for {tolerance:e}");
        let found = matches!(method, Method::BlanesMoan4 | Method::BlanesMoan6);
        assert_eq!(found, is_split, "{method} for {tolerance:e}");
        // Positive control: where they are not asked for, they are not chosen.
        let (_, method) =
            reached_among(&Pendulum::EXAMPLE, WithGauss(Trapezoidal), pendulum, 16.0, tolerance);
        assert!(!matches!(method, Method::BlanesMoan4 | Method::BlanesMoan6));
    }
}

#[test]
fn a_choice_with_gauss_methods_says_why_and_keeps_the_step() {
    let system = Pendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.9], [-0.7]).unwrap();
    let among = WithGauss(WithSplittings(Trapezoidal));
    let choice = Method::for_tolerance(&system, among, &start, 16.0, 1e-9).unwrap();
    assert_eq!(choice.trials.map(|trial| trial.unwrap().method), Method::ALL);
    let text = choice.to_string();
    for part in
        ["\n  order 8, Gauss with 4 stages: h = ", "\n  order 16, Gauss with 8 stages: h = ", "order 8 in 17"]
    {
        assert!(text.contains(part), "{part} in {text}");
    }
    // One step size from start to end: the method is symplectic where there is no force.
    let mut run = choice.trajectory(&system, among, start);
    for taken in 1..=choice.steps {
        run.next().unwrap().unwrap();
        assert_eq!(run.time(), choice.step_size * taken as f64);
    }
    assert!(run.next().is_none());
}

#[test]
fn the_guard_watches_gauss_methods_too() {
    let start = |system: &Bumper| State::from_velocity(system, [-4.0], [1.0]).unwrap();
    let run = |k| {
        let (system, among) = (Bumper { k }, WithGauss(Trapezoidal));
        let choice = Method::for_tolerance(&system, among, &start(&system), 8.0, 1e-9).unwrap();
        assert!(matches!(choice.method, Method::Gauss4 | Method::Gauss8), "{choice}");
        let mut run = choice.trajectory(&system, among, start(&system));
        // The impact may also end the run.
        let failed = !run.by_ref().all(|state| state.is_ok());
        (run.breach().copied(), failed, run.time())
    };
    // Around t = 4 it meets the spring.
    let (breach, failed, time) = run(1.0);
    assert!(breach.is_some_and(|breach| breach.expected > 1e-9) || (failed && (2.0..6.0).contains(&time)));
    // Positive control: without the spring the estimate holds.
    assert_eq!(run(0.0).0, None);
}

#[test]
fn a_choice_says_why() {
    let system = Pendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.9], [-0.7]).unwrap();
    let choice = Method::for_tolerance(&system, Trapezoidal, &start, 16.0, 1e-8).unwrap();
    let trials: Vec<_> = choice.trials.iter().flatten().collect();
    assert_eq!(trials.iter().map(|trial| trial.method).collect::<Vec<_>>(), Method::ALL[..3]);
    let chosen = trials.iter().find(|trial| trial.method == choice.method).unwrap();
    assert!(trials.iter().all(|trial| trial.substeps >= chosen.substeps || trial.expected > 1e-8));
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
#[rayleigh_system(rule = [trapezoidal, gauss])]
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
