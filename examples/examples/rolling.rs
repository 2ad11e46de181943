//! A cart on two wheels that roll without slipping, pushed off backwards with its load ahead of the axle: it
//! turns about and goes on with the load in front, until friction of the bearings brings it to rest. With
//! its radius of gyration, half the track, friction changes how fast it goes its way, but not the way.
//!
//! Each wheel has an angle of its own, and three constraints of velocity say that neither slips, along or
//! across. A step keeps them to rounding, in its middle and at its end, and the energy to an error of its
//! order. It keeps no symplectic form, as the motion does not: without friction all motions of one energy
//! pass from backwards to forwards. So nothing keeps the energy over a long run: with the load ahead it
//! drifts, with the load on the axle it does not. A method of higher order leaves less of that. SI units.
//!
//! ```text
//! cargo run --release --example rolling [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use dalembert::nalgebra::SVector;
use dalembert::step::Flow;
use dalembert::system::Constrained;
use dalembert::{Composition, Discretise, EnergyLedger, Midpoint, State, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, colour, linear};

/// Mass of cart, wheels and load, kg.
pub const MASS: f64 = 12.0;
/// Half the distance between the wheels, m, and the radius of gyration about the middle of the axle.
pub const HALF_TRACK: f64 = 0.25;
/// The radius of a wheel, m.
pub const RADIUS: f64 = 0.1;
/// The moment of inertia of a wheel about the axle, kg m².
pub const WHEEL: f64 = 0.01;

/// The cart: place of the middle of the axle, heading, and angles of the left and the right wheel.
pub struct Cart {
    /// How far ahead of the axle the centre of mass is, m.
    pub ahead: f64,
    /// Friction of each bearing, N m s.
    pub friction: f64,
    /// Stiffness of a bowl that it rolls in, N/m: 0 for a floor.
    pub bowl: f64,
}

#[rayleigh_system]
impl Cart {
    fn lagrangian(&self, q: [f64; 5], v: [f64; 5]) -> f64 {
        let [along, left] = [self.ahead * q[2].cos(), self.ahead * q[2].sin()];
        let [x, y] = [q[0] + along, q[1] + left];
        let [rate_x, rate_y] = [v[0] - left * v[2], v[1] + along * v[2]];
        let inertia = MASS * (HALF_TRACK * HALF_TRACK - self.ahead * self.ahead);
        0.5 * MASS * (rate_x * rate_x + rate_y * rate_y)
            + 0.5 * inertia * v[2] * v[2]
            + 0.5 * WHEEL * (v[3] * v[3] + v[4] * v[4])
            - 0.5 * self.bowl * (x * x + y * y)
    }

    fn rayleigh(&self, v: [f64; 5]) -> f64 {
        0.5 * self.friction * (v[3] * v[3] + v[4] * v[4])
    }

    fn velocity_constraints(&self, q: [f64; 5], v: [f64; 5]) -> [f64; 3] {
        let along = q[2].cos() * v[0] + q[2].sin() * v[1];
        let across = q[2].cos() * v[1] - q[2].sin() * v[0];
        let turning = HALF_TRACK * v[2];
        [across, along - turning - RADIUS * v[3], along + turning - RADIUS * v[4]]
    }
}

impl Cart {
    /// At the origin, heading along x.
    ///
    /// # Errors
    /// Those of [`State::from_velocity`].
    pub fn pushed_off(&self) -> Result<State<f64, 5>> {
        let [speed, turning] = START;
        let wheels = [(speed - turning) / RADIUS, (speed + turning) / RADIUS];
        Ok(State::from_velocity(self, [0.0; 5], [speed, 0.0, turning / HALF_TRACK, wheels[0], wheels[1]])?)
    }

    /// Its motion to `time` in steps of `h`.
    ///
    /// # Errors
    /// Those of steps.
    pub fn motion(&self, h: f64, time: f64) -> Result<Vec<Moment>> {
        let (by, mut state) = (self.by(Midpoint, h), self.pushed_off()?);
        let (mut account, mut moments) = (EnergyLedger::default(), Vec::new());
        for (k, step) in by.run(state).take((time / h).round() as usize + 1).enumerate() {
            let (step, v) = (step?, state.velocity(self)?);
            moments.push(Moment {
                time: k as f64 * h,
                q: state.q,
                speeds: [state.q[2].cos() * v[0] + state.q[2].sin() * v[1], HALF_TRACK * v[2]],
                across: by.reactions::<3>(&state, &step)?[0],
                slip: Constrained::velocity_constraints(self, &state.q, &v).amax(),
                account,
            });
            account += by.ledger(&state, &step.state)?;
            state = step.state;
        }
        Ok(moments)
    }

