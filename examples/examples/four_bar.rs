//! A four-bar linkage in coordinates of its bars, from rest to rest: a motor turns the crank once around and
//! is switched off, and friction in the joints brings the linkage to rest. Where its energy goes, what the
//! joints carry, and what a constraint that says again what the others say changes: no motion, but the
//! multipliers.
//!
//! Each bar has the place of its centre and an angle, so that L is a sum over bars; eight constraints pin
//! their ends to each other and to the ground. SI units.
//!
//! ```text
//! cargo run --release --example four_bar [picture.svg]
//! ```

use std::array;
use std::f64::consts::TAU;
use std::path::PathBuf;

use anyhow::{Context, Result};
use dalembert::system::Constrained;
use dalembert::{Discretise, EnergyLedger, Midpoint, State};
use dalembert_examples::picture::{self, Curve, Dash, Panel, colour, linear};
use dalembert_scenes::four_bar::{COMBINATION, FourBar, G, MASSES, Redundant};

/// Friction of each joint, N m s.
pub const FRICTION: f64 = 0.1;
/// The torque of the motor while it drives, N m.
pub const TORQUE: f64 = 3.0;
/// The step size, s.
pub const H: f64 = 2e-3;
/// The time from rest to rest, s.
pub const END: f64 = 10.0;

