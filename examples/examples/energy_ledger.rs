//! Where the energy goes: the ledger of friction and of the method itself, for the variational midpoint rule,
//! the classical Runge–Kutta method, at equal step size and at equal cost, and implicit Euler on the ring
//! potential with weak drag.
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
/// So many steps of Runge–Kutta 4 cost as much as one of the midpoint rule: the scene `ring` has measured it.
const AS_DEAR: usize = 7;

fn main() -> Result<()> {
    let start = State::from_velocity(&RING, [0.0, 1.15549918674982], [0.5, 0.0])?;
    let by = RING.by(Midpoint, H);
    let midpoint = by.run(start).map(|step| Ok(step?.state));
    let runge_kutta = baseline::states(&RING, Method::RungeKutta4, H, start)?;
    let implicit = baseline::states(&RING, Method::ImplicitEuler, H, start)?;
    let finer = baseline::states(&RING, Method::RungeKutta4, H / AS_DEAR as f64, start)?;
    let runs = [
        Run::of(start, midpoint, 1, |a, b, _| by.ledger(a, b), ("midpoint", colour::VARIATIONAL))?,
        Run::of(start, runge_kutta, 1, from_the_ends, ("Runge–Kutta 4, equal h", colour::RUNGE_KUTTA))?,
        Run::of(start, finer, AS_DEAR, from_the_ends, ("Runge–Kutta 4, h/7: equal cost", colour::FIFTH))?,
        Run::of(start, implicit, 1, from_the_ends, ("implicit Euler", colour::EULER))?,
    ];

    println!(
        "Where the energy went over {STEPS} steps of h = {H}; E = 0.275 at the start. All is dimensionless."
    );
    println!("                                    change   dissipated  by the method  largest of one step");
    for run in &runs {
        let EnergyLedger { change, dissipated, .. } = run.total;
        println!(
            "{:30} {change:11.6} {dissipated:12.6} {:14.1e} {:20.1e}",
            run.method,
            run.total.remainder(),
            run.largest,
        );
    }
    println!("\nPicture: {}", draw(&runs)?.display());
    Ok(())
}

/// The ledger of a step that no method of the library made.
fn from_the_ends(
    before: &State<f64, 2>,
    after: &State<f64, 2>,
    h: f64,
) -> Result<EnergyLedger<f64>, StepError> {
    EnergyLedger::of(&RING, before, after, h)
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
    /// The motion in steps of the `parts`-th part of h.
    fn of(
        start: State<f64, 2>,
        states: impl Iterator<Item = Result<State<f64, 2>>>,
        parts: usize,
        ledger: impl Fn(&State<f64, 2>, &State<f64, 2>, f64) -> Result<EnergyLedger<f64>, StepError>,
        (method, colour): (&'static str, RGBColor),
    ) -> Result<Self> {
        let h = H / parts as f64;
        let (mut before, mut total, mut largest) = (start, EnergyLedger::default(), 0.0_f64);
        let mut course = vec![(0.0, 0.0, 0.0)];
        for (k, state) in states.take(STEPS * parts).enumerate() {
            let state = state?;
            let entry = ledger(&before, &state, h)?;
            largest = largest.max(entry.remainder().abs());
            total += entry;
            course.push(((k + 1) as f64 * h, total.dissipated, total.remainder()));
            before = state;
        }
        Ok(Self { method, colour, total, largest, course })
    }
}

fn draw(runs: &[Run]) -> Result<PathBuf> {
    let time = linear("time t (dimensionless)");
    let panel = |title, y, quantity: fn(&(f64, f64, f64)) -> f64| {
        let curve = |(run, dash): (&Run, Dash)| {
            // The largest of every 100 entries, or of as many at first as there are: a line, not a band.
            let largest = |entries: &[(f64, f64, f64)]| {
                let values = entries.iter().map(quantity);
                (entries[entries.len() / 2].0, values.fold(0.0, f64::max))
            };
            let (first, rest) = run.course.split_at(100);
            let points = (first.chunks(10).chain(rest.chunks_exact(100))).map(largest).collect();
            Curve::line(run.method, run.colour, 3, points).dashed(dash)
        };
        let dashes = [Dash::Solid, Dash::Dashed, Dash::Dotted, Dash::DashDotted];
        Panel::new(title, time, y, runs.iter().zip(dashes).map(curve).collect())
    };
    let panels = [
        panel(
            "Implicit Euler leaves friction little to take",
            linear("taken by friction, ∫ v·∂R/∂v dt (dimensionless)"),
            |entry| entry.1,
        ),
        // Implicit Euler's would set the scale of a linear axis.
        panel(
            "The method's own part: midpoint's does not grow",
            logarithmic("|ΔE + ∫ v·∂R/∂v dt| (dimensionless)").with_floor(1e-7).from_to(1e-7, 1.0),
            |entry| entry.2.abs(),
        ),
    ];
    picture::write("energy_ledger", [1240, 620], 2, &panels)
}
