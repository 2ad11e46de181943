//! A tolerance, with what the start does not show: drives of any frequency, forces that come and go,
//! and work that has no end.

use std::f64::consts::TAU;

use dalembert::tolerance::{GuardedTrajectory, ToleranceError};
use dalembert::{Discretise, State, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A mass that is pushed for a while, on a spring or free.
struct Pushed {
    k: f64,
    force: f64,
    from: f64,
    to: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Pushed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [if t >= self.from && t < self.to { self.force } else { 0.0 }]
    }
}

impl Pushed {
    /// q after the push, from rest at 0.
    fn exact(&self, t: f64) -> f64 {
        let (a, b) = (t - self.from, t - self.to);
        let omega = self.k.sqrt();
        match omega {
            0.0 => 0.5 * self.force * (a * a - b * b),
            _ => self.force / self.k * ((omega * b).cos() - (omega * a).cos()),
        }
    }
}

#[test]
fn steps_end_where_a_force_jumps() {
    let (mut draws, mut passed, mut nearly) = (Draws::new(11), 0, 0);
    for case in 0..if cfg!(debug_assertions) { 20 } else { 200 } {
        let (from, width, force) = (draws.between(0.5, 8.0), draws.scale(1e-3, 1.0), draws.scale(0.1, 30.0));
        let (k, power) = (if case % 3 == 0 { 0.0 } else { draws.between(0.1, 9.0) }, 3 + case % 8);
        let (pushed, tolerance) = (Pushed { k, force, from, to: from + width }, 10_f64.powi(-power));
        let system = pushed.at_time(0.0);
        let start = State { q: [0.0].into(), p: [0.0].into() };
        let request = system.to_error(tolerance).until(10.0);
        let exact = pushed.exact(10.0);
        let reached = request.breaking_at([from + width, from, 12.0]).end(&start).unwrap();
        let error = (reached.state.q[0] - exact).abs();
        assert!(error <= 2.0 * tolerance, "{error:e} for {tolerance:e}, {from} {width} {force} {k}");
        nearly += usize::from(error > tolerance);
        // By steps as long as a third of the push it is seen: kept, or said not to be.
        if width > 0.05 {
            let mut run = request.longest_step(width / 3.0).run(start).unwrap();
            let end = run.by_ref().last().unwrap().unwrap().state;
            let error = (end.q[0] - exact).abs();
            assert!(error <= 2.0 * tolerance || run.breach().is_some(), "{error:e} for {tolerance:e}");
            passed += usize::from(error > 2.0 * tolerance);
        }
    }
    // Positive control: steps over the jumps err by more.
    assert!(passed > 3, "{passed}");
    // The page counts 14 of 1 000 runs like that.
    assert!(nearly <= 2, "{nearly}");
}

/// A comet from its apocentre, with a thrust that jumps on the way.
struct Thrust {
    thrust: f64,
    from: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Thrust {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
    }
    fn force(&self, _q: [f64; 2], _v: [f64; 2], t: f64) -> [f64; 2] {
        [0.0, if t > self.from { self.thrust } else { 0.0 }]
    }
}

#[test]
fn a_jump_beside_the_hardest_steps_is_no_error_of_theirs() {
    let start = State { q: [-1.8, 0.0].into(), p: [0.0, -1.0 / 3.0].into() };
    let (mut draws, mut again) = (Draws::new(12), 0);
    for _ in 0..if cfg!(debug_assertions) { 10 } else { 60 } {
        // Around the pericentre, which is passed at π.
        let from = draws.between(0.5 * TAU - 0.02, 0.5 * TAU + 0.1);
        let ask = |thrust: f64| {
            let thrust = Thrust { thrust, from };
            let system = thrust.at_time(0.0);
            let reached = system.to_error(1e-9).until(4.0).breaking_at([from]).end(&start).unwrap();
            (reached.runs, reached.choice.step_size())
        };
        let (of_jump, without) = (ask(3.0), ask(0.0));
        again += usize::from(without.0 > 1);
        let ratio = without.1 / of_jump.1;
        assert!(ratio < 1.5, "thrust from {from}: steps of {of_jump:?}, of {without:?} without");
    }
    // The hardest steps were tried in these.
    assert!(again > 5, "{again}");
}