/// Runs of the linkage with this number of constraints.
macro_rules! drive {
    ($(#[$doc:meta])* $run:ident: $name:ident, $count:literal) => {
        $(#[$doc])*
        ///
        /// # Errors
        /// Those of steps.
        pub fn $run(h: f64) -> Result<Vec<Moment<$count>>> {
            let linkage = $name { friction: FRICTION };
            let still = linkage.driven([0.0]);
            let near_rest = [-0.04, -0.15, -1.86, 0.2, 0.1, 0.93, 0.7, 0.2, 2.47];
            let let_go = State::nearest(&still, near_rest, [0.0; 9])?;
            // Where it rests does not depend on the step.
            let settled = still.by(Midpoint, 0.02).run(let_go).nth(999).context("a run")??.state;
            let start = State::from_velocity(&still, settled.q, [0.0; 9])?;

            let mut run = still.by(Midpoint, h).run_with_inputs(start);
            let (mut account, mut is_driven, mut moments) = (EnergyLedger::default(), true, Vec::new());
            for _ in 0..(END / h) as usize {
                let (time, state) = (run.time(), *run.state());
                is_driven &= state.q[2] < start.q[2] + TAU;
                let driven = linkage.driven([if is_driven { TORQUE } else { 0.0 }]);
                let (step, by) = (run.advance(&driven)?, driven.by(Midpoint, h));
                let reactions = by.reactions(&state, &step)?.into();
                let off = driven.constraints(&state.q).amax();
                moments.push(Moment { time, is_driven, q: state.q.into(), reactions, off, account });
                account += by.ledger(&state, &step.state)?;
            }
            Ok(moments)
        }
    };
}

drive! {
    /// The linkage at rest under its weight, and from there on its motion by steps of `h`.
    drive: FourBar, 8
}

drive! {
    /// [`drive`] with a constraint that says again what the others say.
    drive_once_more: Redundant, 9
}

/// The linkage at one time.
#[derive(Clone, Copy)]
pub struct Moment<const M: usize> {
    /// The time, s.
    pub time: f64,
    /// Whether the motor drives.
    pub is_driven: bool,
    /// Centre and angle of each bar, m and rad.
    pub q: [f64; 9],
    /// The multipliers, N.
    pub reactions: [f64; M],
    /// The largest constraint, m.
    pub off: f64,
    /// Where energy has gone so far, J.
    pub account: EnergyLedger<f64>,
}

fn main() -> Result<()> {
    let motion = drive(H)?;
    let [start, end] = [motion[0], *motion.last().context("a motion")?];
    let driven: Vec<_> = motion.iter().copied().filter(|moment| moment.is_driven).collect();
    let turns = (end.q[2] - start.q[2]) / TAU;
    println!(
        "Driven by {TORQUE} N m for {:.3} s, a turn of the crank; at rest after {turns:.6} turns. h = {H} s.",
        driven.len() as f64 * H
    );
    let finer = drive(0.5 * H)?.last().context("a motion")?.account;
    let EnergyLedger { change, dissipated, work } = end.account;
    println!("\nwork of the motor    {work:12.6} J");
    println!("taken by the joints  {dissipated:12.6} J");
    println!("change of the energy {change:12.1e} J");
    println!(
        "by the method        {:12.1e} J, with half the step {:.1e} J",
        end.account.remainder(),
        finer.remainder()
    );

    let off = motion.iter().map(|moment| moment.off).fold(0.0, f64::max);
    println!("\nOff a constraint at most {off:.1e} m: {:.0} roundings of a metre.", off / f64::EPSILON);
    let [left, right] = [end.reactions[1], end.reactions[7]];
    let weight = G * MASSES.iter().sum::<f64>();
    println!(
        "At rest the pivots carry {left:.6} + {right:.6} N, but for {:.0e} N the weight.",
        left + right - weight
    );

    let again = compare(&motion, &drive_once_more(H)?);
    println!("\nWith a ninth constraint, which follows from four of the others:");
    println!(
        "q differs by {:.1e} at most, forces on the bars by {:.1e} of the largest,",
        again.q, again.forces
    );
    println!("and the multipliers by up to {:.1} N, which the ninth has taken over.", again.taken_over);
    println!("\nPicture: {}", draw(&motion, &driven)?.display());
    Ok(())
}

/// What the ninth constraint changes, at most.
pub struct Comparison {
    /// In q, m or rad.
    pub q: f64,
    /// In the forces Gᵀλ, of the largest multiplier.
    pub forces: f64,
    /// Its own multiplier, N.
    pub taken_over: f64,
}

/// The motions with eight and nine constraints side by side.
pub fn compare(eight: &[Moment<8>], nine: &[Moment<9>]) -> Comparison {
    let (mut found, mut largest) = (Comparison { q: 0.0, forces: 0.0, taken_over: 0.0 }, 0.0_f64);
    for (eight, nine) in eight.iter().zip(nine) {
        let ninth = nine.reactions[8];
        for (a, b) in eight.q.iter().zip(nine.q) {
            found.q = found.q.max((a - b).abs());
        }
        for ((a, b), n) in eight.reactions.iter().zip(nine.reactions).zip(COMBINATION) {
            largest = largest.max(a.abs());
            // Along n no force changes.
            found.forces = found.forces.max((a - (b + n * ninth)).abs());
        }
        found.taken_over = found.taken_over.max(ninth.abs());
    }
    found.forces /= largest;
    found
}

/// A point of the coupler, this far beside its centre, m.
const BESIDE: f64 = 0.35;

/// Pivot, crank's end, coupler's point, coupler's end, and the other pivot.
fn outline(q: &[f64; 9]) -> [(f64, f64); 5] {
    let [near, far] = FourBar { friction: FRICTION }.ends(*q);
    let point = (q[3] - BESIDE * q[5].sin(), q[4] + BESIDE * q[5].cos());
    let [pivot, first, second, other] = [near[0], far[0], far[1], near[2]].map(|[x, y]| (x, y));
    [pivot, first, point, second, other]
}

/// The linkage and its energy on the left, reactions and constraints on the right.
fn draw(motion: &[Moment<8>], driven: &[Moment<8>]) -> Result<PathBuf> {
    let start = &driven[0];
    let turned = |moment: &Moment<8>| (moment.q[2] - start.q[2]).to_degrees();
    let bars = |moment: &Moment<8>| {
        let [pivot, first, _, second, other] = outline(&moment.q);
        vec![pivot, first, second, other]
    };
    let path = driven.iter().map(|moment| outline(&moment.q)[2]).collect();
    let mut linkage = Vec::new();
    for k in 1..6 {
        let reached = driven.iter().find(|moment| turned(moment) >= 60.0 * f64::from(k)).context("a turn")?;
        let label = if k == 1 { "every 60° of the crank" } else { "" };
        linkage.push(Curve::line(label, colour::SIXTH, 2, bars(reached)));
    }
    let [pivot, first, point, second, other] = outline(&start.q);
    let at_rest = vec![pivot, first, point, second, first, second, other];
    linkage.push(Curve::line("at rest", colour::REFERENCE, 4, at_rest));
    linkage.push(Curve::line("path of the coupler's point", colour::RUNGE_KUTTA, 3, path));

    let carried = |[x, y]: [usize; 2]| -> Vec<_> {
        driven.iter().map(|moment| (turned(moment), moment.reactions[x].hypot(moment.reactions[y]))).collect()
    };
    let names = ["ground and crank", "crank and coupler", "coupler and rocker", "rocker and ground"];
    let colours = [colour::VARIATIONAL, colour::RUNGE_KUTTA, colour::EULER, colour::FOURTH];
    let dashes = [Dash::Solid, Dash::Dashed, Dash::DashDotted, Dash::Dotted];
    let joints: [_; 4] = array::from_fn(|k| {
        Curve::line(names[k], colours[k], 3, carried([2 * k, 2 * k + 1])).dashed(dashes[k])
    });

    let shown = motion.iter().filter(|moment| moment.time < 6.0);
    let over_time = |value: fn(&Moment<8>) -> f64| -> Vec<_> {
        shown.clone().map(|moment| (moment.time, value(moment))).collect()
    };
    let energy = vec![
        Curve::line("work of the motor", colour::RUNGE_KUTTA, 3, over_time(|at| at.account.work))
            .dashed(Dash::DashDotted),
        Curve::line("taken by the joints", colour::EULER, 3, over_time(|at| at.account.dissipated))
            .dashed(Dash::Dashed),
        Curve::line("energy above rest", colour::VARIATIONAL, 3, over_time(|at| at.account.change)),
    ];
    let off = vec![Curve::line("", colour::VARIATIONAL, 1, over_time(|at| at.off / f64::EPSILON))];

    let time = linear("time t (s)");
    let panels = [
        Panel::new(
            "One turn of the crank: the coupler's path closes",
            linear("x (m)"),
            linear("y (m)"),
            linkage,
        )
        .to_equal_scale(),
        Panel::new(
            "Joints carry most at the end of the driven turn",
            linear("angle of the crank from rest (°)"),
            linear("reaction (N)"),
            joints.into(),
        ),
        Panel::new("The joints take all the work of the motor", time, linear("energy (J)"), energy),
        Panel::new(
            "The constraints hold to a few roundings",
            time,
            linear("|g|, largest of eight (2.2·10⁻¹⁶ m)"),
            off,
        ),
    ];
    picture::write("four_bar", [1240, 1160], 2, &panels)
}
