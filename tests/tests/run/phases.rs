//! Runs that go on by other fields or another system at an event: the error is that of the method, and not of
//! a force that jumps.
//!
//! Each piece of the motion has a closed form, and the places where pieces meet are roots of that.

use dalembert::run::DrivenTrajectory;
use dalembert::run::between::Moment;
use dalembert::run::events::{Crossing, EventError};
use dalembert::step::Flow;
use dalembert::{Composition, Discretise, Gauss, Midpoint, State, StepError, Trajectory, rayleigh_system};
use dalembert_tests::draws::Draws;

const GRAVITY: f64 = 9.81;

/// A mass of 1 with weight, on a spring and a damper where there are some.
#[derive(Clone, Copy, Debug)]
struct Ball {
    k: f64,
    d: f64,
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Ball {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - GRAVITY * q[0] - 0.5 * self.k * q[0] * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.d * v[0] * v[0]
    }
}

impl Ball {
    /// (q, v) after a time, by the closed form: a fall, or a damped oscillation.
    fn after(&self, [q, v]: [f64; 2], t: f64) -> [f64; 2] {
        if self.k == 0.0 {
            return [q + v * t - 0.5 * GRAVITY * t * t, v - GRAVITY * t];
        }
        let (a, rest) = (0.5 * self.d, -GRAVITY / self.k);
        let w = (self.k - a * a).sqrt();
        let (decay, (s, c)) = ((-a * t).exp(), (w * t).sin_cos());
        let (x, y) = (q - rest, (v + a * (q - rest)) / w);
        [rest + decay * (x * c + y * s), decay * ((y * w - a * x) * c - (x * w + a * y) * s)]
    }

    /// When `g` first falls through 0 within `most`: looked for in small steps, then halved.
    fn falls(&self, from: [f64; 2], most: f64, g: impl Fn([f64; 2]) -> f64) -> Option<f64> {
        const PARTS: f64 = 4096.0;
        let value = |t: f64| g(self.after(from, t));
        let mut before = most * 1e-9;
        for part in 1..=PARTS as u32 {
            let t = most * f64::from(part) / PARTS;
            if value(before) > 0.0 && value(t) <= 0.0 {
                let (mut low, mut high) = (before, t);
                for _ in 0..100 {
                    let middle = 0.5 * (low + high);
                    *(if value(middle) > 0.0 { &mut low } else { &mut high }) = middle;
                }
                return Some(high);
            }
            before = t;
        }
        None
    }
}

const AIR: Ball = Ball { k: 0.0, d: 0.0 };
const FLOOR: Ball = Ball { k: 1e4, d: 20.0 };
/// (q, v) of the ball from rest at 1 after a time of 2, by 30 digits of another program.
const AT_TWO: [f64; 2] = [0.0825384544071, -1.1920205349830];

fn push(q: f64, v: f64) -> f64 {
    -FLOOR.k * q - FLOOR.d * v
}

/// A phase: its system, and what falls through 0 where it ends.
type Phase = (&'static Ball, fn(&Moment<'_, Ball, 1>) -> [f64; 1]);

const PHASES: [Phase; 2] = [(&AIR, |at| [at.q[0]]), (&FLOOR, |at| [push(at.q[0], at.velocity()[0])])];

fn at_rest() -> State<f64, 1> {
    State::from_velocity(&AIR, [1.0], [0.0]).unwrap()
}