#[test]
fn a_run_with_breaks_goes_on_from_a_checkpoint_bit_by_bit() {
    let pushed = Pushed { k: 2.0, force: 3.0, from: 2.0, to: 2.7 };
    let system = pushed.at_time(0.0);
    let start = State { q: [0.4].into(), p: [0.0].into() };
    let mut run =
        system.to_error(1e-7).until(10.0).breaking_at([2.0, 2.7]).longest_step(0.05).run(start).unwrap();
    for taken in 1_u64.. {
        let Some(step) = run.next() else { break };
        step.unwrap();
        if taken % 17 == 0 {
            let checkpoint = run.checkpoint();
            let mut resumed = GuardedTrajectory::resume(&system, &checkpoint).unwrap();
            assert!(resumed.by_ref().take(60).eq(run.by_ref().take(60)));
            assert_eq!((resumed.time(), resumed.expected()), (run.time(), run.expected()));
        }
    }
    assert_eq!(run.time(), 10.0);
}

#[test]
fn a_motion_that_never_begins_is_no_verdict() {
    let still = Pushed { k: 1.0, force: 0.0, from: 2.0, to: 3.0 };
    let start = State { q: [0.0].into(), p: [0.0].into() };
    let ask = |pushed: &Pushed| {
        pushed.at_time(0.0).to_error(1e-6).until(10.0).end(&start).map(|reached| reached.expected)
    };
    let error = ask(&still).unwrap_err();
    assert!(matches!(error, ToleranceError::NothingMoves { looks: 256, .. }), "{error}");
    assert!(error.to_string().contains("breaking_at"));
    // A pulse of a thousandth of the time falls between the looks, and is not taken for rest.
    let short = Pushed { k: 1.0, force: 1.0, from: 2.003, to: 2.004 };
    assert!(matches!(ask(&short), Err(ToleranceError::NothingMoves { .. } | ToleranceError::Breach(_))));
    // Who says how long a step may be has looked there.
    let view = still.at_time(0.0);
    let bounded = view.to_error(1e-6).until(10.0).longest_step(0.5).end(&start).unwrap();
    assert_eq!(bounded.state, start);
    // A drive that is seen, and moves nothing at rest, is no reason to refuse.
    let rocked = Rocked { a: 0.4, frequency: 7.0 };
    let view = rocked.at_time(0.0);
    assert_eq!(view.to_error(1e-6).until(10.0).end(&start).unwrap().state, start);
    // Rest of a system that takes no time is known.
    let rest = Pendulum {}.to_error(1e-6).until(10.0).end(&start).unwrap();
    assert_eq!(rest.expected, 0.0);
}

/// A mass on a spring whose stiffness changes with time.
struct Rocked {
    a: f64,
    frequency: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Rocked {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * (1.0 + self.a * (self.frequency * t).cos()) * q[0] * q[0]
    }
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] + q[0].cos()
}

/// A mass of m hung from one of 1.
#[rayleigh_system(rule = [trapezoidal, gauss])]
fn light(q: [f64; 2], v: [f64; 2], m: f64) -> f64 {
    let stretch = q[0] - q[1];
    0.5 * v[0] * v[0] + 0.5 * m * v[1] * v[1] - 0.5 * stretch * stretch - 0.5 * q[0] * q[0]
}

