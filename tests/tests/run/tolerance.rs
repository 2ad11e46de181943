//! Order and step size from a requested error: kept or said not to be, explained, and watched over along the
//! run.

use dalembert::nalgebra::{SVector, vector};
use dalembert::tolerance::{
    Method, MethodStep, Methods, OffersMethods, ToleranceError, WithGauss, WithSplittings,
};
use dalembert::{Discretise, Gauss, Lagrangian, State, Trapezoidal, rayleigh_system};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::reference;
use dalembert_tests::systems::{Chain, DoublePendulum, Pendulum};

/// The length of the motions of [`Motion`].
const TIME: f64 = if cfg!(debug_assertions) { 8.0 } else { 16.0 };

/// A motion from its start to [`TIME`], by the reference.
struct Motion<'a, L, const N: usize> {
    system: &'a L,
    start: State<f64, N>,
    q_end: SVector<f64, N>,
}

impl<'a, L: ByHand<N>, const N: usize> Motion<'a, L, N> {
    fn new(system: &'a L, [q, v]: [[f64; N]; 2]) -> Self {
        let (q_end, _) = reference::motion(system, q, v, TIME);
        Self { system, start: State { q: q.into(), p: system.momentum(q, v) }, q_end: q_end.into() }
    }
}

/// The error at the end of the choice for `tolerance` and its method; one that is passed has to be reported.
fn reached_among<L, M, const N: usize>(motion: &Motion<'_, L, N>, methods: M, tolerance: f64) -> (f64, Method)
where
    L: ByHand<N> + OffersMethods<N> + Lagrangian<N, Scalar = f64>,
    M: Methods<L, N>,
{
    let choice = motion.system.to_error(tolerance).among(methods).until(TIME).choice(&motion.start).unwrap();
    let mut run = choice.trajectory();
    let end = run.by_ref().last().unwrap().unwrap().state;
    assert!((run.time() - TIME).abs() < 1e-9 * TIME, "the run ends at {}", run.time());
    let error = (end.q - motion.q_end).amax();
    assert!(error <= tolerance || run.breach().is_some(), "{error:e}\n{choice}");
    // What is reported is no error of the choice's method.
    (if run.breach().is_some() { error.min(tolerance) } else { error }, choice.method())
}

const CHAIN: [[f64; 5]; 2] = [[0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]];
const PENDULUM: [[f64; 1]; 2] = [[1.9], [-0.7]];

#[test]
fn a_step_of_all_stages_by_newtons_method_is_charged_as_such() {
    let start = State { q: [1.0].into(), p: [0.0].into() };
    let evaluations = |h: f64| {
        let mut step = Methods::<Oscillator, 1>::step(WithGauss(Trapezoidal), Method::Gauss8, h).unwrap();
        step.advance(&Oscillator {}, 0.0, &start).unwrap().evaluations
    };
    // The fixed point contracts: its iterations times the stages.
    assert_eq!(evaluations(0.3) % 8.0, 0.0);
    // It does not: derivatives before the first iteration and after it, and a matrix.
    assert!(evaluations(4.0) >= 8.0 * 4.0, "{}", evaluations(4.0));
    assert_ne!(evaluations(4.0) % 8.0, 0.0);
}

/// ½v² − ½q².
#[rayleigh_system(rule = [trapezoidal, gauss])]
fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
}

