//! Events and ends that were once lost or refused, found by random runs of one who read the guide and no
//! code.

use std::f64::consts::PI;

use dalembert::nalgebra::vector;
use dalembert::run::events::{Crossing, EventError, Passage};
use dalembert::step::Flow;
use dalembert::{Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A ball that falls 5 t² in a time t.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn ball(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 10.0 * q[0]
}

/// Impacts on ticks, to rounding, before it and after: told once, by the period before or the one after, with
/// the rebound of the documentation's loop; a very short step after one is no rest.
#[test]
fn impacts_on_ticks_are_told_once() {
    fn check<M: Copy>(method: M)
    where
        Ball: Flow<M, 1, Scalar = f64>,
    {
        for h in [0.01, 0.02, 0.1, 0.25] {
            for period in [0.1, 0.15, 0.25, 0.3, 0.5, 0.007, 0.013, 0.033] {
                for ticks in (1..40).step_by(if cfg!(debug_assertions) { 7 } else { 1 }) {
                    let fall = period * f64::from(ticks);
                    let start = State { q: vector![5.0 * fall * fall], p: vector![0.0] };
                    let mut run = Ball {}.by(method, h).run(start);
                    let mut impacts = Vec::new();
                    for tick in 1..=ticks + 1 {
                        let watch = run.watch(|at| [at.q[0]]).crossing([Crossing::Falling]).terminal([true]);
                        let mut watch = watch.until(period * f64::from(tick));
                        while let Some(impact) = watch.next() {
                            let impact =
                                impact.unwrap_or_else(|error| panic!("{h} {period} {ticks}: {error}"));
                            impacts.push(impact.time);
                            watch.restart(State { q: impact.state.q, p: -0.8 * impact.state.p });
                        }
                    }
                    // The next is 1.6 falls later: within the period after, if that is as long.
                    let expected = 1 + usize::from(1.6 * fall < period * (1.0 - 1e-9));
                    assert_eq!(impacts.len(), expected, "{h} {period} {ticks}: {impacts:?}");
                    assert!((impacts[0] - fall).abs() < 1e-12, "{h} {period} {ticks}: {impacts:?}");
                    assert!(run.state().q[0] > -1e-12);
                }
            }
        }
    }
    check(Midpoint);
    check(Trapezoidal);
    check(Gauss::<2>);
}

/// A mass that is stopped where the force pulls it away leaves: it presses against nothing.
#[test]
fn a_restart_at_rest_that_is_pulled_away_leaves() {
    #[rayleigh_system(rule = [midpoint, gauss])]
    fn mass(q: [f64; 1], v: [f64; 1], a: f64) -> f64 {
        0.5 * v[0] * v[0] + a * q[0]
    }
    fn check<M: Copy>(method: M, scale: f64)
    where
        Mass: Flow<M, 1, Scalar = f64>,
    {
        let mut draws = Draws::new(7);
        for _ in 0..if cfg!(debug_assertions) { 50 } else { 500 } {
            let (h, place) = (draws.scale(1e-3, 0.5), scale * draws.between(0.3, 1.0));
            let start = State { q: vector![place + draws.between(0.01, 0.05)], p: vector![-2.0] };
            let mut run = Mass { a: 1.0 }.by(method, h).run(start);
            let watch = run.watch(|at| [at.q[0] - place]).crossing([Crossing::Falling]).terminal([true]);
            let mut watch = watch.until(0.9);
            let impact = watch.next().unwrap().unwrap();
            watch.restart(State { q: impact.state.q, p: vector![0.0] });
            assert!(watch.next().is_none(), "{h} {place}");
            let left = 0.9 - impact.time;
            assert!((run.state().q[0] - place - 0.5 * left * left).abs() < 1e-12);
        }
        // Positive control: pushed onto it, it rests.
        let mut run =
            Mass { a: -1.0 }.by(method, 0.1).run(State { q: vector![scale + 0.03], p: vector![-2.0] });
        let watch = run.watch(|at| [at.q[0] - scale]).crossing([Crossing::Falling]).terminal([true]);
        let mut watch = watch.until(0.9);
        let impact = watch.next().unwrap().unwrap();
        watch.restart(State { q: impact.state.q, p: vector![0.0] });
        assert!(matches!(watch.next(), Some(Err(EventError::Chattering { .. }))));
    }
    for scale in [-1.0, 1e-20] {
        check(Midpoint, scale);
        check(Gauss::<6>, scale);
    }
}

/// Impacts accumulate on floors at any height, where the last flights are lower than the rounding of it;
/// under a controller's ticks as without. No ball is below its floor by more than that.
#[test]
fn balls_come_to_rest_on_floors_of_any_height() {
    fn check<M: Copy>(method: M, draws: &mut Draws)
    where
        Ball: Flow<M, 1, Scalar = f64>,
    {
        for _ in 0..if cfg!(debug_assertions) { 25 } else { 300 } {
            let (floor, h) = (draws.sign() * draws.scale(1e-6, 1e3), draws.scale(1e-3, 0.1));
            let restitution = draws.between(0.05, 0.8);
            let period = if draws.below(2) == 0 { 1e3 } else { draws.scale(3e-3, 0.3) };
            let start = State { q: vector![floor + draws.between(0.1, 1.0)], p: vector![0.0] };
            let mut run = Ball {}.by(method, h).run(start);
            let below = 1e-14 * floor.abs().max(1e-2);
            // The speed of a flight as high as rounding is to be told from, some 1000 last places of the
            // floor.
            let slow = (20.0 * 1024.0 * f64::EPSILON * floor.abs().max(1e-2)).sqrt();
            let mut rests = false;
            for tick in 1.. {
                let watch = run.watch(|at| [at.q[0] - floor]).crossing([Crossing::Falling]).terminal([true]);
                let mut watch = watch.until(period * f64::from(tick));
                while let Some(event) = watch.next() {
                    match event {
                        Ok(impact) => {
                            watch.restart(State { q: impact.state.q, p: -restitution * impact.state.p })
                        }
                        Err(error) => {
                            assert!(matches!(error, EventError::Chattering { .. }), "{error}");
                            rests = true;
                        }
                    }
                }
                let state = run.state();
                assert!(state.q[0] >= floor - below, "{floor} {h} {restitution} {period}: {state:?}");
                if rests {
                    assert!(state.q[0] <= floor + below && state.p[0].abs() < slow, "{floor}: {state:?}");
                    break;
                }
                assert!(run.time() < 20.0, "{floor} {h} {restitution} {period}");
            }
        }
    }
    let draws = &mut Draws::new(17);
    check(Midpoint, draws);
    check(Trapezoidal, draws);
    check(Gauss::<2>, draws);
}

/// A ball that runs into a corner meets both walls, at one time or a rounding apart, each with its own
/// rebound.
#[test]
fn both_walls_of_a_corner_are_told() {
    #[rayleigh_system(rule = gauss)]
    fn free(q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.0 * q[0]
    }
    let mut draws = Draws::new(5);
    for case in 0..if cfg!(debug_assertions) { 100 } else { 1000 } {
        let (h, x) = (draws.scale(0.01, 1.0), draws.between(0.3, 2.0));
        let apart = if case % 2 == 0 { 0.0 } else { 2e-16 * (draws.below(5) as f64 - 2.0) };
        let start = State { q: vector![x, x * (1.0 + apart)], p: vector![-1.0, -1.0] };
        let mut run = Free {}.by(Gauss::<3>, h).run(start);
        let watch = run.watch(|at| [at.q[0], at.q[1]]).crossing([Crossing::Falling; 2]).terminal([true; 2]);
        let mut watch = watch.until(5.0);
        let mut told = [0, 0];
        while let Some(impact) = watch.next() {
            let impact = impact.unwrap();
            told[impact.index] += 1;
            let mut p = impact.state.p;
            p[impact.index] *= -1.0;
            watch.restart(State { q: impact.state.q, p });
        }
        assert_eq!(told, [1, 1], "{case} {h} {x}");
        assert!((run.state().q - vector![5.0 - x, 5.0 - x]).amax() < 1e-12, "{case}: {:?}", run.state());
    }
}

/// In single precision a root within a step is where it is, and a passage.
#[test]
fn a_passage_in_single_precision_is_no_jump() {
    #[rayleigh_system]
    fn small(q: [f32; 1], v: [f32; 1]) -> f32 {
        0.5 * v[0] * v[0] - 10.0 * q[0]
    }
    let mut draws = Draws::new(3);
    let given = (0.118535474_f32, 0.012878385_f32, 0.43666098_f32);
    let drawn = std::iter::repeat_with(|| {
        let of = |low, high, draws: &mut Draws| draws.between(low, high) as f32;
        (of(0.01, 0.2, &mut draws), of(0.001, 0.1, &mut draws), of(-0.5, 0.5, &mut draws))
    });
    let mut seen = 0;
    for (h, q, v) in
        std::iter::once(given).chain(drawn.take(if cfg!(debug_assertions) { 300 } else { 20_000 }))
    {
        let (at, speed) = (f64::from(q), f64::from(v));
        let root = (speed + (speed * speed + 20.0 * at).sqrt()) / 10.0;
        if root > 0.95 * f64::from(h) {
            continue;
        }
        for crossing in [Crossing::Either, Crossing::Falling] {
            let mut run = Small {}.by(Midpoint, h).run(State { q: vector![q], p: vector![v] });
            let told: Vec<_> = run
                .watch(|at| [at.q[0]])
                .crossing([crossing])
                .until(f64::from(h))
                .map(Result::unwrap)
                .collect();
            assert!(told.len() == 1 && told[0].passage == Passage::Falling, "{h} {q} {v}: {told:?}");
            assert!((told[0].time - root).abs() < 1e-4 * f64::from(h), "{h} {q} {v}: {told:?} {root}");
        }
        seen += 1;
    }
    assert!(seen > 50, "{seen}");
}

/// The motion goes as its clock does, where ticks are few roundings of that apart.
#[test]
fn ticks_a_few_roundings_apart_move_the_motion() {
    #[rayleigh_system]
    fn mass(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.0 * q[0]
    }
    for (from, tick) in [(1e6, 1e-9), (1e9, 1e-6), (1.7e9, 3e-6)] {
        let start = State { q: vector![0.0], p: vector![1.0] };
        let mut run = Mass {}.by(Midpoint, 0.01).run(start);
        run.restart_at(from, start);
        for k in 1..=2000 {
            assert!(run.until(from + tick * f64::from(k)).all(|step| step.is_ok()));
        }
        let on = run.time() - from;
        assert!((run.state().q[0] / on - 1.0).abs() < 1e-9, "{from}: {} of {on}", run.state().q[0]);
    }
}

/// After an error a watch has ended, with what it had found of other functions.
#[test]
fn a_watch_that_has_failed_tells_no_events() {
    let mut run = Ball {}.by(Gauss::<4>, 0.5).run(State { q: vector![1.0], p: vector![0.0] });
    let noise = |q: f64| f64::from((q.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) as u32) - 1e9;
    let mut watch = run.watch(|at| [at.q[0], noise(at.q[0])]).crossing([Crossing::Falling, Crossing::Either]);
    assert!(watch.by_ref().any(|event| event.is_err()));
    assert!(watch.next().is_none());
}

/// A damped oscillator is watched to its rest: to where its numbers have no digits left, and beyond. Zeros of
/// e^{−t/2} cos(ωt + φ) are π/ω apart.
#[test]
fn an_oscillator_is_watched_to_its_rest() {
    #[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
    fn oscillator(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
        (0.5 * (v[0] * v[0] - q[0] * q[0]), 0.5 * v[0] * v[0])
    }
    fn check<M: Copy>(method: M)
    where
        Oscillator: Flow<M, 1, Scalar = f64>,
    {
        let mut run = Oscillator {}.by(method, 0.1).run(State { q: vector![1e-200], p: vector![0.0] });
        let (mut told, mut last) = (0, None::<f64>);
        for crossing in run.watch(|at| [at.q[0]]).until(650.0) {
            let crossing = crossing.unwrap_or_else(|error| panic!("{error}"));
            if crossing.state.p.amax() > 1e-300 {
                let apart = last.map_or(1.0, |last| (crossing.time - last) * 0.75_f64.sqrt() / PI);
                assert!((apart - 1.0).abs() < 2e-3, "{crossing:?} {apart}");
                (told, last) = (told + 1, Some(crossing.time));
            }
        }
        // 1e-200 e^{−t/2} is 1e-300 at t = 460.
        assert!((125..=128).contains(&told), "{told}");
        assert!(run.time() == 650.0 && run.state().q.amax() < 1e-320, "{:?}", run.state());
    }
    check(Midpoint);
    check(Trapezoidal);
    check(Gauss::<2>);
}