    /// Times and the share of its energy that it has gained, every hundredth step of `h` to `time`.
    ///
    /// # Errors
    /// Those of steps.
    pub fn gained<M: Copy>(&self, method: M, h: f64, time: f64) -> Result<Vec<(f64, f64)>>
    where
        Self: Flow<M, 5>,
    {
        let start = self.pushed_off()?;
        let energy = start.energy(self)?;
        let mut run = self.by(method, h).run(start);
        let samples = run.sample_every(100).take((time / h / 100.0) as usize);
        samples
            .map(|sample| {
                let sample = sample?;
                Ok((sample.time, sample.energy(self)? / energy - 1.0))
            })
            .collect()
    }
}

/// Speed and turning at the start, m/s: of the middle of the axle, and of the wheels about it.
pub const START: [f64; 2] = [-0.995, 0.1];
/// The load ahead of the axle, m.
pub const AHEAD: f64 = 0.2;
/// Friction of each bearing, N m s.
pub const FRICTION: f64 = 0.028;
/// The step size, s.
pub const H: f64 = 0.01;
/// The time to rest, s.
pub const END: f64 = 100.0;
/// Stiffness of the bowl, N/m.
pub const BOWL: f64 = 12.0;
/// The step size in the bowl, s, and the time there.
pub const LONG: [f64; 2] = [0.05, 1000.0];

/// The cart at one time.
#[derive(Clone, Copy)]
pub struct Moment {
    /// The time, s.
    pub time: f64,
    /// Place, heading and angles of the wheels, m and rad.
    pub q: SVector<f64, 5>,
    /// Speed and turning, as in [`START`].
    pub speeds: [f64; 2],
    /// The force of the floor across the wheels, N.
    pub across: f64,
    /// The largest velocity by which a wheel slips, m/s.
    pub slip: f64,
    /// Where energy has gone so far, J.
    pub account: EnergyLedger<f64>,
}

/// The energy gained in the bowl: by the midpoint rule with the load ahead and on the axle, and by a
/// composition of order 8 with the load ahead.
///
/// # Errors
/// Those of steps.
pub fn in_the_bowl(time: f64) -> Result<[Vec<(f64, f64)>; 3]> {
    let [ahead, on_axle] = [AHEAD, 0.0].map(|ahead| Cart { ahead, friction: 0.0, bowl: BOWL });
    let midpoint = [&ahead, &on_axle].map(|cart| cart.gained(Midpoint, LONG[0], time));
    let [drifting, staying] = midpoint;
    let by_order_8 = ahead.gained(Composition::kahan_li_8(Midpoint), 2.0 * LONG[0], time)?;
    Ok([drifting?, staying?, by_order_8])
}

fn main() -> Result<()> {
    let damped = Cart { ahead: AHEAD, friction: FRICTION, bowl: 0.0 }.motion(H, END)?;
    let free = Cart { ahead: AHEAD, friction: 0.0, bowl: 0.0 }.motion(H, 6.0)?;
    let end = damped.last().context("a motion")?;
    let turned = damped.iter().find(|at| at.speeds[0] > 0.0).context("it turns about")?.time;
    println!(
        "Pushed off backwards, about at {turned:.2} s, at rest after {:.1}°. h = {H} s.",
        end.q[2].to_degrees()
    );
    let EnergyLedger { change, dissipated, .. } = end.account;
    let finer = Cart { ahead: AHEAD, friction: FRICTION, bowl: 0.0 }.motion(0.5 * H, END)?;
    let finer = finer.last().context("a motion")?.account;
    println!("\nchange of the energy  {change:10.6} J");
    println!("taken by the bearings {dissipated:10.6} J");
    println!(
        "by the method         {:10.1e} J, with half the step {:.1e} J",
        end.account.remainder(),
        finer.remainder()
    );
    let most = |value: fn(&Moment) -> f64| damped.iter().map(value).fold(0.0, f64::max);
    println!(
        "\nA wheel slips by {:.1e} m/s at most: {:.0} roundings of 1 m/s.",
        most(|at| at.slip),
        most(|at| at.slip) / f64::EPSILON
    );
    println!("Across the wheels the floor bears {:.1} N at most.", most(|at| at.across.abs()));

    let bowl = in_the_bowl(LONG[1])?;
    println!("\nWithout friction in a bowl for {:.0} s, energy gained of what there was:", LONG[1]);
    for (name, gained) in ["load ahead", "load on the axle", "load ahead, by order 8"].iter().zip(&bowl) {
        println!("{name:24} {:8.1e}", gained.last().context("a run")?.1);
    }
    println!("\nPicture: {}", draw(&damped, &free, &bowl)?.display());
    Ok(())
}

