//! A crane that carries a load 12 m while its hoist lifts it, from a rope of 9 m to one of 4 m, and brings it
//! to rest. A force drives the trolley; the length of the rope is prescribed, by a constraint on trolley and
//! load that depends on time.
//!
//! An LQR has a gain for each step of the lift, for little force on the way and rest at its end, and one gain
//! from then on. A and B are those of the generated step, along an exact motion: the load hangs still at the
//! end of the way but for the lift. They are 6×6 and 6×1, in the coordinates of trolley and load. A deviation
//! off the constraint counts as the nearest state on it, so that four eigenvalues of A are those of trolley
//! and angle and two are 0: the Riccati equation needs no basis along the constraint. Beside: the same gains
//! for a controller that does not see the load swing. SI units.
//!
//! ```text
//! cargo run --release --example crane [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use dalembert::nalgebra::{SMatrix, SVector, matrix};
use dalembert::{Discretise, EnergyLedger, Midpoint, State, rayleigh_system};
use dalembert_examples::control::{self, Linearised, Regulator};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, colour, linear};

/// A trolley on a rail and a load on a rope: q is the place of the trolley, and how far along and up the load
/// is.
pub struct Crane {
    /// Mass of the trolley, kg.
    pub trolley: f64,
    /// Mass of the load, kg.
    pub load: f64,
    /// Friction of the rail and drag of the load, N s/m.
    pub drag: [f64; 2],
}

#[rayleigh_system]
impl Crane {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * self.trolley * v[0] * v[0] + 0.5 * self.load * (v[1] * v[1] + v[2] * v[2])
            - self.load * G * q[2]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.drag[0] * v[0] * v[0] + 0.5 * self.drag[1] * (v[1] * v[1] + v[2] * v[2])
    }

    fn force(&self, _q: [f64; 3], _v: [f64; 3], u: [f64; 1]) -> [f64; 3] {
        [u[0], 0.0, 0.0]
    }

    fn constraints(&self, q: [f64; 3], t: f64) -> [f64; 1] {
        let beside = q[1] - q[0];
        [(beside * beside + q[2] * q[2]).sqrt() - self.rope(t)]
    }

    /// The length of the rope, m, smooth from rest to rest.
    fn rope(&self, t: f64) -> f64 {
        let s = (t / LIFT).clamp(0.0, 1.0);
        ROPE[0] + (ROPE[1] - ROPE[0]) * s * s * s * (10.0 - s * (15.0 - 6.0 * s))
    }
}

/// Acceleration of gravity, m/s².
pub const G: f64 = 9.81;
/// The crane of the scene.
pub const CRANE: Crane = Crane { trolley: 2000.0, load: 1000.0, drag: [60.0, 5.0] };
/// Lengths of the rope before and after the lift, m.
pub const ROPE: [f64; 2] = [9.0, 4.0];
/// The time that the lift takes, s.
pub const LIFT: f64 = 12.0;
/// The way of trolley and load, m.
pub const WAY: f64 = 12.0;
/// The period of the controller and the step size, s.
pub const H: f64 = 0.05;
/// Periods in all: half a minute.
pub const PERIODS: usize = 600;

/// Costs from the end of the lift on: of the trolley off its place and the load beside the trolley, 1/m², and
/// of their rates, s²/m².
const COSTS: [f64; 4] = [1.0, 20.0, 1.0, 20.0];
/// The cost of the force, 1/N².
const EFFORT: f64 = 1e-7;

/// The load at rest at the end of the way, but for the lift.
fn target(t: f64) -> Result<SVector<f64, 6>> {
    // Nearest to rest is that it goes up as the rope does.
    let state = State::nearest(&CRANE.driven([0.0], t), [WAY, WAY, -CRANE.rope(t)], [0.0; 3])?;
    Ok(control::vector(&state))
}

/// The step with its A and B from the target.
fn model(t: f64) -> Result<Linearised<6, 1>> {
    Ok(control::linearised(&CRANE.driven([0.0], t), &target(t)?, H)?)
}

