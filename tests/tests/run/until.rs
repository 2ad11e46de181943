//! Runs that end at a time: the last step is as long as it takes, the clock reads that time, and the steps
//! before are those of the grid.

use dalembert::nalgebra::vector;
use dalembert::run::events::Crossing;
use dalembert::step::Flow;
use dalembert::{
    Composition, Discretise, Gauss, Midpoint, Splitting, State, StepError, Trapezoidal, rayleigh_system,
};
use dalembert_tests::draws::Draws;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

#[rayleigh_system(rule = trapezoidal)]
fn spring(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// A mass under an input, and a force that turns with time.
struct Pushed;

#[rayleigh_system(rule = [midpoint, gauss])]
impl Pushed {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        [u[0] + (3.0 * t).cos()]
    }
}

const START: State<f64, 1> = State { q: vector![0.8], p: vector![0.3] };

/// Whole steps to the last node before the end, and one of what is left: by single steps, which know of no
/// run.
fn by_steps<L: Flow<M, 1, Scalar = f64>, M: Copy>(
    system: &L,
    method: M,
    h: f64,
    end: f64,
) -> (State<f64, 1>, usize) {
    let (mut state, mut taken) = (START, 0);
    while (end - h * taken as f64) / h > 1.0 + 1.0 / 1024.0 {
        state = system.by(method, h).step(&state).unwrap().state;
        taken += 1;
    }
    let rest = end - h * taken as f64;
    (system.by(method, rest).step(&state).unwrap().state, taken + 1)
}

/// The end of a run is where single steps lead, by every method, forwards and backwards, at random ends.
#[test]
fn the_last_step_is_as_long_as_it_takes() {
    fn check<L: Flow<M, 1, Scalar = f64>, M: Copy>(system: &L, method: M, draws: &mut Draws) {
        for _ in 0..if cfg!(debug_assertions) { 5 } else { 40 } {
            let h = draws.sign() * draws.scale(0.01, 0.3);
            let end = h * draws.scale(1e-3, 30.0);
            let mut run = system.by(method, h).run(START);
            let taken = run.until(end).map(Result::unwrap).count();
            let (state, expected) = by_steps(system, method, h, end);
            assert_eq!((run.time(), taken), (end, expected), "{h}");
            let off = (run.state().q - state.q).norm() + (run.state().p - state.p).norm();
            assert!(off < 2e-13, "{h} {end}: {off}");
            // The steps that follow are counted from there, and of the run's own size.
            run.next().unwrap().unwrap();
            assert_eq!((run.time(), run.step_size()), (end + h, h));
            assert!(run.until(end).next().is_none(), "a run is not taken back");
        }
    }
    let draws = &mut Draws::new(3);
    let (pendulum, spring) = (Pendulum { r: 0.1 }, Spring { r: 0.1 });
    check(&pendulum, Midpoint, draws);
    check(&pendulum, Trapezoidal, draws);
    check(&pendulum, Gauss::<1>, draws);
    check(&pendulum, Gauss::<4>, draws);
    check(&pendulum, Gauss::<8>, draws);
    check(&pendulum, Composition::kahan_li_6(Midpoint), draws);
    check(&spring, Trapezoidal, draws);
    check(&spring, Splitting::blanes_moan_4(), draws);
    check(&spring, Splitting::blanes_casas_escorihuela_8(), draws);
}

/// Ticks that are the grid's but for rounding take the grid's steps, as many as they are and bit by bit.
#[test]
fn ticks_on_the_grid_are_its_nodes() {
    let h = 0.01;
    let by = Pendulum { r: 0.1 }.by(Midpoint, h);
    let (mut run, mut alone) = (by.run(START), by.run(START));
    let (mut tick, mut late) = (0.0, 0);
    for _ in 0..2000 {
        tick += 10.0 * h;
        late += u32::from(alone.time() + 10.0 * h < tick);
        assert_eq!(run.until(tick).map(Result::unwrap).count(), 10);
        assert_eq!(run.time(), tick);
        assert_eq!(run.state(), &alone.nth(9).unwrap().unwrap().state);
    }
    // Positive control: a clock that is compared comes too early.
    assert!(late > 100, "{late}");
}

/// Control periods that are no multiple of the step: each ends at its tick, under its own input, and the
/// force sees the time of the run. Held against steps of a hundredth of the size.
#[test]
fn control_periods_of_any_length_end_at_their_ticks() {
    let end = |h: f64, period: f64| {
        let mut run = Pushed.driven([0.0], 0.0).by(Gauss::<4>, h).run_with_inputs(START);
        for tick in 1..=40 {
            let held = Pushed.driven([if tick % 3 == 0 { 1.0 } else { -0.4 }], run.time());
            let until = period * f64::from(tick);
            assert!(run.hold(&held).until(until).all(|step| step.is_ok()));
            assert_eq!(run.time(), until);
        }
        *run.state()
    };
    for period in [0.007, 0.013, 0.05, 0.1, 0.1 + 1e-12] {
        let (coarse, fine) = (end(0.1, period), end(1e-3, period));
        let off = (coarse.q - fine.q).norm() + (coarse.p - fine.p).norm();
        assert!(off < 1e-11, "{period}: {off}");
    }
}

