//! Events: their times to rounding on closed forms, where they begin and end, what follows them.

use std::f64::consts::{PI, TAU};

use dalembert::nalgebra::{SVector, Vector2, vector};
use dalembert::run::between::{Divisible, Restartable};
use dalembert::run::events::{Crossing, Event, EventError, EventGradient, Passage, Watch, Watched};
use dalembert::run::{HeldInput, Run};
use dalembert::step::{Flow, Step};
use dalembert::tolerance::{LastStep, Method, MethodStep, Methods, OffersMethods, WithGauss, WithSplittings};
use dalembert::{
    Composition, Discretise, EnergyLedger, Gauss, Lagrangian, Midpoint, Splitting, State, StepError,
    Trapezoidal, rayleigh_system,
};

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
}

/// A mass that falls, L = ½v² − q: every method of order 2 and above has its motion to rounding.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn ball(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0]
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
fn kepler(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
fn henon_heiles(q: [f64; 2], v: [f64; 2]) -> f64 {
    let [x, y] = q;
    0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (x * x + y * y) - x * x * y + y * y * y / 3.0
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

const UP: State<f64, 1> = State { q: vector![1.0], p: vector![0.0] };

/// A quarter of a turn lies between a zero of q and one of p, 1000 times, forwards and backwards, by steps of
/// any method that has the motion; two functions come in the order of time.
#[test]
fn an_oscillator_passes_zero_every_quarter_of_a_turn() {
    fn check<M: Copy>(method: M, h: f64, turns: f64, relative: f64)
    where
        Oscillator: Flow<M, 1, Scalar = f64>,
    {
        let mut run = Oscillator {}.by(method, h).run(UP);
        let turns = if cfg!(debug_assertions) { (turns / 4.0_f64).ceil() } else { turns };
        let mut quarters = 0.0;
        let end = (turns + 0.1) * TAU;
        for event in run.watch(|at| [at.q[0], at.momentum()[0]]).until(h.signum() * end) {
            let event = event.unwrap();
            // The last step may have one more.
            if event.time.abs() > end {
                break;
            }
            quarters += 1.0;
            assert_eq!(event.index as f64, (quarters - 1.0) % 2.0, "{quarters}");
            let expected = h.signum() * quarters * 0.5 * PI;
            assert!((event.time / expected - 1.0).abs() < relative, "{h} {quarters} {}", event.time);
            // Falls, reaches the other end, rises, comes back; p is of the other sign backwards.
            let rises = [false, h > 0.0, true, h < 0.0][(quarters as usize - 1) % 4];
            assert_eq!(event.passage, if rises { Passage::Rising } else { Passage::Falling });
        }
        assert_eq!(quarters, 4.0 * turns);
    }
    check(Gauss::<8>, 0.25, 250.0, 1e-13);
    check(Gauss::<8>, 2.0, 100.0, 1e-13);
    check(Gauss::<5>, -0.125, 100.0, 1e-13);
    check(Splitting::blanes_casas_escorihuela_8(), 0.0625, 20.0, 1e-13);
    check(Composition::kahan_li_8(Trapezoidal), -0.03125, 5.0, 1e-13);
    check(Midpoint, 0.25, 3.0, 1e-2);
}

/// Perihelia of an orbit with e = 0.6, a = 1 are whole turns apart, aphelia between: zeros of q·p.
#[test]
fn a_planet_is_at_perihelion_once_a_turn() {
    let start = State { q: vector![0.4, 0.0], p: vector![0.0, 2.0] };
    let mut run = Kepler {}.by(Gauss::<8>, TAU / 64.0).run(start);
    let mut passed = 0.0;
    for event in run.watch(|at| [at.q.dot(&at.momentum())]).until(30.25 * TAU) {
        let event = event.unwrap();
        passed += 1.0;
        assert!(
            (event.time / (passed * PI) - 1.0).abs() < 1e-13,
            "{passed} {}",
            event.time / (passed * PI) - 1.0
        );
        let (radius, passage) =
            if passed % 2.0 == 1.0 { (1.6, Passage::Falling) } else { (0.4, Passage::Rising) };
        assert!((event.state.q.norm() - radius).abs() < 1e-12 && event.passage == passage);
    }
    assert_eq!(passed, 60.0);
}

/// Impacts 1 to 50 of a ball that keeps nine tenths of its velocity, against the sum of its flights. The last
/// ones are nearer to each other than a step is long.
#[test]
fn a_ball_bounces_fifty_times() {
    fn check<M: Copy>(method: M, h: f64)
    where
        Ball: Flow<M, 1, Scalar = f64>,
    {
        let mut run = Ball {}.by(method, h).run(UP);
        let mut watch = run.watch(|at| [at.q[0]]).crossing([Crossing::Falling]).terminal([true]);
        let (mut speed, mut time) = (2.0_f64.sqrt(), 2.0_f64.sqrt());
        for impact in 0..50 {
            let event = watch.next().unwrap().unwrap();
            assert!((event.time / time - 1.0).abs() < 1e-13, "{impact}: {} {time}", event.time);
            assert!((event.velocity[0] / -speed - 1.0).abs() < 1e-12);
            // The run stands at the impact and takes no step from there.
            assert_eq!((watch.run().time(), watch.run().state()), (event.time, &event.state));
            assert!(watch.next().is_none());
            speed *= 0.9;
            time += 2.0 * speed;
            watch.restart(State { q: event.state.q, p: event.state.p * -0.9 });
        }
        // It goes on as a run from there.
        let (time, state) = (watch.run().time(), *watch.run().state());
        let mut alone = Ball {}.by(method, h).run(state);
        for _ in 0..3 {
            assert_eq!(run.next(), alone.next());
        }
        assert!((run.time() - time - 3.0 * h).abs() < 1e-14);
    }
    check(Gauss::<8>, 0.125);
    check(Gauss::<2>, 0.125);
    check(Splitting::blanes_moan_6(), 0.125);
    check(Midpoint, 0.25);
    check(Trapezoidal, 0.015625);
}

/// Impacts that accumulate end in an error, after so many that their flights are too short to be told from
/// none.
#[test]
fn impacts_that_accumulate_are_chattering() {
    let mut run = Ball {}.by(Splitting::blanes_moan_6(), 0.125).run(UP);
    let mut watch = run.watch(|at| [at.q[0]]).crossing([Crossing::Falling]).terminal([true]);
    for impact in 0.. {
        match watch.next().unwrap() {
            Ok(event) => watch.restart(State { q: event.state.q, p: event.state.p * -0.5 }),
            Err(error) => {
                let EventError::Chattering { index: 0, time, stands } = error else { panic!("{error}") };
                assert!(impact > 40 && time == stands, "{impact}: {error}");
                assert_eq!(stands, watch.run().time());
                let text = error.to_string();
                let said = format!("events of function 0 than can be told apart near the time {time}");
                assert!(text.contains(&said) && text.contains("in the last good state"), "{text}");
                // √2 + √2 (1 + ½ + …)
                assert!((watch.run().time() - 3.0 * 2.0_f64.sqrt()).abs() < 0.2);
                assert!(watch.next().is_none());
                return;
            }
        }
    }
}

/// A run that is watched takes its own steps, bit by bit, and says when; the events are between.
#[test]
fn the_run_is_the_same_when_it_is_watched() {
    fn check<M: Copy>(method: M, h: f64)
    where
        HenonHeiles: Flow<M, 2, Scalar = f64>,
    {
        let by = HenonHeiles {}.by(method, h);
        let start = State { q: vector![0.1, -0.2], p: vector![0.3, 0.25] };
        let (mut alone, mut watched) = (by.run(start), by.run(start));
        let mut watch = watched.watch(|at| [at.q[0], at.q[1] * at.momentum()[0] - 0.01]);
        let (mut steps, mut events) = (0, 0);
        let mut last = 0.0_f64;
        while steps < 200 {
            match watch.advance().unwrap().unwrap() {
                Watched::Step(step) => {
                    assert_eq!(Some(Ok(step)), alone.next());
                    steps += 1;
                }
                Watched::Event(event) => {
                    // In order, and each a step from the start of its own.
                    assert!(event.time.abs() >= last.abs() && event.from == *alone.state());
                    assert_eq!(event.from_time, alone.time());
                    let partial = by.with_step(event.elapsed).step(&event.from).unwrap().state;
                    assert!((partial.q - event.state.q).amax() < 1e-14);
                    last = event.time;
                    events += 1;
                }
            }
        }
        assert_eq!(alone.checkpoint(), watched.checkpoint());
        assert!(events >= 3, "{events}");
    }
    check(Gauss::<8>, 0.25);
    check(Gauss::<1>, 0.05);
    check(Splitting::blanes_moan_6(), 0.25);
    check(Composition::kahan_li_6(Trapezoidal), -0.25);
    check(Trapezoidal, -0.05);
}

/// On the section q₁ = 0 of a chaotic motion the energy is that of the start.
#[test]
fn sections_keep_the_energy() {
    let system = HenonHeiles {};
    let start = State { q: vector![0.0, -0.25], p: vector![0.42, 0.0] };
    let energy = start.energy(&system).unwrap();
    let mut run = system.by(Gauss::<8>, 0.25).run(start);
    let section = run.watch(|at| [at.q[0]]).crossing([Crossing::Rising]);
    for event in section.take(if cfg!(debug_assertions) { 50 } else { 200 }) {
        let state = event.unwrap().state;
        assert!(state.q[0].abs() < 1e-15 && state.p[0] > 0.0);
        assert!((state.energy(&system).unwrap() - energy).abs() < 1e-13);
    }
}

/// A start on the event is none, whether it stays, leaves or turns there; the next one counts, once.
#[test]
fn a_start_on_the_event_is_none() {
    // On q = 0 to rounding, as after any event.
    for q in [0.0, 1e-17, -1e-17] {
        let mut run = Oscillator {}.by(Gauss::<8>, 0.25).run(State { q: vector![q], p: vector![1.0] });
        let times: Vec<f64> = run.watch(|at| [at.q[0]]).until(7.0).map(|event| event.unwrap().time).collect();
        assert_eq!(times.len(), 2, "{times:?}");
        assert!((times[0] - PI).abs() < 1e-14 && (times[1] - TAU).abs() < 1e-14);
    }
    // It turns there, and does so again after a turn: touching or, as rounding has it, two crossings or none,
    // and nothing at the start.
    for h in [0.25, 0.0078125] {
        let mut run = Oscillator {}.by(Gauss::<8>, h).run(UP);
        let touching: Vec<_> =
            run.watch(|at| [at.q[0] - 1.0]).until(8.0).map(|event| event.unwrap()).collect();
        assert!(touching.iter().all(|event| (event.time - TAU).abs() < 2e-7), "{touching:?}");
        assert!(touching.len() <= 2, "{touching:?}");
    }
    // Positive control: not on it.
    let mut run = Oscillator {}.by(Gauss::<8>, 0.25).run(State { q: vector![-1e-9], p: vector![1.0] });
    let first = run.watch(|at| [at.q[0]]).next().unwrap().unwrap();
    assert!((first.time / 1e-9 - 1.0).abs() < 1e-6);
}

/// A double root is one event that touches, at whatever step size: g = (q − ½)² on a straight motion.
#[test]
fn a_double_root_touches() {
    fn check<M: Copy>(method: M, h: f64)
    where
        Free: Flow<M, 2, Scalar = f64>,
    {
        let mut run = Free {}.by(method, h).run(STRAIGHT);
        let events: Vec<_> =
            run.watch(|at| [(at.q[0] - 0.5071).powi(2)]).until(1.0).map(|event| event.unwrap()).collect();
        assert_eq!(events.len(), 1, "{h} {events:?}");
        assert!((events[0].time - 0.5071).abs() < 1e-7 && events[0].passage == Passage::Touching);
        // One direction alone leaves it out.
        let mut run = Free {}.by(method, h).run(STRAIGHT);
        let watch = run.watch(|at| [(at.q[0] - 0.5071).powi(2)]).crossing([Crossing::Rising]);
        assert_eq!(watch.until(1.0).count(), 0);
        // Positive control: one that stays away by more than rounding.
        let mut run = Free {}.by(method, h).run(STRAIGHT);
        assert_eq!(run.watch(|at| [(at.q[0] - 0.5071).powi(2) + 1e-14]).until(1.0).count(), 0);
    }
    check(Gauss::<8>, 0.25);
    check(Gauss::<4>, 1e-2 / 3.0);
    check(Trapezoidal, 1e-2 / 3.0);
    check(Splitting::blanes_moan_6(), 0.3);
}

/// A free mass, whose motion meets values exactly.
#[rayleigh_system(rule = [trapezoidal, gauss])]
fn free(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.0 * (q[0] + q[1])
}

const STRAIGHT: State<f64, 2> = State { q: vector![0.0, 0.0], p: vector![1.0, 2.0] };

/// An event at a node of the grid belongs to the step that ends there, and to no other.
#[test]
fn an_event_on_the_grid_counts_once() {
    fn check<M: Copy>(method: M)
    where
        Free: Flow<M, 2, Scalar = f64>,
    {
        let mut run = Free {}.by(method, 0.25).run(STRAIGHT);
        let events: Vec<_> = run.watch(|at| [at.q[0] - 0.5]).until(2.0).map(|event| event.unwrap()).collect();
        assert_eq!(events.len(), 1, "{events:?}");
        assert_eq!((events[0].time, events[0].from_time), (0.5, 0.25));
        assert_eq!(events[0].passage, Passage::Rising);
    }
    check(Gauss::<4>);
    check(Trapezoidal);
    check(Splitting::blanes_moan_6());
}

/// Several in one step come in order, those at one time in the order of their functions; a terminal one lets
/// what happens with it happen, and nothing later.
#[test]
fn several_events_of_one_step_come_in_order() {
    let mut run = Free {}.by(Gauss::<3>, 4.0).run(STRAIGHT);
    let mut watch = run.watch(|at| [at.q[0] - 2.0, at.q[1] - 1.0, at.q[1] - 4.0, at.q[0] - 3.0]);
    let found: Vec<_> = watch.by_ref().take(4).map(|event| event.unwrap()).collect();
    assert_eq!(found.iter().map(|event| event.index).collect::<Vec<_>>(), [1, 0, 2, 3]);
    for (event, time) in found.iter().zip([0.5, 2.0, 2.0, 3.0]) {
        assert!((event.time - time).abs() < 1e-15);
    }
    let mut run = Free {}.by(Gauss::<3>, 4.0).run(STRAIGHT);
    let mut watch = run
        .watch(|at| [at.q[0] - 2.0, at.q[1] - 1.0, at.q[1] - 4.0, at.q[0] - 3.0])
        .terminal([true, false, false, true]);
    let found: Vec<_> = watch.by_ref().map(|event| event.unwrap().index).collect();
    assert_eq!(found, [1, 0, 2]);
    let state = *watch.run().state();
    assert!((watch.run().time() - 2.0).abs() < 1e-15 && (state.q[0] - 2.0).abs() < 1e-15);
    // From there on, only what is left.
    watch.restart(state);
    let found: Vec<_> = watch.by_ref().map(|event| event.unwrap().index).collect();
    assert_eq!(found, [3]);
    assert!((run.time() - 3.0).abs() < 1e-15);
}

/// Two crossings in one step that its ends do not show, down to the last that can be told apart.
#[test]
fn two_crossings_within_a_step_are_found() {
    for apart in [1.0, 1e-2, 1e-4, 1e-6] {
        let mut run = Oscillator {}.by(Gauss::<8>, 1.0).run(UP);
        let level = -f64::cos(apart);
        let found: Vec<_> =
            run.watch(|at| [at.q[0] - level]).until(5.0).map(|event| event.unwrap()).collect();
        assert_eq!(found.len(), 2, "{apart} {found:?}");
        for (event, sign) in found.iter().zip([-1.0, 1.0]) {
            // The level is known to rounding, the time to its root.
            assert!((event.time - (PI + sign * apart)).abs() < 1e-14 / apart, "{apart}: {}", event.time);
        }
        assert_eq!([found[0].passage, found[1].passage], [Passage::Falling, Passage::Rising]);
    }
    // Nearer ones are one that touches, or two; never none, and never more.
    let mut run = Oscillator {}.by(Gauss::<8>, 2.0).run(UP);
    let found = run.watch(|at| [at.q[0] + 1.0 - 1e-16]).until(4.0).count();
    assert!(found == 1 || found == 2, "{found}");
    // Further away there is none.
    let mut run = Oscillator {}.by(Gauss::<8>, 2.0).run(UP);
    assert_eq!(run.watch(|at| [at.q[0] + 1.0 + 1e-13]).until(4.0).count(), 0);
}

/// The kinetic energy that a stop takes, and what friction takes between: all of the energy's change, by
/// whole steps and those up to the impacts.
#[test]
fn the_ledger_closes_over_impacts() {
    fn check<M: Copy>(method: M, h: f64, remainder: f64)
    where
        Pendulum: dalembert::step::ForceWork<M, 1> + Flow<M, 1, Scalar = f64>,
    {
        let system = Pendulum { r: 0.05 };
        let by = system.by(method, h);
        let start = State::from_velocity(&system, [1.0], [0.0]).unwrap();
        let mut run = by.run(start);
        let mut watch = run.watch(|at| [at.q[0] - 0.1]).crossing([Crossing::Falling]).terminal([true]);
        // The bottom lies beyond the stop: it comes back as often as it is asked.
        let (mut from, mut ledger, mut lost, mut impacts) = (start, EnergyLedger::default(), 0.0, 0);
        while impacts < 20 {
            match watch.advance().unwrap().unwrap() {
                Watched::Step(step) => {
                    ledger += by.ledger(&from, &step.state).unwrap();
                    from = step.state;
                }
                Watched::Event(impact) => {
                    ledger += by.with_step(impact.elapsed).ledger(&impact.from, &impact.state).unwrap();
                    from = State { q: impact.state.q, p: impact.state.p * -0.8 };
                    lost += 0.5 * (1.0 - 0.64) * impact.state.p[0].powi(2);
                    watch.restart(from);
                    impacts += 1;
                }
            }
        }
        let change = from.energy(&system).unwrap() - start.energy(&system).unwrap();
        assert!((change + lost + ledger.dissipated).abs() < remainder, "{change} {lost} {ledger:?}");
        assert!(ledger.remainder().abs() < remainder && lost > 0.3 && ledger.dissipated > 0.02);
    }
    check(Gauss::<8>, 0.25, 1e-13);
    check(Splitting::blanes_moan_6(), 0.125, 1e-6);
}

/// Derivatives of time and state at an event by the start, against differences of events.
#[test]
fn derivatives_of_events_are_those_of_differences() {
    let system = Pendulum { r: 0.1 };
    let by = system.by(Gauss::<8>, 0.5);
    // A plane that leans and moves: g = q + 0.3 p − 0.2 + 0.1 t.
    let event = |start: State<f64, 1>| {
        let mut run = by.run(start);
        run.watch(|at| [at.q[0] + 0.3 * at.momentum()[0] - 0.2 + 0.1 * at.time]).next().unwrap().unwrap()
    };
    let start = State { q: vector![1.1], p: vector![-0.2] };
    let found = event(start);
    assert!(found.from_time > 0.0, "several steps");
    let gradient = EventGradient { q: vector![1.0], p: vector![0.3], time: 0.1 };
    let derivatives = found.derivatives(&by, &gradient).unwrap();
    // By the start of the run: through the steps before.
    let mut a = dalembert::step::PhaseMatrix::identity();
    let mut state = start;
    while (state.q - found.from.q).amax() > 1e-12 {
        let (step, of_step) = by.linearized_step(&state).unwrap();
        (state, a) = (step.state, of_step * a);
    }
    let derivatives = derivatives.after(&a);
    let d = 1e-4;
    let difference = |direction: Vector2<f64>| {
        let at = |d: f64| {
            let start = State {
                q: start.q + direction.fixed_rows::<1>(0) * d,
                p: start.p + direction.fixed_rows::<1>(1) * d,
            };
            let event = event(start);
            SVector::<f64, 3>::from([event.time, event.state.q[0], event.state.p[0]])
        };
        ((at(d) - at(-d)) * 8.0 - (at(2.0 * d) - at(-2.0 * d))) / (12.0 * d)
    };
    let (by_q, by_p) = (difference(Vector2::x()), difference(Vector2::y()));
    let exact_q = [derivatives.time_by_q[0], derivatives.a.q_by_q[0], derivatives.a.p_by_q[0]];
    let exact_p = [derivatives.time_by_p[0], derivatives.a.q_by_p[0], derivatives.a.p_by_p[0]];
    for k in 0..3 {
        assert!((by_q[k] - exact_q[k]).abs() < 1e-10, "{k}: {} {}", by_q[k], exact_q[k]);
        assert!((by_p[k] - exact_p[k]).abs() < 1e-10, "{k}: {} {}", by_p[k], exact_p[k]);
    }
    // Where the function has no slope there is none.
    let flat = EventGradient { q: vector![0.0], p: vector![0.0], time: 0.0 };
    assert!(matches!(found.derivatives(&by, &flat), Err(EventError::Tangent { .. })));
}

/// What cannot be watched has a name, and the run stands where its last step led.
#[test]
fn what_cannot_be_watched_is_an_error() {
    let by = Oscillator {}.by(Gauss::<8>, 0.5);
    let mut run = by.run(UP);
    let error = run.watch(|at| [(at.q[0] - 0.5).sqrt()]).next().unwrap().unwrap_err();
    assert!(matches!(error, EventError::NotFinite { index: 0, .. }), "{error}");
    assert!(run.state().q[0] < 0.5 && run.next().is_some());
    // Sixteen events of a step are kept.
    let mut run = by.run(UP);
    let error = run.watch(|at| [(200.0 * at.q[0]).sin()]).until(2.0).find_map(Result::err).unwrap();
    assert!(matches!(error, EventError::Chattering { .. }), "{error}");
    assert!(error.to_string().contains(&format!("the run stands at {}, in the last good", run.time())));
    // A watch without an end cannot go back: the run stands behind the events.
    let mut run = by.run(UP);
    let error = run.watch(|at| [1.0, (200.0 * at.q[0]).sin()]).find_map(Result::err).unwrap();
    let EventError::Chattering { index: 1, time, stands } = error else { panic!("{error}") };
    assert!(time < stands && stands == run.time(), "{error}");
    assert!(error.to_string().contains(&format!("stands at {stands}, at the end of that step")), "{error}");
    let mut run = by.run(UP);
    assert_eq!(run.watch(|at| [(40.0 * at.q[0]).sin()]).until(2.0).filter(|event| event.is_ok()).count(), 18);
    // Noise about 0.
    let mut run = by.run(UP);
    let noise = |q: f64| f64::from((q.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) as u32) - 1e9;
    let error = run.watch(|at| [noise(at.q[0])]).find_map(Result::err).unwrap();
    assert!(matches!(error, EventError::Chattering { .. } | EventError::Unresolved { .. }), "{error}");
    // What is 0 all along is no event, nor is what jumps away from it.
    let mut run = by.run(UP);
    assert_eq!(run.watch(|_| [0.0]).until(10.0).count(), 0);
    // One that jumps is crossed where it jumps.
    let mut run = by.run(UP);
    let jump = run.watch(|at| [if at.q[0] > 0.25 { 1.0 } else { -1.0 }]).next().unwrap().unwrap();
    assert!((jump.time - 0.25_f64.acos()).abs() < 1e-13, "{jump:?}");
    // The run's own error.
    let mut run = by.with_step(f64::NAN).run(UP);
    let error = run.watch(|at| [at.q[0]]).next().unwrap().unwrap_err();
    assert!(matches!(error, EventError::Step(StepError::StepSize { .. })), "{error}");
}

#[test]
fn single_precision_has_events() {
    #[rayleigh_system(rule = [trapezoidal, gauss])]
    fn rotor(q: [f32; 1], v: [f32; 1]) -> f32 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
    fn check<M: Copy>(method: M, h: f32)
    where
        Rotor: Flow<M, 1, Scalar = f32>,
    {
        let mut run = Rotor {}.by(method, h).run(State { q: vector![1.0], p: vector![0.0] });
        let mut quarters = 0.0;
        for event in run.watch(|at| [at.q[0], at.momentum()[0]]).until(40.0) {
            quarters += 1.0;
            assert!((event.unwrap().time / (quarters * 0.5 * PI) - 1.0).abs() < 1e-5);
        }
        assert_eq!(quarters, 25.0);
    }
    check(Gauss::<4>, 0.25);
    check(Splitting::blanes_moan_6(), 0.25);
}

/// A guarded run has the events and the states between of its steps, by every method that it may choose;
/// those of an oscillator are where they are to its error.
#[test]
fn guarded_runs_have_events_and_states_between() {
    fn check<L, M>(system: &L, methods: M, tolerance: f64)
    where
        L: OffersMethods<1> + Lagrangian<1, Scalar = f64>,
        M: Methods<L, 1>,
    {
        let choice = system.to_error(tolerance).among(methods).until(40.0).choice(&UP).unwrap();
        let mut run = choice.trajectory();
        let mut quarters = 0.0;
        for event in run.watch(|at| [at.q[0], at.momentum()[0]]) {
            let event = event.unwrap();
            quarters += 1.0;
            assert!((event.time - quarters * 0.5 * PI).abs() < 3.0 * tolerance, "{choice}: {event}");
        }
        assert_eq!(quarters, 25.0, "{choice}");
        let mut run = choice.trajectory();
        for (k, sample) in run.sample_at((1..40).map(|k| 0.99 * f64::from(k))).enumerate() {
            let sample = sample.unwrap();
            let time = 0.99 * (k as f64 + 1.0);
            assert!((sample.state.q[0] - time.cos()).abs() < 3.0 * tolerance, "{choice}: {sample}");
        }
        // The run is the same as unwatched.
        let ends: Vec<_> = choice.trajectory().map(|step| step.unwrap().state).collect();
        assert_eq!(run.state(), &ends[run_index(&run, &ends)], "{choice}");
    }
    fn run_index<T: Run<1, Scalar = f64>>(run: &T, ends: &[State<f64, 1>]) -> usize {
        (run.time() / 40.0 * ends.len() as f64).round() as usize - 1
    }
    for tolerance in [1e-2_f64, 1e-4, 1e-7, 1e-11] {
        check(&Oscillator {}, Midpoint, tolerance.max(1e-9));
        check(&Oscillator {}, WithSplittings(Trapezoidal), tolerance);
        check(&Oscillator {}, WithGauss(Trapezoidal), tolerance);
    }
}

/// An input that is held: events and samples are those of a run by that input, one step or many; and the
/// view's time goes on while it is.
#[test]
fn held_inputs_have_events_and_states_between() {
    struct Pushed;

    #[rayleigh_system(rule = [midpoint, gauss])]
    impl Pushed {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
            0.5 * v[0] * v[0] + q[0] * (2.0 * t).cos()
        }
        fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
            u
        }
    }

    // q̈ = u + cos 2t.
    let exact = |t: f64, u: f64| 0.5 * u * t * t - 0.25 * (2.0 * t).cos();
    let start = State { q: vector![-0.25], p: vector![0.0] };
    let mut run = Pushed.driven([0.0], 0.0).by(Gauss::<6>, 0.25).run_with_inputs(start);
    let push = Pushed.driven([0.5], 0.0);
    let found = run.hold(&push).watch(|at| [at.q[0] - exact(7.3, 0.5)]).next().unwrap().unwrap();
    assert!((found.time - 7.3).abs() < 1e-12, "{found}");
    assert_eq!(run.time(), 7.5);
    let (q, v) = (exact(7.5, 0.5), 0.5 * 7.5 + 0.5 * 15.0_f64.sin());
    assert!((run.state().q[0] - q).abs() < 1e-12 && (run.state().p[0] - v).abs() < 1e-12);

    // Another input from there on, by a view of that time; the phase of the cosine is right only by it.
    let other = Pushed.driven([-0.25], 7.5);
    let after = |t: f64| {
        let s = t - 7.5;
        let swing = -0.25 * ((2.0 * t).cos() - 15.0_f64.cos()) - 0.5 * 15.0_f64.sin() * s;
        q + v * s - 0.125 * s * s + swing
    };
    let times = [7.6, 7.75, 8.0, 8.3, 9.9];
    for sample in run.hold(&other).sample_at(times) {
        let sample = sample.unwrap();
        assert!((sample.state.q[0] - after(sample.time)).abs() < 1e-12, "{sample}");
    }
    assert_eq!(run.time(), 10.0);
    // A stop: the run goes on from where it stands, by whatever input comes next.
    let brake = Pushed.driven([-1.0], 10.0);
    let crossing = {
        let mut held: HeldInput<'_, '_, DrivenPushed<'_>, DrivenPushed<'_>, _, 1> = run.hold(&brake);
        held.watch(|at| [at.velocity()[0]]).terminal([true]).next().unwrap().unwrap()
    };
    assert_eq!((run.time(), run.state()), (crossing.time, &crossing.state));
    assert!(crossing.velocity[0].abs() < 1e-13);
    let control = run.advance(&Pushed.driven([0.0], run.time())).unwrap();
    assert!((control.state.q - crossing.state.q).norm() > 1e-3);
}

