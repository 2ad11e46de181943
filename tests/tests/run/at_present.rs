//! Velocity, energy and ledger of systems that take the time, asked of runs: at the time of the state, not at
//! that of the view that the run began with.

use dalembert::nalgebra::{SVector, vector};
use dalembert::run::LaneRuns;
use dalembert::run::events::EventGradient;
use dalembert::step::ForceWork;
use dalembert::{
    Composition, Discretise, EnergyLedger, Gauss, Lagrangian, Midpoint, Splitting, State, StepError,
    Trapezoidal, rayleigh_system,
};

/// It burns a two-hundredth of its mass in a unit of time, and its gas leaves it with 4000.
#[derive(Clone, Copy)]
struct Rocket;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = gauss)]
impl Rocket {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * (100.0 - 0.5 * t) * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [0.5 * (4000.0 - v[0])]
    }
}

/// A rocket with an input: a share of the thrust.
struct Throttled;

#[rayleigh_system(rule = [midpoint, gauss])]
impl Throttled {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * (100.0 - 0.5 * t) * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        [0.5 * (4000.0 * u[0] - v[0])]
    }
}

const END: f64 = 160.0;

fn mass(t: f64) -> f64 {
    100.0 - 0.5 * t
}

fn speed(t: f64) -> f64 {
    4000.0 * (100.0 / mass(t)).ln()
}

fn at_rest() -> State<f64, 1> {
    State { q: vector![0.0], p: vector![0.0] }
}

/// Velocity and energy of the rocket at a time, and that they are other ones by the view of the start.
#[track_caller]
fn is_rocket(time: f64, state: &State<f64, 1>, velocity: SVector<f64, 1>, energy: f64, off: f64) {
    let by_hand = speed(time);
    assert!((velocity[0] / by_hand - 1.0).abs() < off, "{} {by_hand}", velocity[0]);
    let of_mass = 0.5 * mass(time) * by_hand * by_hand;
    assert!((energy / of_mass - 1.0).abs() < 2.0 * off, "{energy} {of_mass}");
    assert_eq!(Ok(velocity), state.velocity(&Rocket.at_time(time)));
    let at_start = Rocket.at_time(0.0);
    let share = mass(time) / 100.0;
    assert!((state.velocity(&at_start).unwrap()[0] / by_hand - share).abs() < off);
    assert!((state.energy(&at_start).unwrap() / of_mass - share).abs() < 2.0 * off);
}

#[test]
fn a_rocket_is_asked_at_its_time() {
    let view = Rocket.at_time(0.0);
    // The ledger's remainder is −∫ ∂L/∂t dt = ∫ v²/4 dt; of v = c ln(100/m) with dt = −2 dm.
    let after = mass(END) / 100.0;
    let squares = 16e6 * (2.0 - after * (after.ln() * after.ln() - 2.0 * after.ln() + 2.0));
    let by_time = 0.25 * 200.0 * squares;
    macro_rules! by {
        ($method:expr, $h:expr, $off:expr) => {{
            let by = view.by($method, $h);
            let steps = (END / $h).round() as usize;
            let mut run = by.run(at_rest());
            let ledger = run.ledger().take(steps).sum::<Result<EnergyLedger<f64>, _>>().unwrap();
            assert_eq!(run.time(), END);
            is_rocket(END, run.state(), run.velocity().unwrap(), run.energy().unwrap(), $off);
            let off = (ledger.remainder() / by_time - 1.0).abs();
            assert!(off < 10.0 * $off, "{off:e}");
            assert!((ledger.change / run.energy().unwrap() - 1.0).abs() < 1e-12);

            // With a last step of another size, and further from there.
            let mut parted = by.run(at_rest());
            let first = parted.ledger().until(0.3 * END + 0.1 * $h).sum::<Result<EnergyLedger<f64>, _>>();
            let second = parted.ledger().until(END).sum::<Result<EnergyLedger<f64>, _>>();
            let parted_off = ((first.unwrap() + second.unwrap()).remainder() / by_time - 1.0).abs();
            assert!(parted.time() == END && parted_off < 10.0 * $off, "{parted_off:e}");
            assert!((parted.velocity().unwrap()[0] / speed(END) - 1.0).abs() < $off);

            let mut sampled = by.run(at_rest());
            for sample in sampled.sample_every(steps as u64 / 4).take(4) {
                let sample = sample.unwrap();
                let [v, energy] = [sample.velocity(&view).unwrap()[0], sample.energy(&view).unwrap()];
                is_rocket(sample.time, &sample.state, vector![v], energy, $off);
            }
            for sample in by.run(at_rest()).sample_at([37.3, 101.9]) {
                let sample = sample.unwrap();
                let [v, energy] = [sample.velocity(&view).unwrap()[0], sample.energy(&view).unwrap()];
                is_rocket(sample.time, &sample.state, vector![v], energy, $off);
            }
            let event = by.run(at_rest()).watch(|at| [at.velocity()[0] - 3000.0]).next().unwrap().unwrap();
            is_rocket(event.time, &event.state, event.velocity, event.energy(&view), $off);
        }};
    }
    by!(Midpoint, 0.125, 1e-5);
    by!(Trapezoidal, 0.125, 1e-5);
    by!(Gauss::<3>, 1.0, 1e-9);
    by!(Composition::kahan_li_6(Midpoint), 1.0, 1e-7);
}

