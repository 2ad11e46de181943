//! A pendulum with linear drag, released near the top: the discrete points of the variational midpoint rule
//! on the continuous curve, as in figure 1 of the paper.
//!
//! Lengths in l, times in √(l/g), masses in m: all quantities are dimensionless.
//!
//! ```text
//! cargo run --release --example pendulum [picture.svg]
//! ```

use std::iter::once;

use anyhow::Result;
use dalembert::{Discretise, Midpoint, State, rayleigh_system};
use dalembert_examples::baseline::{self, Method};
use dalembert_examples::picture::{self, Axis, Curve, Mark, Panel, colour, linear};

/// L and R of a pendulum of unit mass and length; q is the angle from the lowest point.
#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

const H: f64 = 0.2;
const STEPS: usize = 150;
/// Points of the continuous curve between two discrete ones.
const FINE: usize = 10;

fn main() -> Result<()> {
    let system = Pendulum { r: 0.2 };
    let start = State::from_velocity(&system, [3.0], [0.0])?;

    let steps = system.by(Midpoint, H).run(start).take(STEPS);
    let discrete = once(Ok(start)).chain(steps.map(|step| Ok(step?.state))).collect::<Result<Vec<_>>>()?;
    let states = baseline::states(&system, Method::DormandPrince853(1e-13), H / FINE as f64, start)?;
    let continuous = once(Ok(start)).chain(states).take(FINE * STEPS + 1).collect::<Result<Vec<_>>>()?;

    println!("Angle q and energy E, h = {H}, dimensionless; the discrete points and the continuous curve");
    println!("     t          q   on curve     error          E   on curve     error");
    for k in (0..=STEPS).step_by(STEPS / 10) {
        let [point, on_curve] = [discrete[k], continuous[FINE * k]];
        let [e, e_on_curve] = [point.energy(&system)?, on_curve.energy(&system)?];
        println!(
            "{:6.1} {:10.6} {:10.6} {:9.1e} {e:10.6} {e_on_curve:10.6} {:9.1e}",
            k as f64 * H,
            point.q[0],
            on_curve.q[0],
            point.q[0] - on_curve.q[0],
            e - e_on_curve,
        );
    }

    let panel = |title, x: Axis<'static>, y: Axis<'static>, point: fn(f64, &State<f64, 1>) -> (f64, f64)| {
        let points = |h: f64, states: &[State<f64, 1>]| {
            states.iter().enumerate().map(|(k, state)| point(k as f64 * h, state)).collect()
        };
        let curves = vec![
            Curve::line("continuous", colour::REFERENCE, 2, points(H / FINE as f64, &continuous)),
            Curve::marks("midpoint, h = 0.2", colour::VARIATIONAL, Mark::Disc, points(H, &discrete)),
        ];
        Panel::new(title, x, y, curves)
    };
    let (angle, momentum) = (linear("angle q (rad)"), linear("momentum p (dimensionless)"));
    let panels = [
        panel(
            "The discrete angle stays on the curve",
            linear("time t (dimensionless)"),
            angle,
            |t, state| (t, state.q[0]),
        ),
        panel("From near the top it spirals in to rest", angle, momentum, |_, state| {
            (state.q[0], state.p[0])
        }),
    ];
    println!("\nPicture: {}", picture::write("pendulum", [1240, 560], 2, &panels)?.display());
    Ok(())
}