/// The axle, and from its middle the way to the load.
fn outline(q: &SVector<f64, 5>) -> Vec<(f64, f64)> {
    let at = |along: f64, left: f64| {
        (q[0] + along * q[2].cos() - left * q[2].sin(), q[1] + along * q[2].sin() + left * q[2].cos())
    };
    vec![at(0.0, HALF_TRACK), at(0.0, -HALF_TRACK), at(0.0, 0.0), at(AHEAD, 0.0)]
}

/// The path on the left, above the energy that goes; on the right how it turns about, above the energy that
/// should stay.
fn draw(damped: &[Moment], free: &[Moment], bowl: &[Vec<(f64, f64)>; 3]) -> Result<PathBuf> {
    let path = |moments: &[Moment]| -> Vec<_> { moments.iter().map(|at| (at.q[0], at.q[1])).collect() };
    let end = damped.last().context("a motion")?;
    let mut floor = Vec::new();
    for (k, seconds) in [0.7, 1.4, 2.2, 3.2].into_iter().enumerate() {
        let label = if k == 0 { "axle and load on the way" } else { "" };
        let at = &damped[(seconds / H).round() as usize];
        floor.push(Curve::line(label, colour::SIXTH, 3, outline(&at.q)));
    }
    floor.extend([
        Curve::line("at the start", colour::EULER, 4, outline(&damped[0].q)),
        Curve::line("at rest", colour::REFERENCE, 4, outline(&end.q)),
        Curve::line("path", colour::VARIATIONAL, 3, path(damped)),
        Curve::line("path without friction", colour::RUNGE_KUTTA, 2, path(&free[..(3.2 / H) as usize]))
            .dashed(Dash::Dashed),
        Curve::marks(
            "load",
            colour::REFERENCE,
            Mark::Disc,
            vec![outline(&damped[0].q)[3], outline(&end.q)[3]],
        ),
    ]);

    let speeds =
        |moments: &[Moment]| -> Vec<_> { moments.iter().map(|at| (at.speeds[0], at.speeds[1])).collect() };
    let turning = vec![
        Curve::line("without friction", colour::RUNGE_KUTTA, 3, speeds(free)).dashed(Dash::Dashed),
        Curve::line("with friction", colour::VARIATIONAL, 3, speeds(damped)),
        Curve::marks("start", colour::EULER, Mark::Disc, vec![(START[0], START[1])]),
    ];

    let over_time = |value: &dyn Fn(&Moment) -> f64| -> Vec<_> {
        damped.iter().filter(|at| at.time <= 10.0).map(|at| (at.time, value(at))).collect()
    };
    let left = over_time(&|at| at.account.change - end.account.change);
    let energy = vec![
        Curve::line("energy", colour::VARIATIONAL, 3, left),
        Curve::line("taken by the bearings", colour::EULER, 3, over_time(&|at| at.account.dissipated))
            .dashed(Dash::Dashed),
    ];

    let percent = |gained: &[(f64, f64)]| gained.iter().map(|&(time, share)| (time, 100.0 * share)).collect();
    let drift = vec![
        Curve::line("midpoint, load ahead", colour::VARIATIONAL, 2, percent(&bowl[0])),
        Curve::line("order 8, load ahead", colour::EULER, 3, percent(&bowl[2])),
        Curve::line("midpoint, load on the axle", colour::RUNGE_KUTTA, 3, percent(&bowl[1]))
            .dashed(Dash::Dotted),
    ];
    let time = linear("time t (s)");
    let panels = [
        Panel::new("Pushed off backwards, it turns about", linear("x (m)"), linear("y (m)"), floor)
            .to_equal_scale(),
        Panel::new(
            "Without friction it ends forwards, as fast",
            linear("speed of the axle (m/s)"),
            linear("turning, at a wheel (m/s)"),
            turning,
        )
        .to_equal_scale(),
        Panel::new("The bearings take the energy", time, linear("energy (J)"), energy),
        Panel::new(
            "In a bowl midpoint loses energy, order 8 does not",
            time,
            linear("energy gained (%)"),
            drift,
        ),
    ];
    picture::write("rolling", [1240, 1160], 2, &panels)
}