/// The gain of each period.
///
/// # Errors
/// Those of steps, and of [`Regulator`].
pub fn gains() -> Result<Vec<SMatrix<f64, 1, 6>>> {
    let [trolley, load] = [1.0 / CRANE.trolley, 1.0 / CRANE.load];
    // Place, beside, and their rates, of (q, p).
    let seen = matrix![
        1.0, 0.0, 0.0, 0.0, 0.0, 0.0;
        -1.0, 1.0, 0.0, 0.0, 0.0, 0.0;
        0.0, 0.0, 0.0, trolley, 0.0, 0.0;
        0.0, 0.0, 0.0, -trolley, load, 0.0
    ];
    let costs = seen.transpose() * SMatrix::from_diagonal(&COSTS.into()) * seen;
    let mut regulator = Regulator::of(&model(LIFT)?, &costs, &matrix![EFFORT])?;
    let mut gains = vec![regulator.gain; PERIODS];
    for k in (0..(LIFT / H) as usize).rev() {
        let model = model(k as f64 * H)?;
        regulator = Regulator::before(&regulator.cost, &model, &SMatrix::zeros(), &matrix![EFFORT])?;
        gains[k] = regulator.gain;
    }
    Ok(gains)
}

/// The crane at one time.
#[derive(Clone, Copy)]
pub struct Moment {
    /// The time, s.
    pub time: f64,
    /// Trolley, load along and load up, m.
    pub q: SVector<f64, 3>,
    /// The angle of the rope from below, rad.
    pub swing: f64,
    /// The force of the drive, N.
    pub drive: f64,
    /// The force in the rope, N.
    pub tension: f64,
    /// Where energy has gone so far, J: what remains has come by the hoist.
    pub account: EnergyLedger<f64>,
}

/// The motion from rest under a controller that sees the load swing, or one that takes it to hang below the
/// trolley.
///
/// # Errors
/// Those of steps.
pub fn carried(gains: &[SMatrix<f64, 1, 6>], sees_swing: bool) -> Result<Vec<Moment>> {
    let still = CRANE.driven([0.0], 0.0);
    let start = State::from_velocity(&still, [0.0, 0.0, -ROPE[0]], [0.0; 3])?;
    let mut run = still.by(Midpoint, H).run_with_inputs(start);
    let (mut account, mut moments) = (EnergyLedger::default(), Vec::new());
    for gain in gains {
        let (time, state) = (run.time(), *run.state());
        let mut seen = state;
        if !sees_swing {
            seen.q[1] = seen.q[0];
            seen.p[1] = seen.p[0] * CRANE.load / CRANE.trolley;
        }
        let drive = -(gain * (control::vector(&seen) - target(time)?))[0];
        let driven = CRANE.driven([drive], time);
        let (step, by) = (run.advance(&driven)?, driven.by(Midpoint, H));
        let (q, tension) = (state.q, -by.reactions::<1>(&state, &step)?[0]);
        moments.push(Moment { time, q, swing: (q[1] - q[0]).atan2(-q[2]), drive, tension, account });
        account += by.ledger(&state, &step.state)?;
    }
    Ok(moments)
}

/// The largest swing from a time on, rad.
pub fn largest_swing(moments: &[Moment], from: f64) -> f64 {
    moments.iter().filter(|at| at.time >= from).map(|at| at.swing.abs()).fold(0.0, f64::max)
}

fn main() -> Result<()> {
    let gains = gains()?;
    let [seeing, blind] = [carried(&gains, true)?, carried(&gains, false)?];
    println!(
        "{WAY} m along in {LIFT} s, on a rope of {} m that becomes {} m. h = {H} s.\n",
        ROPE[0], ROPE[1]
    );
    println!("swing in degrees at most  in all  from {:.0} s  from {:.0} s", LIFT + 1.0, LIFT + 8.0);
    for (name, moments) in [("sees it", &seeing), ("does not", &blind)] {
        let [all, after, late] =
            [0.0, LIFT + 1.0, LIFT + 8.0].map(|from| largest_swing(moments, from).to_degrees());
        println!("{name:24}  {all:6.2}  {after:9.2}  {late:9.3}");
    }
    let tensions = || seeing.iter().map(|at| at.tension);
    let end = seeing.last().context("a motion")?;
    println!(
        "\nIn the rope {:.0} to {:.0} N, at the end {:.2} N; the load weighs {:.2} N.",
        tensions().fold(f64::INFINITY, f64::min),
        tensions().fold(0.0, f64::max),
        end.tension,
        G * CRANE.load
    );
    let off = seeing.iter().map(|at| ((at.q[0] - at.q[1]).hypot(at.q[2]) - CRANE.rope(at.time)).abs());
    println!("The rope is {:.1e} m longer or shorter than it should be, at most.", off.fold(0.0, f64::max));
    let EnergyLedger { change, dissipated, work } = end.account;
    println!("\nby the hoist        {:10.1} J", end.account.remainder());
    println!("by the drive        {work:10.1} J");
    println!("taken by friction   {dissipated:10.1} J");
    println!(
        "change of energy    {change:10.1} J, for the lift {:.1} J",
        G * CRANE.load * (ROPE[0] - ROPE[1])
    );
    println!("\nPicture: {}", draw(&seeing, &blind)?.display());
    Ok(())
}

