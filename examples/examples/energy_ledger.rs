//! Where the energy goes: the ledger of friction and of the method itself, for the variational midpoint rule,
//! the classical Runge–Kutta method and implicit Euler on the ring potential with weak drag.
//!
//! All quantities are dimensionless.
//!
//! ```text
//! cargo run --release --example energy_ledger [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::Result;
use dalembert::{Discretise, EnergyLedger, Midpoint, State, StepError, rayleigh_system};
use dalembert_examples::baseline::{self, Method};
use dalembert_examples::picture::{self, Curve, Dash, Panel, RGBColor, colour, linear, logarithmic};

/// A particle of unit mass in the potential s(s − 1)², s = |q|², with isotropic drag.
#[rayleigh_system]
fn ring(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed - s * (s - 1.0).powi(2), 0.5 * k * speed)
}

const RING: Ring = Ring { k: 1e-3 };
/// The step size.
const H: f64 = 0.1;
/// The number of steps: T = 1000.
const STEPS: usize = 10_000;

fn main() -> Result<()> {
    let start = State::from_velocity(&RING, [0.0, 1.15549918674982], [0.5, 0.0])?;
    let by = RING.by(Midpoint, H);
    let midpoint = by.run(start).map(|step| Ok(step?.state));
    let runge_kutta = baseline::states(&RING, Method::RungeKutta4, H, start)?;
    let implicit = baseline::states(&RING, Method::ImplicitEuler, H, start)?;
    let runs = [
        Run::of(start, midpoint, |a, b| by.ledger(a, b), "variational midpoint", colour::VARIATIONAL)?,
        Run::of(start, runge_kutta, from_the_ends, "Runge–Kutta 4", colour::RUNGE_KUTTA)?,
        Run::of(start, implicit, from_the_ends, "implicit Euler", colour::EULER)?,
    ];

    println!(
        "Where the energy went over {STEPS} steps of h = {H}; E = 0.275 at the start. All is dimensionless."
    );
    println!("                          change   dissipated  by the method  largest of one step");
    for run in &runs {
        let EnergyLedger { change, dissipated, .. } = run.total;
        println!(
            "{:20} {change:11.6} {dissipated:12.6} {:14.1e} {:20.1e}",
            run.method,
            run.total.remainder(),
            run.largest,
        );
    }
    println!("\nPicture: {}", draw(&runs)?.display());
    Ok(())
}

/// The ledger of a step that no method of the library made.
fn from_the_ends(before: &State<f64, 2>, after: &State<f64, 2>) -> Result<EnergyLedger<f64>, StepError> {
    EnergyLedger::of(&RING, before, after, H)
}

/// The ledger along a motion.
struct Run {
    method: &'static str,
    colour: RGBColor,
    /// All steps added up.
    total: EnergyLedger<f64>,
    /// Largest remainder of a single step.
    largest: f64,
    /// Dissipation and remainder so far, after each step.
    course: Vec<(f64, f64, f64)>,
}

impl Run {
    fn of(
        start: State<f64, 2>,
        states: impl Iterator<Item = Result<State<f64, 2>>>,
        ledger: impl Fn(&State<f64, 2>, &State<f64, 2>) -> Result<EnergyLedger<f64>, StepError>,
        method: &'static str,
        colour: RGBColor,
    ) -> Result<Self> {
        let (mut before, mut total, mut largest) = (start, EnergyLedger::default(), 0.0_f64);
        let mut course = vec![(0.0, 0.0, 0.0)];
        for (k, state) in states.take(STEPS).enumerate() {
            let state = state?;
            let entry = ledger(&before, &state)?;
            largest = largest.max(entry.remainder().abs());
            total += entry;
            course.push(((k + 1) as f64 * H, total.dissipated, total.remainder()));
            before = state;
        }
        Ok(Self { method, colour, total, largest, course })
    }
}

fn draw(runs: &[Run]) -> Result<PathBuf> {
    let time = linear("time t (dimensionless)");
    let panel = |title, y, quantity: fn(&(f64, f64, f64)) -> f64| {
        let curve = |(run, dash): (&Run, Dash)| {
            let points = run.course.iter().map(|entry| (entry.0, quantity(entry))).collect();
            Curve::line(run.method, run.colour, 3, points).dashed(dash)
        };
        let dashes = [Dash::Solid, Dash::Dashed, Dash::DashDotted];
        Panel::new(title, time, y, runs.iter().zip(dashes).map(curve).collect())
    };
    let panels = [
        panel("Taken by friction so far", linear("∫ v·∂R/∂v dt (dimensionless)"), |entry| entry.1),
        // Implicit Euler's would set the scale of a linear axis.
        panel(
            "Taken or brought by the method itself",
            logarithmic("|ΔE + ∫ v·∂R/∂v dt| (dimensionless)").with_floor(1e-5).from_to(1e-5, 1.0),
            |entry| entry.2.abs(),
        ),
    ];
    picture::write("energy_ledger", [1600, 600], 2, &panels)
}