/// Follows the phases up to `end`: the times of the switches.
fn follow<M>(run: &mut Trajectory<'static, Ball, M, 1>, end: f64) -> Result<Vec<f64>, EventError>
where
    Ball: Flow<M, 1, Scalar = f64>,
{
    let mut switches = Vec::new();
    for (system, ends) in PHASES.into_iter().cycle() {
        run.restart_with(system, *run.state());
        let mut watch = run.watch(ends).crossing([Crossing::Falling]).terminal([true]).until(end);
        match watch.next().transpose()? {
            Some(event) => switches.push(event.time),
            None => break,
        }
    }
    assert_eq!(run.time(), end);
    Ok(switches)
}

fn error(state: &State<f64, 1>) -> f64 {
    (state.q[0] - AT_TWO[0]).abs().max((state.p[0] - AT_TWO[1]).abs())
}

#[test]
fn a_ball_that_is_only_pushed_bounces_to_rounding() -> Result<(), EventError> {
    let mut run = AIR.by(Gauss::<6>, 0.005).run(at_rest());
    let switches = follow(&mut run, 2.0)?;
    assert!(error(run.state()) < 1e-12, "{:e}", error(run.state()));
    // The closed form of each piece, from the last switch.
    let (mut at, mut time) = ([1.0, 0.0], 0.0);
    for (piece, &switch) in switches.iter().enumerate() {
        let next = match piece % 2 {
            0 => AIR.falls(at, 2.0, |[q, _]| q),
            _ => FLOOR.falls(at, 0.1, |[q, v]| push(q, v)),
        };
        let lasts = next.unwrap();
        at = if piece % 2 == 0 { AIR } else { FLOOR }.after(at, lasts);
        time += lasts;
        assert!((switch - time).abs() < 1e-13, "{piece}: {switch} {time}");
    }
    assert_eq!(switches.len(), 6);
    let exact = AIR.after(at, 2.0 - time);
    assert!((exact[0] - AT_TWO[0]).abs() < 1e-12 && (exact[1] - AT_TWO[1]).abs() < 1e-12, "{exact:?}");
    Ok(())
}

#[test]
fn methods_keep_their_order_across_switches() -> Result<(), EventError> {
    fn slope<M: Copy>(method: M, h: f64) -> Result<f64, EventError>
    where
        Ball: Flow<M, 1, Scalar = f64>,
    {
        let mut errors = [0.0; 2];
        for (error_by, h) in errors.iter_mut().zip([h, 0.5 * h]) {
            let mut run = AIR.by(method, h).run(at_rest());
            follow(&mut run, 2.0)?;
            *error_by = error(run.state());
        }
        Ok((errors[0] / errors[1]).log2())
    }
    let found = [slope(Midpoint, 1e-3)?, slope(Gauss::<2>, 4e-3)?, slope(Gauss::<3>, 8e-3)?];
    for (slope, order) in found.into_iter().zip([2.0, 4.0, 6.0]) {
        assert!((slope - order).abs() < 0.25, "{found:?}");
    }
    Ok(())
}

/// Positive control: the push is in the force, and steps go over its ends.
struct SteppedOver;

#[rayleigh_system(rule = [midpoint, gauss])]
impl SteppedOver {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - GRAVITY * q[0]
    }
    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        if q[0] < 0.0 { [(-1e4 * q[0] - 20.0 * v[0]).max(0.0)] } else { [0.0] }
    }
}

#[test]
fn steps_over_the_switches_err_by_far_more() {
    let mut run = SteppedOver.by(Midpoint, 1e-4).run(at_rest());
    run.until(2.0).for_each(|step| assert!(step.is_ok()));
    let found = (run.state().q[0] - AT_TWO[0]).abs();
    assert!(found > 1e-3 && found < 2e-3, "{found:e}");
}

#[test]
fn the_ball_comes_to_rest_on_the_floor() -> Result<(), EventError> {
    let mut run = AIR.by(Gauss::<3>, 0.01).run(at_rest());
    let switches = follow(&mut run, 20.0)?;
    // It leaves the floor as often as it comes to it, but for the last time.
    assert!(switches.len() % 2 == 1 && switches.len() > 10, "{}", switches.len());
    let State { q, p } = run.state();
    assert!((q[0] + GRAVITY / FLOOR.k).abs() < 1e-15 && p[0].abs() < 1e-13, "{q} {p}");
    Ok(())
}

