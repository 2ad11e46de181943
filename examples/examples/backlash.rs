//! A motor that drives a load through gears with play, against a stop: impacts, rest and release, under a
//! torque that changes every 7 ms beside steps of 2 ms. SI units.
//!
//! While the load is free, L has two coordinates and each impact on the stop ends a step at its own time.
//! Where impacts accumulate, the load rests on the stop and L has one, until the teeth no longer press it
//! there.
//!
//! ```text
//! cargo run --release --example backlash -- [picture.svg]
//! ```

use anyhow::{Result, bail};
use dalembert::run::DrivenTrajectory;
use dalembert::run::events::{Crossing, EventError, Watched};
use dalembert::{Discretise, Gauss, State, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, colour, linear};
use nalgebra::vector;

/// Inertia of the motor and of the load, kg m².
const INERTIA: [f64; 2] = [2e-4, 1e-3];
/// Friction of their bearings, N m s.
const DRAG: [f64; 2] = [2e-3, 4e-3];
/// Stiffness of the teeth, N m/rad.
pub const STIFFNESS: f64 = 40.0;
/// Half the play between them, rad.
pub const PLAY: f64 = 0.02;
/// The angle of the stop, rad.
pub const STOP: f64 = 0.5;
/// What an impact leaves of the load's speed.
const RESTITUTION: f64 = 0.5;
/// The torque, first one way and then the other, N m.
pub const TORQUE: f64 = 0.05;
/// When it turns, s.
pub const TURNS: f64 = 0.8;
/// Control period and step size, s.
const PERIOD: f64 = 7e-3;
const H: f64 = 2e-3;
/// Control periods.
const PERIODS: u32 = 128;

/// Motor and load, both free.
struct Free;

#[rayleigh_system(rule = gauss)]
impl Free {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        // Beyond the play the teeth are a spring.
        let beyond = ((q[0] - q[1]).abs() - PLAY).max(0.0);
        0.5 * (INERTIA[0] * v[0] * v[0] + INERTIA[1] * v[1] * v[1]) - 0.5 * STIFFNESS * beyond * beyond
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (DRAG[0] * v[0] * v[0] + DRAG[1] * v[1] * v[1])
    }
    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0], 0.0]
    }
}

/// The motor, with the load at rest on the stop.
struct Pressed;

#[rayleigh_system(rule = gauss)]
impl Pressed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let beyond = ((q[0] - STOP).abs() - PLAY).max(0.0);
        0.5 * INERTIA[0] * v[0] * v[0] - 0.5 * STIFFNESS * beyond * beyond
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * DRAG[0] * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