#[test]
fn the_whole_state_is_held_at_every_step_from_any_phase() {
    let (among, tolerance, time) =
        (WithGauss(WithSplittings(Trapezoidal)), 1e-7, 32.0 * std::f64::consts::PI);
    for phase in 0..25 {
        let phase = f64::from(phase) * std::f64::consts::TAU / 24.0;
        let start = State { q: [phase.cos()].into(), p: [-phase.sin()].into() };
        let choice = Oscillator {}.to_error(tolerance).among(among).until(time).choice(&start).unwrap();
        let mut run = choice.trajectory();
        while let Some(state) = run.next() {
            let (s, c) = run.time().sin_cos();
            let state = state.unwrap().state;
            let exact = [start.q[0] * c + start.p[0] * s, start.p[0] * c - start.q[0] * s];
            let error = (state.q[0] - exact[0]).abs().max((state.p[0] - exact[1]).abs());
            assert!(error <= 2.0 * tolerance, "{error:e} at {} of {choice}", run.time());
            assert!(run.expected() <= 20.0 * tolerance);
        }
        assert_eq!(run.breach(), None, "{choice}");
        // Positive control: a step twice as long does not keep it.
        let h = 4.0 * choice.step_size();
        let mut step = Methods::<Oscillator, 1>::step(among, choice.method(), h).unwrap();
        let (mut state, mut worst) = (start, 0.0_f64);
        for k in 1..=choice.steps() / 4 {
            state = step.advance(&Oscillator {}, 0.0, &state).unwrap().step.state;
            let (s, c) = (h * k as f64).sin_cos();
            worst = worst.max((state.q[0] - start.q[0] * c - start.p[0] * s).abs());
        }
        assert!(worst > tolerance, "{worst:e}");
    }
}

#[test]
fn the_error_asked_for_is_reached_and_not_by_brute_force() {
    let all = [1e-4, 1e-6, 1e-2, 1e-8, 1e-10];
    let pendulum = Motion::new(&Pendulum::EXAMPLE, PENDULUM);
    let chain = Motion::new(&Chain::EXAMPLE, CHAIN);
    for &tolerance in &all[..if cfg!(debug_assertions) { 2 } else { 5 }] {
        let (error, _) = reached_among(&pendulum, Trapezoidal, tolerance);
        assert!(error <= tolerance, "pendulum: {error:e} for {tolerance:e}");
        let (error, _) = reached_among(&chain, Trapezoidal, tolerance);
        assert!(error <= tolerance, "chain: {error:e} for {tolerance:e}");
        // Not smaller by many orders either: the step was not just taken tiny.
        assert!(error >= 1e-5 * tolerance, "chain: {error:e} for {tolerance:e}");
    }
}

#[test]
fn small_errors_want_high_order() {
    let pendulum = Motion::new(&Pendulum::EXAMPLE, PENDULUM);
    let method = |tolerance| reached_among(&pendulum, Trapezoidal, tolerance).1;
    assert_eq!(method(1e-10), Method::KahanLi8);
    assert_ne!(method(1e-2), Method::KahanLi8);
}

#[test]
fn gauss_methods_are_considered_where_they_are_offered() {
    let arms = [[0.8, -0.4], [0.0, 0.5]];
    let all = [1e-5, 1e-9, 1e-3, 1e-7, 1e-11];
    let pendulum = Motion::new(&Pendulum::EXAMPLE, PENDULUM);
    let chain = Motion::new(&Chain::EXAMPLE, CHAIN);
    let arms = Motion::new(&DoublePendulum::EXAMPLE, arms);
    for &tolerance in &all[..if cfg!(debug_assertions) { 2 } else { 5 }] {
        let among = WithGauss(Trapezoidal);
        for (error, method) in [
            reached_among(&pendulum, among, tolerance),
            reached_among(&chain, among, tolerance),
            reached_among(&arms, among, tolerance),
        ] {
            assert!(error <= tolerance, "{method}: {error:e} for {tolerance:e}");
            if tolerance < 1e-8 {
                assert!(matches!(method, Method::Gauss4 | Method::Gauss8), "{method} for {tolerance:e}");
            }
        }
    }
    // Positive control: where they are not asked for, they are not chosen.
    assert_eq!(reached_among(&pendulum, Trapezoidal, 1e-9).1, Method::KahanLi8);
}

fn is_splitting(method: Method) -> bool {
    matches!(method, Method::BlanesMoan4 | Method::BlanesMoan6 | Method::BlanesCasasEscorihuela8)
}

#[test]
fn splittings_are_considered_where_they_are_offered() {
    let among = WithGauss(WithSplittings(Trapezoidal));
    let pendulum = Motion::new(&Pendulum::EXAMPLE, PENDULUM);
    for (tolerance, is_split) in [(1e-3, true), (1e-5, true), (1e-6, true), (1e-11, false)] {
        let (error, method) = reached_among(&pendulum, among, tolerance);
        assert!(error <= tolerance, "{method}: {error:e} for {tolerance:e}");
        assert_eq!(is_splitting(method), is_split, "{method} for {tolerance:e}");
        // Positive control: where they are not asked for, they are not chosen.
        let (_, method) = reached_among(&pendulum, WithGauss(Trapezoidal), tolerance);
        assert!(!is_splitting(method));
    }
}