/// Springs and dampers of any size above 0 and below it: the same numbers by the closed form of each piece.
#[test]
fn random_pieces_follow_their_closed_forms() {
    let cases = if cfg!(debug_assertions) { 40 } else { 400 };
    let mut draws = Draws::new(11);
    let (mut compared, mut switched) = (0, 0);
    for case in 0..cases {
        let mut piece = || {
            let k = draws.scale(3.0, 300.0);
            Ball { k, d: draws.between(0.0, 0.4) * k.sqrt() }
        };
        let pieces = [piece(), piece()];
        let from = [draws.between(-1.0, 1.0), draws.between(-30.0, 30.0)];
        let (mut side, end) = (usize::from(from[0] < 0.0), 6.0);
        let first = side;
        let start = State { q: [from[0]].into(), p: [from[1]].into() };
        let mut run = pieces[side].by(Gauss::<6>, 0.05).run(start);
        let mut switches = Vec::new();
        loop {
            let sign = [1.0, -1.0][side];
            let mut watch =
                run.watch(|at| [sign * at.q[0]]).crossing([Crossing::Falling]).terminal([true]).until(end);
            let Some(event) = watch.next() else { break };
            let event = event.unwrap_or_else(|error| panic!("{case}: {error}"));
            switches.push((event.time, event.velocity[0]));
            side = 1 - side;
            watch.restart_with(&pieces[side], event.state);
        }
        // A passage without speed is no place to compare.
        if switches.iter().any(|(_, v)| v.abs() < 1e-2) {
            continue;
        }
        let (mut at, mut time, mut by_hand) = (from, 0.0, first);
        for (switch, _) in &switches {
            let sign = [1.0, -1.0][by_hand];
            let lasts = pieces[by_hand].falls(at, end - time, |[q, _]| sign * q);
            let lasts = lasts.unwrap_or_else(|| panic!("{case}: none before {switch}"));
            at = pieces[by_hand].after(at, lasts);
            time += lasts;
            by_hand = 1 - by_hand;
            assert!((switch - time).abs() < 1e-11, "{case}: {switch} {time}");
        }
        let exact = pieces[by_hand].after(at, end - time);
        let off = (run.state().q[0] - exact[0]).abs().max((run.state().p[0] - exact[1]).abs());
        assert!(by_hand == side && off < 1e-10, "{case}: {off:e}");
        compared += 1;
        switched += switches.len();
    }
    assert!(compared * 10 > cases * 9 && switched > 4 * compared, "{compared} {switched}");
}

/// A mass of 1 on a spring, pushed.
struct Pushed {
    k: f64,
    push: f64,
}

#[rayleigh_system(rule = gauss)]
impl Pushed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0] + self.push * q[0]
    }
}

/// Thermostats and limit switches: the function turns back where it vanishes, and in one watch.
#[test]
fn a_switch_may_turn_the_motion_back() -> Result<(), EventError> {
    let pushes = [Pushed { k: 0.0, push: -1.0 }, Pushed { k: 0.0, push: 1.0 }];
    let mut run = pushes[0].by(Gauss::<2>, 0.3).run(State { q: [0.0].into(), p: [0.0].into() });
    let mut watch = run.watch(|at| [at.velocity()[0] + 1.0, 1.0 - at.velocity()[0]]);
    watch = watch.crossing([Crossing::Falling; 2]).terminal([true; 2]).until(20.0);
    let mut switches = 0;
    while let Some(event) = watch.next().transpose()? {
        assert_eq!(event.index, switches % 2);
        assert!((event.time - (1.0 + 2.0 * switches as f64)).abs() < 1e-13, "{}", event.time);
        switches += 1;
        watch.restart_with(&pushes[switches % 2], event.state);
    }
    assert_eq!(switches, 10);
    Ok(())
}

#[test]
fn stick_and_slip_are_phases_of_high_order() -> Result<(), EventError> {
    let ways = [Pushed { k: 1.0, push: 0.2 }, Pushed { k: 1.0, push: -0.2 }];
    // Pushed against the way it slides, which is at first that of v.
    for ([q, v], at, rest) in
        [([0.9, -0.3], 5.878293520894, 0.161577310586), ([0.5, 0.7], 7.068583470577, -0.010050506339)]
    {
        let mut way = usize::from(v > 0.0);
        let mut run = ways[way].by(Gauss::<4>, 0.1).run(State { q: [q].into(), p: [v].into() });
        loop {
            let stop = run.watch(|at| [at.velocity()[0]]).terminal([true]).next().unwrap()?;
            if stop.state.q[0].abs() <= 0.2 {
                break;
            }
            way = usize::from(stop.state.q[0] < 0.0);
            run.restart_with(&ways[way], stop.state);
        }
        let found = [run.time(), run.state().q[0]];
        assert!((found[0] - at).abs() < 1e-11 && (found[1] - rest).abs() < 1e-11, "{found:?}");
    }
    Ok(())
}

/// Where the stop is.
const STOP: f64 = 0.1;
/// From the pull on a motor to a load behind a spring.
const STIFFNESS: f64 = 40.0;
const DRAG: f64 = 3.0;

/// A motor that drives a load by a spring.
struct Motor;

#[rayleigh_system(rule = midpoint)]
impl Motor {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * STIFFNESS * (q[0] - q[1]) * (q[0] - q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * DRAG * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 2], _v: [f64; 2], t: f64) -> [f64; 2] {
        [4.0 * t.sin(), 0.0]
    }
}

/// The same with its load on the stop.
struct OnStop;