/// A run under one of the two.
enum Phase {
    Free(DrivenTrajectory<DrivenFree<'static>, Gauss<3>, 2>),
    Pressed(DrivenTrajectory<DrivenPressed<'static>, Gauss<3>, 1>),
}

impl Phase {
    fn time(&self) -> f64 {
        match self {
            Self::Free(run) => run.time(),
            Self::Pressed(run) => run.time(),
        }
    }
}

/// The motion, as far as it is drawn.
#[derive(Default)]
pub struct Motion {
    /// Times, and the angles of motor and load, at the end of every step.
    pub angles: Vec<(f64, [f64; 2])>,
    /// Times of the impacts.
    pub impacts: Vec<f64>,
    /// When the load came to rest on the stop.
    pub rests: Vec<f64>,
    /// When it was released.
    pub releases: Vec<f64>,
}

fn main() -> Result<()> {
    let motion = drive()?;
    println!("{} impacts on the stop, the first at {:.6} s", motion.impacts.len(), motion.impacts[0]);
    for (rest, release) in motion.rests.iter().zip(&motion.releases) {
        println!("at rest on it from {rest:.6} s, released at {release:.6} s");
    }
    println!("\nPicture: {}", draw(&motion)?.display());
    Ok(())
}

/// The motion under the controller.
pub fn drive() -> Result<Motion> {
    let start = State { q: vector![PLAY, 0.0], p: vector![0.0, 0.0] };
    let mut phase = Phase::Free(Free.driven([0.0]).by(Gauss::<3>, H).run_with_inputs(start));
    let mut motion = Motion::default();
    for period in 1..=PERIODS {
        let tick = PERIOD * f64::from(period);
        let torque = if phase.time() < TURNS { TORQUE } else { -TORQUE };
        // A period may have several phases.
        while phase.time() < tick {
            phase = match phase {
                Phase::Free(run) => free(run, torque, tick, &mut motion)?,
                Phase::Pressed(run) => pressed(run, torque, tick, &mut motion)?,
            };
        }
    }
    Ok(motion)
}

/// Both move, until the tick or until the load rests.
fn free(
    mut run: DrivenTrajectory<DrivenFree<'static>, Gauss<3>, 2>,
    torque: f64,
    tick: f64,
    motion: &mut Motion,
) -> Result<Phase> {
    let system = Free.driven([torque]);
    let mut held = run.hold(&system);
    let mut watch =
        held.watch(|at| [STOP - at.q[1]]).crossing([Crossing::Falling]).terminal([true]).until(tick);
    let mut rests = false;
    while let Some(item) = watch.advance() {
        match item {
            Ok(Watched::Step(step)) => motion.angles.push((watch.run().time(), step.state.q.into())),
            Ok(Watched::Event(impact)) => {
                motion.impacts.push(impact.time);
                motion.angles.push((impact.time, impact.state.q.into()));
                let p = vector![impact.state.p[0], -RESTITUTION * impact.state.p[1]];
                watch.restart(State { q: impact.state.q, p });
            }
            Err(EventError::Chattering { .. }) => rests = true,
            Err(error) => bail!(error),
        }
    }
    if !rests {
        return Ok(Phase::Free(run));
    }
    motion.rests.push(run.time());
    let State { q, p } = run.state();
    Ok(Phase::Pressed(run.handed_to(State { q: vector![q[0]], p: vector![p[0]] })))
}

/// The motor moves, until the tick or until its teeth no longer press the load onto the stop.
fn pressed(
    mut run: DrivenTrajectory<DrivenPressed<'static>, Gauss<3>, 1>,
    torque: f64,
    tick: f64,
    motion: &mut Motion,
) -> Result<Phase> {
    let system = Pressed.driven([torque]);
    let mut held = run.hold(&system);
    let mut watch =
        held.watch(|at| [at.q[0] - STOP + PLAY]).crossing([Crossing::Falling]).terminal([true]).until(tick);
    let event = loop {
        match watch.advance().transpose()? {
            Some(Watched::Step(step)) => motion.angles.push((watch.run().time(), [step.state.q[0], STOP])),
            Some(Watched::Event(event)) => break event,
            None => return Ok(Phase::Pressed(run)),
        }
    };
    motion.releases.push(event.time);
    motion.angles.push((event.time, [event.state.q[0], STOP]));
    let start = State { q: vector![event.state.q[0], STOP], p: vector![event.state.p[0], 0.0] };
    Ok(Phase::Free(run.handed_to(start)))
}

fn draw(motion: &Motion) -> Result<std::path::PathBuf> {
    let angle =
        |of: usize| motion.angles.iter().map(|(time, angles)| (*time, angles[of])).collect::<Vec<_>>();
    let end = motion.angles.last().map_or(0.0, |last| last.0);
    let at_stop = |times: &[f64]| times.iter().map(|&time| (time, STOP)).collect::<Vec<_>>();
    let curves = vec![
        Curve::line("motor", colour::FIFTH, 2, angle(0)),
        Curve::line("load", colour::VARIATIONAL, 2, angle(1)),
        Curve::marks("impacts", colour::RUNGE_KUTTA, Mark::Disc, at_stop(&motion.impacts)),
        Curve::marks("released", colour::SIXTH, Mark::Disc, at_stop(&motion.releases)),
        Curve::line("the stop", colour::REFERENCE, 2, vec![(0.0, STOP), (end, STOP)]).dashed(Dash::Dashed),
    ];
    let panels = [Panel::new(
        "Geared against a stop the load bounces, rests, and is released",
        linear("time t (s)"),
        linear("angle (rad)"),
        curves,
    )];
    picture::write("backlash", [1000, 640], 1, &panels)
}