/// Which runs can be divided, and which restarted: the compiler says so of the others.
#[test]
fn runs_of_all_kinds_are_divisible() {
    fn nodes<T: Divisible<1>>(run: &T) -> usize {
        run.nodes().len()
    }
    fn restarted<T: Restartable<1, Scalar = f64>>(run: &mut T) -> f64 {
        run.restart_at(3.0, UP);
        run.time()
    }
    let mut plain = Oscillator {}.by(Gauss::<5>, 0.25).run(UP);
    assert_eq!((nodes(&plain), restarted(&mut plain)), (5, 3.0));
    let mut driven = Oscillator {}.by(Midpoint, 0.25).run_with_inputs(UP);
    let mut held = driven.hold(&Oscillator {});
    assert_eq!((nodes(&held), restarted(&mut held)), (0, 3.0));
    for (method, expected) in [(Method::Gauss8, 8), (Method::Gauss4, 4), (Method::KahanLi6, 0)] {
        let step = Methods::<Oscillator, 1>::step(WithGauss(Trapezoidal), method, 0.1).unwrap();
        let last: &dyn LastStep<Oscillator, 1> = step.last();
        assert_eq!(last.nodes().len(), expected);
    }
}

/// A run is watched without its type, by the functions that it is watched by with it: the very events.
#[test]
fn runs_are_watched_without_their_types() {
    type Some<'r> =
        dyn Divisible<1, Item = Result<Step<f64, 1>, StepError>, Scalar = f64, System = Oscillator> + 'r;
    fn zeros<T: Divisible<1, Scalar = f64> + ?Sized>(run: &mut T) -> [Event<f64, 1>; 3] {
        let mut watch = Watch::new(run, |at| [at.q[0]]);
        [(); 3].map(|()| watch.next().unwrap().unwrap())
    }
    let by = Oscillator {}.by(Gauss::<5>, 0.25);
    let expected = zeros(&mut by.run(UP));
    assert_eq!(zeros::<Some<'_>>(&mut by.run(UP)), expected);
    let mut driven = Oscillator {}.by(Gauss::<5>, 0.25).run_with_inputs(UP);
    assert_eq!(zeros::<Some<'_>>(&mut driven.hold(&Oscillator {})), expected);
    // The cubic's moments are others: another method is told apart.
    assert_ne!(zeros::<Some<'_>>(&mut Oscillator {}.by(Midpoint, 0.25).run(UP)), expected);
}

/// What events and samples say.
#[test]
fn events_and_samples_say_what_they_are() {
    let mut run = Oscillator {}.by(Gauss::<4>, 0.25).run(UP);
    let event = run.watch(|at| [at.q[0]]).next().unwrap().unwrap();
    assert_eq!(format!("{event:.3}"), "event 0, falling, at t = 1.571: q = (0.000), v = (-1.000)");
    let mut run = Kepler {}.by(Trapezoidal, 0.5).run(State { q: vector![1.0, 0.0], p: vector![0.0, 1.0] });
    let sample = run.sample_every(2).next().unwrap().unwrap();
    let text = sample.to_string();
    assert!(
        text.starts_with("t = 1: q = (") && text.ends_with("iterations") && text.contains("), p = ("),
        "{text}"
    );
}

/// A ball that bounces on q = 0 under a controller, which hands it an input at its own ticks, where the steps
/// end. 30 balls, three periods that are no multiple of the step, and three that are; none falls through the
/// floor, at no bounce.
#[test]
fn no_impact_under_a_controller_is_lost() {
    /// L = ½v² − g q, with a force.
    struct Dropped;
    #[rayleigh_system(rule = gauss)]
    impl Dropped {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - 9.81 * q[0]
        }
        fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
            u
        }
    }
    let (every, mut in_shortened) = (if cfg!(debug_assertions) { 4 } else { 1 }, 0);
    for period in [0.007, 0.013, 0.017, 0.01, 0.02, 0.05] {
        for index in (0..30).step_by(every) {
            let start = State { q: vector![0.5 + f64::from(index) / 30.0], p: vector![0.0] };
            let mut run = Dropped.driven([0.0]).by(Gauss::<2>, 0.01).run_with_inputs(start);
            let (mut tick, mut impacts) = (0.0, 0);
            while run.time() < 1.5 {
                tick += period;
                let held = Dropped.driven([0.0]);
                let mut hold = run.hold(&held);
                let mut watch =
                    hold.watch(|at| [at.q[0]]).crossing([Crossing::Falling]).terminal([true]).until(tick);
                while let Some(impact) = watch.next() {
                    let impact = impact.unwrap();
                    impacts += 1;
                    assert!(impact.time <= tick);
                    in_shortened += usize::from(impact.from_time + 0.01 > tick + 1e-9);
                    watch.restart(State { q: impact.state.q, p: impact.state.p * -0.8 });
                }
                assert_eq!(run.time(), tick);
                assert!(run.state().q[0] > -1e-12, "{period} {index}: {:?} at {tick}", run.state());
            }
            // By the height of the start: the first after √(2q/g), the second 1.6 times that later.
            let first = (2.0 * start.q[0] / 9.81).sqrt();
            assert!(impacts >= if 2.6 * first < 1.5 { 2 } else { 1 }, "{period} {index}: {impacts}");
        }
    }
    // The positive control: impacts fell into steps that end at a tick.
    assert!(in_shortened * every > 100, "{in_shortened}");
}