#[rayleigh_system(rule = midpoint)]
impl OnStop {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * STIFFNESS * (q[0] - q[1]) * (q[0] - q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * DRAG * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 2], _v: [f64; 2], t: f64) -> [f64; 2] {
        [4.0 * t.sin(), 0.0]
    }
    fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
        [q[1] - STOP]
    }
}

/// The motor alone, beside a load that stands on the stop.
struct Alone;

#[rayleigh_system(rule = midpoint)]
impl Alone {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * STIFFNESS * (q[0] - STOP) * (q[0] - STOP)
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * DRAG * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [4.0 * t.sin()]
    }
}

#[test]
fn a_stop_is_a_phase_that_its_reaction_ends() -> Result<(), EventError> {
    let (motor, on_stop, alone) = (Motor.at_time(0.0), OnStop.at_time(0.0), Alone.at_time(0.0));
    let start = State { q: [0.0, 0.0].into(), p: [0.0, 0.0].into() };
    let method = Composition::kahan_li_8(Midpoint);
    let mut free = motor.by(method, 0.02).run(start);
    let mut watch =
        free.watch(|at| [STOP - at.q[1]]).crossing([Crossing::Falling]).terminal([true]).until(9.0);
    let mut impacts = 0;
    loop {
        match watch.next() {
            Some(Ok(hit)) => {
                let p = [hit.state.p[0], -0.5 * hit.state.p[1]].into();
                watch.restart(State { q: hit.state.q, p });
                impacts += 1;
            }
            Some(Err(EventError::Chattering { .. })) => break,
            other => panic!("{other:?}"),
        }
    }
    assert!(impacts > 10 && (free.state().q[1] - STOP).abs() < 1e-12, "{impacts}");
    let (from, v) = (free.time(), free.velocity()?);
    let mut held = free.handed_to(&on_stop, State::nearest(&on_stop, free.state().q, [v[0], 0.0])?);
    assert_eq!((held.time(), held.step_size()), (from, free.step_size()));
    let mut watch = held.watch(|at| at.reactions().into());
    watch = watch.crossing([Crossing::Rising]).terminal([true]).until(9.0);
    let release = watch.next().unwrap()?;
    // The other phase with one coordinate less, released where the spring no longer presses.
    let mut beside = free.handed_to(&alone, State { q: [free.state().q[0]].into(), p: [v[0]].into() });
    let mut watch = beside.watch(|at| [at.q[0] - STOP]).crossing([Crossing::Falling]).terminal([true]);
    let expected = watch.next().unwrap()?;
    assert!((release.time - expected.time).abs() < 1e-11, "{} {}", release.time, expected.time);
    assert!((release.state.p[0] - expected.state.p[0]).abs() < 1e-11 && release.time > from + 1.0);
    // It goes on away from the stop; a load that stays held would not.
    free.restart_at(release.time, release.state);
    free.until(release.time + 0.3).try_for_each(|step| step.map(drop))?;
    assert!(free.state().q[1] < STOP - 1e-3, "{}", free.state().q);
    Ok(())
}

#[test]
fn runs_with_inputs_are_handed_on_with_their_clock() -> Result<(), StepError> {
    let start = State { q: [0.0, 0.2].into(), p: [0.0, 0.0].into() };
    let mut run: DrivenTrajectory<MotorAtTime<'_>, Midpoint, 2> = DrivenTrajectory::new(0.01, start);
    for _ in 0..10 {
        run.advance(&Motor.at_time(run.time()))?;
    }
    let State { q, p } = run.state();
    let mut alone = run.handed_to::<AloneAtTime<'_>, 1>(State { q: [q[0]].into(), p: [p[0]].into() });
    alone.advance(&Alone.at_time(run.time()))?;
    assert_eq!((run.time(), alone.time()), (0.1, 0.1 + 0.01));
    Ok(())
}

#[test]
fn a_system_that_cannot_go_on_leaves_the_state() -> Result<(), StepError> {
    let broken = Ball { k: f64::NAN, d: 0.0 };
    let mut run = AIR.by(Gauss::<3>, 0.01).run(at_rest());
    run.by_ref().take(5).for_each(|step| assert!(step.is_ok()));
    let (state, time) = (*run.state(), run.time());
    run.restart_with(&broken, state);
    assert!(matches!(run.next(), Some(Err(_))) && run.next().is_none());
    assert_eq!((run.state(), run.time()), (&state, time));
    // Positive control: with the fields of before it goes on.
    run.restart_with(&AIR, state);
    run.next().unwrap()?;
    assert!(run.time() > time);
    Ok(())
}