/// The attraction of a centre.
#[rayleigh_system(rule = [trapezoidal, gauss])]
fn planet(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
}

#[test]
fn the_splitting_of_order_8_is_chosen_where_it_is_the_cheapest() {
    let start = State { q: vector![0.5, 0.0], p: vector![0.0, 3.0_f64.sqrt()] };
    let system = Planet {};
    let choice = system.to_error(1e-6).until(100.0).choice(&start).unwrap();
    assert_eq!(choice.method(), Method::BlanesCasasEscorihuela8, "{choice}");
    let mut run = choice.trajectory();
    let end = run.by_ref().last().unwrap().unwrap().state;
    let exact = system.by(Gauss::<8>, 0.05).run(start).nth(1999).unwrap().unwrap().state;
    assert!(run.breach().is_none() && (end.q - exact.q).amax() < 1e-6, "{choice}");
    // Control: for a thousand times the error it is not.
    let loose = system.to_error(1e-3).until(100.0).choice(&start).unwrap();
    assert_ne!(loose.method(), Method::BlanesCasasEscorihuela8, "{loose}");
}

/// From the pericentre outwards a motion is smoother at every step: a choice that looks at what follows the
/// start alone takes steps that the start does not bear.
#[test]
fn from_the_pericentre_the_error_asked_for_is_kept() {
    let among = WithGauss(WithSplittings(Trapezoidal));
    for (e, tolerance) in [(0.6, 1e-6), (0.8, 1e-4), (0.8, 1e-8), (0.9, 1e-6)] {
        let f = f64::sqrt((1.0 + e) / (1.0 - e));
        let start = State { q: [1.0 - e, 0.0].into(), p: [0.0, f].into() };
        // Three orbits, of 2π each: the end is the start.
        let time = 6.0 * std::f64::consts::PI;
        let choice = Planet {}.to_error(tolerance).among(among).until(time).choice(&start).unwrap();
        let mut run = choice.trajectory();
        let end = run.by_ref().last().unwrap().unwrap().state;
        let error = (end.q - start.q).amax();
        assert!(error <= tolerance, "{error:e}\n{choice}");
        // Positive control: judged as a choice judges, by a step beside two halves of it, the way out alone
        // errs by a fraction of what the start does; and steps longer by 1.5, three times over, as it then
        // asked for, miss the error by far.
        let step = |h| Methods::<Planet, 2>::step(among, choice.method(), h).unwrap();
        let advanced = |h, state: &_| step(h).advance(&Planet {}, 0.0, state).unwrap().step.state;
        let local = |h: f64, state: &_| {
            let halves = advanced(0.5 * h, &advanced(0.5 * h, state));
            (advanced(h, state).q - halves.q).amax()
        };
        let h = choice.step_size();
        let (mut state, mut way_out) = (start, 0.0);
        for _ in 0..6 {
            state = advanced(h, &state);
            way_out += local(h, &state) / 6.0;
        }
        let at_start = local(h, &start);
        assert!(way_out < at_start / 4.0, "{way_out:e}, {at_start:e} at the start");
        let steps = (choice.steps() as f64 / 1.5_f64.powi(3)).ceil();
        let end = (0..steps as u64).fold(start, |state, _| advanced(time / steps, &state));
        let missed = (end.q - start.q).amax();
        assert!(missed > 1e3 * tolerance, "{missed:e} in {steps} steps\n{choice}");
    }
}

