//! A motor that turns a load through gears with play, with dry friction on both, under a sampled controller
//! with an integral: first onto its stop, to find where it is, then to an angle. The integral never lets go:
//! the drive stands until the torque has grown beyond the friction at rest, which falls as it moves, jumps
//! past the angle, and stands on the other side. It hunts; with a dead zone of the controller it stays where
//! it stands. SI units.
//!
//! Friction holds by `rule = proximal`: motor and load stand to the last bit. With the kink rounded off
//! nothing stands, and the hunting is another.
//!
//! ```text
//! cargo run --release --example drive [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use dalembert::{Discretise, Proximal, State, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Dash, Panel, colour, linear};

/// Inertia of the motor and of the load, kg m².
const INERTIA: [f64; 2] = [2e-4, 2e-3];
/// Dry friction of the motor and of the load, N m: at rest, and sliding; and the speed by which it falls,
/// rad/s.
pub const FRICTION: [[f64; 2]; 2] = [[0.006, 0.004], [0.03, 0.018]];
const FALLS: f64 = 0.05;
/// Viscous friction of both, N m s.
const DRAG: [f64; 2] = [2e-4, 1e-3];
/// Stiffness of the teeth, N m/rad, and half the play between them, rad.
const TEETH: [f64; 2] = [60.0, 0.01];
/// Stiffness of the stop, N m/rad, which is at 0.
const STOP: f64 = 200.0;

/// Motor and load; q are their angles.
pub struct Drive;

#[rayleigh_system(rule = proximal)]
impl Drive {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let beyond = ((q[0] - q[1]).abs() - TEETH[1]).max(0.0);
        let into = q[1].min(0.0);
        0.5 * (INERTIA[0] * v[0] * v[0] + INERTIA[1] * v[1] * v[1])
            - 0.5 * TEETH[0] * beyond * beyond
            - 0.5 * STOP * into * into
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let viscous = 0.5 * (DRAG[0] * v[0] * v[0] + DRAG[1] * v[1] * v[1]);
        Self::dry(v[0].abs(), FRICTION[0][0], FRICTION[0][1])
            + Self::dry(v[1].abs(), FRICTION[1][0], FRICTION[1][1])
            + viscous
    }

    /// The integral of friction that falls from `at_rest` to `sliding` with the speed.
    fn dry(speed: f64, at_rest: f64, sliding: f64) -> f64 {
        sliding * speed + (at_rest - sliding) * FALLS * (1.0 - (-speed / FALLS).exp())
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0], 0.0]
    }
}

/// The controller: torque from the load's angle and the motor's speed, once a period.
pub struct Controller {
    /// Gains of the load's error and of its integral, N m/rad and N m/(rad s), and of the motor's speed, N m
    /// s.
    gains: [f64; 3],
    /// The error within which it lets go, rad.
    pub dead_zone: f64,
    integral: f64,
    /// The motor's angle a period ago.
    last: f64,
}

impl Controller {
    /// With a dead zone, or with 0.
    #[must_use]
    pub fn with(dead_zone: f64) -> Self {
        Self { gains: [0.3, 0.6, 0.03], dead_zone, integral: 0.0, last: 0.0 }
    }

    /// The torque of the next period.
    fn torque(&mut self, wanted: f64, [motor, load]: [f64; 2]) -> f64 {
        let error = wanted - load;
        let speed = (motor - self.last) / PERIOD;
        self.last = motor;
        if error.abs() < self.dead_zone {
            self.integral = 0.0;
            return 0.0;
        }
        self.integral += error * PERIOD;
        let [proportional, integral, damping] = self.gains;
        let torque = proportional * error + integral * self.integral - damping * speed;
        let within = torque.clamp(-MOST, MOST);
        // What cannot be had is not asked for more and more.
        self.integral += (within - torque) / integral * 0.1;
        within
    }
}

/// The control period, s, and the step size.
const PERIOD: f64 = 2e-3;
const H: f64 = 5e-4;
/// The largest torque, N m.
pub const MOST: f64 = 0.15;
/// The torque onto the stop, N m, and until when, s.
const HOMING: [f64; 2] = [-0.06, 1.5];
/// The angle wanted, rad, and the end, s.
pub const WANTED: f64 = 1.0;
/// The end, s.
pub const END: f64 = 20.0;
/// The dead zone, rad.
pub const DEAD_ZONE: f64 = 0.02;