/// A time that is none is an error, and one behind the run takes no step; on an error the state is the last
/// good one.
#[test]
fn what_is_no_end_is_refused() {
    let by = Pendulum { r: 0.1 }.by(Midpoint, 0.1);
    let mut run = by.run(START);
    let refused: Vec<_> = run.until(f64::NAN).collect();
    assert!(matches!(refused[..], [Err(StepError::StepSize { .. })]), "{refused:?}");
    assert_eq!((run.time(), run.state()), (0.0, &START));
    let mut run = by.run(START);
    assert_eq!(run.until(-1.0).count() + run.until(0.0).count() + run.until(f64::NEG_INFINITY).count(), 0);
    assert_eq!(run.until(f64::INFINITY).take(3).count(), 3);
    let mut run = by.with_step(f64::NAN).run(START);
    let refused: Vec<_> = run.until(1.0).collect();
    assert!(matches!(refused[..], [Err(StepError::StepSize { .. })]), "{refused:?}");
    let mut driven = by.run_with_inputs(START);
    let refused: Vec<_> = driven.hold(&Pendulum { r: 0.1 }).until(f64::NAN).collect();
    assert!(matches!(refused[..], [Err(StepError::StepSize { .. })]), "{refused:?}");
    assert_eq!((driven.time(), driven.step_size(), driven.state()), (0.0, 0.1, &START));
}

/// A shortened step is watched and looked into as any other.
#[test]
fn a_shortened_step_is_looked_into() {
    fn check<M: Copy>(method: M, tolerance: f64)
    where
        Pendulum: Flow<M, 1, Scalar = f64>,
    {
        let by = Pendulum { r: 0.0 }.by(method, 0.5);
        // When it passes 0, without an end.
        let zero = by.run(START).watch(|at| [at.q[0]]).next().unwrap().unwrap();
        for beyond in [0.01, 0.1, 0.4] {
            let mut run = by.run(START);
            let mut watch = run.watch(|at| [at.q[0]]).crossing([Crossing::Falling]).until(zero.time + beyond);
            let event = watch.next().unwrap().unwrap();
            assert!((event.time - zero.time).abs() < 1e-12, "{} {}", event.time, zero.time);
            assert!(watch.next().is_none());
            assert_eq!(run.time(), zero.time + beyond);
        }
        let mut run = by.run(START);
        let mut watch = run.watch(|at| [at.q[0]]).until(zero.time - 1e-3);
        assert!(watch.next().is_none(), "it is not there yet");
        // What is known for nothing, of a step that was shortened, near to what a step says.
        let mut run = by.run(START);
        let mut dense = run.dense();
        dense.next().unwrap().unwrap();
        let expected = dense.state_at(0.3).unwrap();
        let mut run = by.run(START);
        assert_eq!(run.until(0.3).map(Result::unwrap).count(), 1);
        assert!((run.state().q - expected.q).norm() < tolerance, "{:?} {expected:?}", run.state());
    }
    check(Midpoint, 1e-15);
    check(Trapezoidal, 1e-15);
    check(Gauss::<2>, 1e-15);
    check(Gauss::<4>, 1e-14);
    check(Gauss::<8>, 1e-14);
}

/// A planet in time scaled by r^{3/2}.
struct Planet;

#[rayleigh_system(rule = gauss)]
impl Planet {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
    }
    fn time_scale(&self, q: [f64; 2]) -> f64 {
        (q[0] * q[0] + q[1] * q[1]).powf(0.75)
    }
}

/// Steps that follow the motion end at a time as well, and go on from σ there.
#[test]
fn steps_that_follow_the_motion_end_at_a_time() {
    use dalembert::run::Run;
    let start = State { q: vector![0.4, 0.0], p: vector![0.0, 2.0] };
    let mut run = Planet.by(Gauss::<6>, 0.1).run(start).in_scaled_time();
    let ticks: Vec<f64> = (1..30).map(|k| 0.21 * f64::from(k)).chain([std::f64::consts::TAU]).collect();
    for tick in ticks {
        assert!(run.until(tick).all(|step| step.is_ok()));
        assert_eq!(Run::time(&run), tick);
    }
    // A period later it is where it was.
    assert!((run.state().q - start.q).norm() < 1e-9, "{:?}", run.state());
}

/// Steps in scaled time follow σ after a run has ended at a time, too.
#[test]
fn steps_follow_the_motion_after_an_end() {
    // σ grows eightfold from pericentre to apocentre.
    let start = State { q: vector![0.4, 0.0], p: vector![0.0, 2.0] };
    let mut run = Planet.by(Gauss::<6>, 0.2).run(start).in_scaled_time();
    assert!(run.until(3.1).all(|step| step.is_ok()));
    let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
    while run.time() < 20.0 {
        run.next().unwrap().unwrap();
        (least, largest) = (least.min(run.step_size()), largest.max(run.step_size()));
    }
    assert!(largest > 6.0 * least, "{least} {largest}");
}