/// Once around ellipses from any phase, of which a start near the apocentre shows nothing of the pericentre.
#[test]
fn the_end_asked_for_is_reached_from_any_phase() {
    let among = WithGauss(WithSplittings(Trapezoidal));
    let time = std::f64::consts::TAU;
    let (mut again, mut missed, mut runs) = (0, 0, 0);
    let every = if cfg!(debug_assertions) { 2 } else { 1 };
    for k in (0..12).step_by(every) {
        // Eccentric anomaly and eccentricity.
        let (angle, e) = (0.55 * f64::from(k), 0.3 + 0.04 * f64::from(k));
        let b = f64::sqrt(1.0 - e * e);
        let (sine, cosine) = angle.sin_cos();
        let per_r = 1.0 / (1.0 - e * cosine);
        let start = State { q: [cosine - e, b * sine].into(), p: [-sine * per_r, b * cosine * per_r].into() };
        let error = |end: &State<f64, 2>| (end.q - start.q).amax();
        for tolerance in [1e-4, 1e-9] {
            let request = Planet {}.to_error(tolerance).among(among).until(time);
            let reached = request.end(&start).unwrap();
            assert!(
                error(&reached.state) <= 2.0 * tolerance,
                "{:e}, {}",
                error(&reached.state),
                reached.choice
            );
            assert!(reached.expected <= 1.35 * tolerance, "{:e}", reached.expected);
            runs += reached.runs;
            // The run once more, step by step.
            let mut run = reached.choice.trajectory();
            assert_eq!(run.by_ref().last().unwrap().unwrap().state, reached.state);
            assert!(run.breach().is_none() && (run.time() - time).abs() < 1e-12);
            // Positive control: some first choices miss the error, and it is those that another run follows.
            let mut first = request.run(start).unwrap();
            let end = first.by_ref().last().unwrap().unwrap().state;
            assert_eq!(first.breach().is_some(), reached.runs > 1);
            again += u32::from(reached.runs > 1);
            missed += u32::from(error(&end) > tolerance);
        }
    }
    let every = every as u32;
    assert!(every * again >= 6 && every * missed >= 4, "{again}, {missed}");
    // A second run, as a rule, or a third.
    assert!(every * runs <= 3 * 24, "{runs}");
}

#[test]
fn an_end_that_no_run_keeps_is_an_error() {
    // A kink at which every method is of order 1.
    #[rayleigh_system(rule = [trapezoidal, gauss])]
    fn kink(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0].abs()
    }
    let start = State { q: [1.0].into(), p: [0.0].into() };
    let request = |tolerance| Kink {}.to_error(tolerance).until(6.0).end(&start);
    let tolerance = if cfg!(debug_assertions) { 1e-8 } else { 1e-10 };
    let Err(dalembert::tolerance::ToleranceError::Breach(breach)) = request(tolerance) else {
        panic!("{:?}", request(tolerance).map(|reached| reached.runs))
    };
    assert!(breach.tolerance == tolerance && breach.expected > tolerance && breach.time > 1.0);
    // What is no request is none.
    assert!(matches!(request(-1.0), Err(dalembert::tolerance::ToleranceError::Request { .. })));
    // Control: without the kink there is an end.
    assert!(Oscillator {}.to_error(tolerance).until(6.0).end(&start).is_ok());
}

#[test]
fn a_choice_says_why_and_keeps_the_step() {
    let system = Pendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.9], [-0.7]).unwrap();
    let among = WithGauss(WithSplittings(Trapezoidal));
    let choice = system.to_error(1e-9).among(among).until(1600.0).choice(&start).unwrap();
    // Of the methods tried, in their order, the cheapest that reaches the error.
    let trials: Vec<_> = choice.trials().copied().collect();
    let place = |method| Method::ALL.iter().position(|&of| of == method).unwrap();
    assert!(trials.len() >= 2 && trials.is_sorted_by_key(|trial| place(trial.method)));
    let chosen = trials.iter().find(|trial| trial.method == choice.method()).unwrap();
    assert!(trials.iter().all(|trial| trial.evaluations >= chosen.evaluations || trial.expected > 1e-9));
    assert!((choice.step_size() * choice.steps() as f64 - 1600.0).abs() < 1e-9);
    let text = choice.to_string();
    for part in [", h = ", "1.0e-9 asked for", "\n  order 16, Gauss with 8 stages: h = "] {
        assert!(text.contains(part), "{part} in {text}");
    }
    // One step size from start to end: the method is symplectic where there is no force.
    let mut run = choice.trajectory();
    for taken in 1..=choice.steps() {
        run.next().unwrap().unwrap();
        assert_eq!(run.time(), choice.step_size() * taken as f64);
    }
    assert!(run.next().is_none());
}