#[test]
fn the_guarded_run_and_lanes_ask_at_their_time() {
    let view = Rocket.at_time(0.0);
    let mut run = view.to_error(1e-3).until(END).run(at_rest()).unwrap();
    run.by_ref().for_each(|step| assert!(step.is_ok()));
    is_rocket(END, run.state(), run.velocity().unwrap(), run.energy().unwrap(), 1e-8);
    let mut sampled = view.to_error(1e-3).until(END).run(at_rest()).unwrap();
    let sample = sampled.sample_every(u64::MAX).next().unwrap().unwrap();
    is_rocket(END, &sample.state, sample.velocity(&view).unwrap(), sample.energy(&view).unwrap(), 1e-8);

    // The second member begins later: its rocket is lighter.
    let later = Rocket.at_time(40.0);
    let mut lanes = LaneRuns::new(Gauss::<3>, [&view, &later], &[at_rest(); 2], 0.5);
    lanes.advance(100);
    assert_eq!((lanes.time(0), lanes.time(1), lanes.time(2)), (Some(50.0), Some(50.0), None));
    is_rocket(50.0, &lanes.state(0).unwrap(), lanes.velocity(0).unwrap(), lanes.energy(0).unwrap(), 1e-9);
    let faster = 4000.0 * (mass(40.0) / mass(90.0)).ln();
    assert!((lanes.velocity(1).unwrap()[0] / faster - 1.0).abs() < 1e-9);
    assert!((lanes.energy(1).unwrap() / (0.5 * mass(90.0) * faster * faster) - 1.0).abs() < 1e-9);
    assert_eq!((lanes.velocity(2), lanes.energy(2)), (None, None));
    lanes.refill([Some(&view), None], &[at_rest(); 2]);
    lanes.advance(20);
    assert_eq!((lanes.time(0), lanes.time(1)), (Some(10.0), Some(60.0)));
    assert!((lanes.velocity(0).unwrap()[0] / speed(10.0) - 1.0).abs() < 1e-9);
}