/// Where it goes, above forces and energy.
fn draw(seeing: &[Moment], blind: &[Moment]) -> Result<PathBuf> {
    let of = |moments: &[Moment], value: &dyn Fn(&Moment) -> f64| -> Vec<_> {
        moments.iter().filter(|at| at.time <= 24.0).map(|at| (at.time, value(at))).collect()
    };
    let mut way = Vec::new();
    for (k, at) in seeing.iter().step_by((2.0 / H) as usize).take(7).enumerate() {
        let label = if k == 0 { "rope, every 2 s" } else { "" };
        way.push(Curve::line(label, colour::SIXTH, 2, vec![(at.q[0], 0.0), (at.q[1], at.q[2])]));
        let label = if k == 0 { "load" } else { "" };
        way.push(Curve::marks(label, colour::REFERENCE, Mark::Disc, vec![(at.q[1], at.q[2])]));
    }
    way.push(Curve::line("rail", colour::GREY, 3, vec![(-0.5, 0.0), (WAY + 0.5, 0.0)]));
    let path = seeing.iter().map(|at| (at.q[1], at.q[2])).collect();
    way.push(Curve::line("path of the load", colour::VARIATIONAL, 3, path));

    let places = vec![
        Curve::line("trolley", colour::VARIATIONAL, 3, of(seeing, &|at| at.q[0])),
        Curve::line("load", colour::RUNGE_KUTTA, 3, of(seeing, &|at| at.q[1])).dashed(Dash::Dashed),
        Curve::line("rope", colour::EULER, 3, of(seeing, &|at| CRANE.rope(at.time))).dashed(Dash::DashDotted),
    ];
    let pair = |value: &dyn Fn(&Moment) -> f64| {
        vec![
            Curve::line("sees the swing", colour::VARIATIONAL, 3, of(seeing, value)),
            Curve::line("does not", colour::RUNGE_KUTTA, 2, of(blind, value)).dashed(Dash::Dashed),
        ]
    };
    let mut tensions = pair(&|at| 1e-3 * at.tension);
    tensions.push(
        Curve::line("weight", colour::REFERENCE, 1, of(seeing, &|_| 1e-3 * G * CRANE.load))
            .dashed(Dash::Dotted),
    );
    let energy = vec![
        Curve::line("by the hoist", colour::EULER, 3, of(seeing, &|at| 1e-3 * at.account.remainder())),
        Curve::line("by the drive", colour::RUNGE_KUTTA, 3, of(seeing, &|at| 1e-3 * at.account.work))
            .dashed(Dash::Dashed),
        Curve::line("taken by friction", colour::FOURTH, 3, of(seeing, &|at| 1e-3 * at.account.dissipated))
            .dashed(Dash::DashDotted),
    ];
    let time = linear("time t (s)");
    let panels = [
        Panel::new("The load is lifted while it travels", linear("along (m)"), linear("up (m)"), way)
            .to_equal_scale(),
        Panel::new("The load arrives with the trolley", time, linear("place, length (m)"), places),
        Panel::new(
            "Seen, the swing ends with the travel",
            time,
            linear("rope from below (°)"),
            pair(&|at| at.swing.to_degrees()),
        ),
        Panel::new(
            "Blind, the drive keeps the swing alive",
            time,
            linear("on the trolley (kN)"),
            pair(&|at| 1e-3 * at.drive),
        ),
        Panel::new("The rope carries little but the weight", time, linear("tension (kN)"), tensions),
        Panel::new("The hoist brings nearly all the energy", time, linear("energy (kJ)"), energy),
    ];
    picture::write("crane", [1240, 1740], 2, &panels)
}