#[test]
fn work_is_bounded_and_the_error_says_by_how_much_it_is_too_much() {
    let system = Light { m: 1e-11 };
    let start = State::from_velocity(&system, [1.0, 0.0], [0.0, 0.0]).unwrap();
    let request = system.to_error(1e-6).until(1000.0);
    let error = request.end(&start).unwrap_err();
    let ToleranceError::TooManySteps { needed, steps, most: 10_000_000, rate } = error else {
        panic!("{error}")
    };
    assert!(
        (1e7..1e10).contains(&steps) && (needed.step_size * steps / 1000.0 - 1.0).abs() < 1e-9,
        "{error}"
    );
    assert!((rate / 1e11_f64.sqrt()).log10().abs() < 0.5, "{error}");
    // What is allowed is taken.
    let heavier = Light { m: 1e-4 };
    let request = heavier.to_error(1e-4).until(10.0);
    let steps = request.choice(&start).unwrap().steps();
    assert!(request.at_most(steps).choice(&start).is_ok());
    assert!(matches!(request.at_most(steps / 8).end(&start), Err(ToleranceError::TooManySteps { .. })));
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
fn kepler(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
}

#[test]
fn work_is_bounded_and_all_runs_of_an_end_count_together() {
    // From the apocentre: the first run passes its error at the pericentre.
    let start = State::from_velocity(&Kepler {}, [-1.6, 0.0], [0.0, -0.5]).unwrap();
    let request = Kepler {}.to_error(1e-8).until(20.0);
    let reached = request.end(&start).unwrap();
    let (choice, all) = (request.choice(&start).unwrap(), reached.evaluations);
    assert_eq!(reached.runs, 2, "{}", reached.choice);
    let first = choice.trials().find(|trial| trial.method == choice.method()).unwrap().evaluations;
    assert!(first < 0.5 * all);
    assert!(request.at_most_evaluations(2.0 * first).choice(&start).is_ok());
    assert!(request.at_most_evaluations(1.01 * all).end(&start).is_ok());
    let steps = [choice.steps(), reached.choice.steps()];
    assert!(request.at_most(steps[0] + steps[1]).end(&start).is_ok());
    // Enough for each run alone.
    assert!(matches!(request.at_most(steps[0].max(steps[1])).end(&start), Err(ToleranceError::Breach(_))));
    // No second run: the error of the first.
    assert!(matches!(request.at_most_evaluations(2.0 * first).end(&start), Err(ToleranceError::Breach(_))));
    let error = request.at_most_evaluations(0.1 * first).choice(&start).unwrap_err();
    let ToleranceError::TooManyEvaluations { needed, most, .. } = error else { panic!("{error}") };
    assert!(
        most == 0.1 * first && needed.evaluations > most && error.to_string().contains("at_most_evaluations")
    );
    let error = request.at_most_evaluations(f64::NAN).choice(&start).unwrap_err();
    assert!(matches!(error, ToleranceError::MostEvaluations { most } if most.is_nan()));
}

#[test]
fn a_passage_that_the_start_does_not_show_takes_a_second_run_and_no_third() {
    for eccentricity in [0.3_f64, 0.4, 0.5, 0.6, 0.7] {
        let speed = ((1.0 - eccentricity) / (1.0 + eccentricity)).sqrt();
        let start = State::from_velocity(&Kepler {}, [-1.0 - eccentricity, 0.0], [0.0, -speed]).unwrap();
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let reached = Kepler {}.to_error(tolerance).until(2.0 * TAU).end(&start).unwrap();
            assert!((reached.state.q - start.q).amax() < tolerance, "{eccentricity} {tolerance:e}");
            assert!(reached.runs <= 2, "{eccentricity} {tolerance:e}: {}", reached.runs);
        }
    }
}

/// A mass at rest that a force takes hold of smoothly.
struct Seized {
    at: f64,
    rate: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Seized {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [0.5 + 0.5 * (self.rate * (t - self.at)).tanh()]
    }
}

#[test]
fn a_push_that_comes_later_is_no_reason_to_refuse() {
    let mut draws = Draws::new(12);
    for case in 0..20 {
        let (at, rate, power) = (draws.between(2.0, 9.0), draws.scale(1.0, 8.0), 2 + case % 10);
        let (seized, tolerance) = (Seized { at, rate }, 10_f64.powi(-power));
        let system = seized.at_time(0.0);
        let start = State { q: [0.0].into(), p: [0.0].into() };
        let reached = system.to_error(tolerance).until(10.0).end(&start).unwrap();
        let mut exact = system.by(dalembert::Gauss::<8>, 2e-2).run(start);
        let exact = exact.until(10.0).last().unwrap().unwrap().state;
        assert!((reached.state.q[0] - exact.q[0]).abs() <= tolerance, "{tolerance:e}, {at} {rate}");
    }
}