/// A view that is held has its time where it is held first.
#[test]
fn a_held_input_is_asked_at_its_time() {
    let mut run = Throttled.driven([1.0], 0.0).by(Gauss::<3>, 1.0).run_with_inputs(at_rest());
    let full = Throttled.driven([1.0], 0.0);
    assert!(run.hold(&full).until(60.5).all(|step| step.is_ok()));
    let view = Throttled.driven([1.0], run.time());
    let mut held = run.hold(&view);
    let before = held.energy().unwrap();
    let ledger = held.ledger().until(END).sum::<Result<EnergyLedger<f64>, _>>().unwrap();
    assert!((ledger.change / (held.energy().unwrap() - before) - 1.0).abs() < 1e-12);
    is_rocket(held.time(), held.state(), held.velocity().unwrap(), held.energy().unwrap(), 1e-9);

    let restarted = || {
        let mut run = Throttled.driven([1.0], 0.0).by(Gauss::<3>, 1.0).run_with_inputs(at_rest());
        assert!(run.hold(&full).until(60.5).all(|step| step.is_ok()));
        run
    };
    let sample = restarted().hold(&view).sample_at([120.2]).next().unwrap().unwrap();
    is_rocket(120.2, &sample.state, sample.velocity(&view).unwrap(), sample.energy(&view).unwrap(), 1e-9);
    let mut run = restarted();
    let event = run.hold(&view).watch(|at| [at.velocity()[0] - 3000.0]).next().unwrap().unwrap();
    is_rocket(event.time, &event.state, event.velocity, event.energy(&view), 1e-9);

    // Its derivatives are those of the rocket that is there.
    let m = mass(event.time);
    let time = 0.5 * event.state.p[0] / (m * m);
    let plane = EventGradient { q: vector![0.0], p: vector![1.0 / m], time };
    let by_start = event.derivatives(&view.by(Gauss::<3>, 1.0), &plane).unwrap();
    // v − v0 does not depend on v0: dt = −dv0/v̇ with v̇ = 2000/m, dv0 = dp0/m0.
    let by_hand = -(1.0 / mass(event.from_time)) / (2000.0 / m);
    assert!((by_start.time_by_p[0] / by_hand - 1.0).abs() < 1e-9, "{} {by_hand}", by_start.time_by_p[0]);
}

/// Only the force takes the time: what is left of the ledger is rounding, by Gauss rules, by the midpoint
/// rule, and in a splitting's own account h⁴; by a view that stands still it is as large as the work.
struct Pushed;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Pushed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.05 * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [(0.7 * t).cos()]
    }
}

/// Remainders of 200 steps: by the run's ledger, and by a loop through the view of the start.
fn remainders<M>(method: M, start_time: f64) -> [f64; 2]
where
    M: Copy,
    for<'v> PushedAtTime<'v>: ForceWork<M, 1> + Lagrangian<1, Scalar = f64>,
{
    let view = Pushed.at_time(start_time);
    let start = State { q: vector![1.0], p: vector![0.0] };
    let by = view.by(method, 0.1);
    let mut run = by.run(start);
    let ledger: EnergyLedger<f64> = run.ledger().take(200).sum::<Result<_, StepError>>().unwrap();
    let mut by_hand = EnergyLedger::default();
    let (mut state, mut at_start) = (start, EnergyLedger::default());
    for (k, step) in by.run(start).take(200).enumerate() {
        let next = step.unwrap().state;
        at_start += by.ledger(&state, &next).unwrap();
        let now = Pushed.at_time(start_time + 0.1 * k as f64);
        by_hand += now.by(method, 0.1).ledger(&state, &next).unwrap();
        state = next;
    }
    assert!((ledger.remainder() - by_hand.remainder()).abs() < 1e-12);
    assert_eq!(run.state(), &state);
    [ledger.remainder().abs(), at_start.remainder().abs()]
}

#[test]
fn the_ledger_of_a_run_follows_its_time() {
    for time in [0.0, -3.7] {
        for [remainder, at_start] in [remainders(Midpoint, time), remainders(Gauss::<3>, time)] {
            assert!(remainder < 1e-13 && at_start > 0.1, "{remainder:e} {at_start:e}");
        }
        let [remainder, at_start] = remainders(Splitting::blanes_moan_6(), time);
        assert!(remainder < 1e-4 && at_start > 0.1, "{remainder:e} {at_start:e}");
    }
}

/// An error ends the entries, as it ends the run.
#[test]
fn an_error_ends_the_entries() {
    let view = Rocket.at_time(0.0);
    let mut run = view.by(Midpoint, 0.0).run(at_rest());
    let entries: Vec<_> = run.ledger().take(3).collect();
    assert!(matches!(entries[..], [Err(StepError::StepSize { .. })]));
    let mut run = view.by(Midpoint, 1.0).run(at_rest());
    let entries: Vec<_> = run.ledger().until(f64::NAN).take(3).collect();
    assert!(matches!(entries[..], [Err(StepError::StepSize { .. })]));
    assert!(run.ledger().run().state() == &at_rest());
}