/// A control period: its end, the angles then, the torque, and whether all stood through it.
#[derive(Clone, Copy)]
pub struct Moment {
    /// Its end, s.
    pub time: f64,
    /// The angles of motor and load, rad.
    pub angles: [f64; 2],
    /// The torque, N m.
    pub torque: f64,
    /// Whether neither has moved.
    pub stands: bool,
}

/// The motion under a controller.
///
/// # Errors
/// Those of steps.
pub fn motion(mut controller: Controller) -> Result<Vec<Moment>> {
    let start = State { q: [0.5, 0.5].into(), p: [0.0, 0.0].into() };
    let mut run = Drive.driven([0.0]).by(Proximal, H).run_with_inputs(start);
    let mut moments = Vec::new();
    for period in 0..(END / PERIOD).round() as u32 {
        let time = f64::from(period) * PERIOD;
        let before = run.state().q;
        let torque = if time < HOMING[1] { HOMING[0] } else { controller.torque(WANTED, before.into()) };
        let system = Drive.driven([torque]);
        for step in run.hold(&system).until(time + PERIOD) {
            step?;
        }
        let angles = run.state().q;
        moments.push(Moment { time: time + PERIOD, angles: angles.into(), torque, stands: angles == before });
    }
    Ok(moments)
}

fn main() -> Result<()> {
    let hunting = motion(Controller::with(0.0))?;
    let still = motion(Controller::with(DEAD_ZONE))?;
    let onto = hunting.iter().find(|at| at.stands && at.time > 0.1).context("it comes to the stop")?;
    println!("On the stop from {:.3} s on: the load at {:.5} rad.", onto.time, onto.angles[1]);
    for (name, moments) in [("integral alone", &hunting), ("with a dead zone", &still)] {
        let late = moments.iter().filter(|at| at.time > 10.0);
        let (low, high) = late.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at.angles[1]), high.max(at.angles[1]))
        });
        let stands = late.clone().filter(|at| at.stands).count() as f64 / late.count() as f64;
        println!(
            "{name:18} from 10 s on the load is between {low:.5} and {high:.5} rad, and stands {:.0} % of the time",
            100.0 * stands
        );
    }
    println!("\nPicture: {}", draw(&hunting, &still)?.display());
    Ok(())
}

fn draw(hunting: &[Moment], still: &[Moment]) -> Result<PathBuf> {
    let over = |moments: &[Moment], value: &dyn Fn(&Moment) -> f64| -> Vec<_> {
        moments.iter().map(|at| (at.time, value(at))).collect()
    };
    let time = linear("time t (s)");
    let whole = vec![
        Curve::line("motor", colour::FIFTH, 2, over(hunting, &|at| at.angles[0])),
        Curve::line("load", colour::VARIATIONAL, 3, over(hunting, &|at| at.angles[1])),
        Curve::line("wanted", colour::REFERENCE, 2, vec![(HOMING[1], WANTED), (END, WANTED)])
            .dashed(Dash::Dotted),
    ];
    let late = |moments: &[Moment]| moments.iter().copied().filter(|at| at.time > 2.5).collect::<Vec<_>>();
    let (hunting, still) = (late(hunting), late(still));
    let error = |moments: &[Moment]| over(moments, &|at| 1e3 * (at.angles[1] - WANTED));
    let errors = vec![
        Curve::line("integral alone", colour::RUNGE_KUTTA, 2, error(&hunting)),
        Curve::line("with a dead zone", colour::VARIATIONAL, 3, error(&still)),
        Curve::line("the dead zone", colour::GREY, 2, vec![(2.5, 1e3 * DEAD_ZONE), (END, 1e3 * DEAD_ZONE)])
            .dashed(Dash::Dotted),
        Curve::line("", colour::GREY, 2, vec![(2.5, -1e3 * DEAD_ZONE), (END, -1e3 * DEAD_ZONE)])
            .dashed(Dash::Dotted),
    ];
    let torques = vec![
        Curve::line("integral alone", colour::RUNGE_KUTTA, 2, over(&hunting, &|at| at.torque)),
        Curve::line("with a dead zone", colour::VARIATIONAL, 3, over(&still, &|at| at.torque)),
    ];
    let panels = [
        Panel::new("Onto the stop, then to the angle wanted", time, linear("angle (rad)"), whole),
        Panel::new(
            "The integral hunts, a dead zone ends it",
            time,
            linear("load off the angle wanted (mrad)"),
            errors,
        ),
        Panel::new("The torque grows until friction gives way", time, linear("torque (N m)"), torques),
    ];
    picture::write("drive", [1000, 1380], 1, &panels)
}