#[test]
fn choosing_costs_a_tenth_of_a_long_run_and_the_guard_as_much() {
    let start = State { q: [1.0].into(), p: [0.0].into() };
    let all = [1e-3, 1e-7, 1e-5, 1e-9];
    for &tolerance in &all[..if cfg!(debug_assertions) { 2 } else { 4 }] {
        let among = WithSplittings(Trapezoidal);
        let choice = Oscillator {}.to_error(tolerance).among(among).until(4000.0).choice(&start).unwrap();
        let mut run = choice.trajectory();
        assert!(run.by_ref().all(|state| state.is_ok()) && run.breach().is_none(), "{choice}");
        let (steps, looks) = run.evaluations();
        assert!(choice.steps() > 100 && choice.evaluations() <= 0.1 * steps, "{choice}");
        assert!(0.0 < looks && looks <= 0.12 * steps, "{looks} beside {steps} of {choice}");
    }
}

#[test]
fn steps_are_not_bound_to_a_share_of_the_time() {
    let start = State { q: [1.0].into(), p: [0.0].into() };
    let among = WithGauss(WithSplittings(Trapezoidal));
    let choice = Oscillator {}.to_error(1e-6).among(among).until(6.0).choice(&start).unwrap();
    assert!(choice.steps() < 20, "{choice}");
}

/// A pendulum that starts at rest far out, where nothing happens, and later meets a stiff spring.
#[rayleigh_system(rule = [trapezoidal, gauss])]
fn bumper(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    0.5 * v[0] * v[0] - k * (40.0 * q[0]).exp() / 1600.0 - 1e-2 * q[0] * q[0]
}

fn guard_reports_the_spring<M>(among: M, tolerance: f64)
where
    M: Methods<Bumper, 1>,
{
    let run = |k| {
        let system = Bumper { k };
        let start = State::from_velocity(&system, [-4.0], [1.0]).unwrap();
        let choice = system.to_error(tolerance).among(among).until(8.0).choice(&start).unwrap();
        let mut run = choice.trajectory();
        // The impact may also end the run.
        let failed = !run.by_ref().all(|state| state.is_ok());
        (run.breach().copied(), failed, run.time())
    };
    // Around t = 4 it meets the spring.
    let (breach, failed, time) = run(1.0);
    match breach {
        Some(breach) => {
            assert!(breach.expected > tolerance && breach.time > 2.0, "{breach}");
            assert!(breach.instead <= 0.5 * tolerance);
            assert!(breach.to_string().contains("is to be expected"));
        }
        None => assert!(failed && (2.0..6.0).contains(&time), "{failed} {time}"),
    }
    // Positive control: without the spring the estimate holds.
    assert_eq!(run(0.0).0, None);
}

#[test]
fn the_guard_reports_what_the_start_did_not_show() {
    guard_reports_the_spring(Trapezoidal, 1e-6);
    guard_reports_the_spring(WithGauss(Trapezoidal), 1e-9);
}

#[test]
fn what_cannot_be_had_is_refused() {
    let system = Pendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.9], [-0.7]).unwrap();
    let ask = |time, tolerance| system.to_error(tolerance).among(Trapezoidal).until(time).choice(&start);
    assert!(matches!(ask(16.0, 0.0), Err(ToleranceError::Request { .. })));
    assert!(matches!(ask(f64::NAN, 1e-3), Err(ToleranceError::Request { .. })));
    let error = ask(16.0, 1e-17).unwrap_err();
    assert!(matches!(error, ToleranceError::OutOfReach { .. }), "{error}");
    assert!(error.to_string().starts_with("no method reaches the tolerance"));
}

#[test]
fn a_method_that_is_not_offered_has_no_step() {
    assert!(Methods::<Oscillator, 1>::step(Trapezoidal, Method::Gauss8, 0.1).is_none());
    assert!(Methods::<Oscillator, 1>::step(WithGauss(Trapezoidal), Method::Gauss8, 0.1).is_some());
}
