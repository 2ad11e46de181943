//! A counterexample: the exact discrete force of a natural Lagrangian with a Rayleigh force need not be
//! Rayleigh.
//!
//! For L = ½mv² − V(q) and R = ½rv² the obstruction D1 f_d^ex+ + D2 f_d^ex− is computed along the exact
//! motion from q0 to q1 in time h, for three potentials, and drawn against h with the leading term
//!
//! ```text
//! −(r/m)(q1−q0) h² ∫₀¹ τ²(1−τ)² V'''(q0 + τ(q1−q0)) dτ
//! ```
//!
//! It vanishes for the harmonic oscillator alone, the paper's example (section 3.4). All quantities are
//! dimensionless.
//!
//! ```text
//! cargo run --release --example conjecture [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use dalembert::exact::{Exact, Existence};
use dalembert::nalgebra::SVector;
use dalembert::rayleigh_system;
use dalembert::system::ActingForce;
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, RGBColor, colour, logarithmic};

/// V = ½q².
#[rayleigh_system]
fn harmonic(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// V = −cos q.
#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// V = ¼q⁴.
#[rayleigh_system]
fn quartic(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.25 * q[0].powi(4), 0.5 * r * v[0] * v[0])
}

const M: f64 = 1.0;
const R: f64 = 0.3;
const Q0: f64 = 0.6;
const Q1: f64 = 1.1;

/// One potential: what was computed and what the leading term predicts.
struct Potential {
    name: &'static str,
    look: (RGBColor, Dash, Mark),
    third: fn(f64) -> f64,
    found: Vec<Existence<1>>,
}

impl Potential {
    fn of<L: ActingForce<1, Scalar = f64>>(
        name: &'static str,
        look: (RGBColor, Dash, Mark),
        third: fn(f64) -> f64,
        system: &L,
    ) -> Result<Self> {
        let exact = Exact::new(system);
        let found = step_sizes()
            .map(|h| exact.existence(SVector::from([Q0]), SVector::from([Q1]), h))
            .collect::<Result<_, _>>()
            .with_context(|| format!("no exact discrete objects for the {name} potential"))?;
        Ok(Self { name, look, third, found })
    }

    /// The leading term at step size h; τ²(1−τ)² V''' by Simpson's rule.
    fn leading(&self, h: f64) -> f64 {
        const CELLS: usize = 500;
        let integrand = |i: usize| {
            let tau = i as f64 / (2 * CELLS) as f64;
            (tau * (1.0 - tau)).powi(2) * (self.third)(Q0 + tau * (Q1 - Q0))
        };
        let sum: f64 =
            (0..CELLS).map(|i| integrand(2 * i) + 4.0 * integrand(2 * i + 1) + integrand(2 * i + 2)).sum();
        // + 0 makes −0 a plain 0.
        -(R / M) * (Q1 - Q0) * h * h * sum / (6 * CELLS) as f64 + 0.0
    }
}

/// From 1 down by factors √2. From h ≈ 1.35 on no motion of the quartic potential joins q0 to q1 without a
/// full swing.
fn step_sizes() -> impl Iterator<Item = f64> {
    (0..13).map(|k| 0.5_f64.powf(0.5 * f64::from(k)))
}

fn obstruction(existence: &Existence<1>) -> f64 {
    existence.mixed[(0, 0)]
}

fn main() -> Result<()> {
    let potentials = [
        Potential::of(
            "quartic",
            (colour::RUNGE_KUTTA, Dash::Solid, Mark::Disc),
            |q| 6.0 * q,
            &Quartic { m: M, r: R },
        )?,
        Potential::of(
            "pendulum",
            (colour::VARIATIONAL, Dash::Dashed, Mark::Circle),
            |q| -q.sin(),
            &Pendulum { m: M, r: R },
        )?,
        Potential::of(
            "harmonic",
            (colour::EULER, Dash::DashDotted, Mark::Triangle),
            |_| 0.0,
            &Harmonic { m: M, r: R },
        )?,
    ];
    report(&potentials);
    println!("\nPicture: {}", draw(&potentials)?.display());
    Ok(())
}

fn report(potentials: &[Potential]) {
    println!("Obstruction D1 f⁺ + D2 f⁻ of the exact discrete force, m = {M}, r = {R}, q0 = {Q0}, q1 = {Q1}");
    println!("(0 for a Rayleigh force; all dimensionless; tolerance: what counts as 0)\n");
    for potential in potentials {
        println!("{} potential", potential.name);
        println!("       h    obstruction   leading term   relative difference   tolerance   Rayleigh");
        for existence in potential.found.iter().step_by(2) {
            let (found, leading) = (obstruction(existence), potential.leading(existence.h));
            let apart = if leading == 0.0 {
                "                  —".to_owned()
            } else {
                format!("{:19.2e}", (found / leading - 1.0).abs())
            };
            let verdict = if found.abs() <= existence.tolerance { "yes" } else { "no" };
            println!(
                "{:8.5}  {found:13.6e}  {leading:13.6e}   {apart}   {:9.1e}   {verdict}",
                existence.h, existence.tolerance
            );
        }
        println!();
    }
    println!("The smallest step size of the pendulum in full:\n");
    if let Some(existence) = potentials[1].found.last() {
        println!("{existence}");
    }
}

fn draw(potentials: &[Potential]) -> Result<PathBuf> {
    let mut curves = Vec::new();
    for potential in potentials {
        let (colour, dash, mark) = potential.look;
        let points = potential.found.iter().map(|existence| (existence.h, obstruction(existence).abs()));
        curves.push(Curve::marks(potential.name, colour, mark, points.collect()));
        let leading: Vec<_> = step_sizes().map(|h| (h, potential.leading(h).abs())).collect();
        if leading.iter().all(|point| point.1 > 0.0) {
            curves.push(Curve::line("its leading term ∝ h²", colour, 2, leading).dashed(dash));
        }
    }
    // Of the three potentials these are much alike: the largest tells what is no longer 0 for any.
    let largest = |(k, h): (usize, f64)| {
        (h, potentials.iter().map(|potential| potential.found[k].tolerance).fold(0.0, f64::max))
    };
    let tolerance = step_sizes().enumerate().map(largest).collect();
    curves.push(Curve::line("below: counts as 0", colour::GREY, 3, tolerance).dashed(Dash::Dotted));
    let panel = Panel::new(
        "Only for the harmonic potential does the exact discrete force have a Rayleigh function",
        logarithmic("step size h (dimensionless)"),
        // Exact zeros stand at the floor.
        logarithmic("|D1 f⁺ + D2 f⁻| (dimensionless)").with_floor(1e-17),
        curves,
    );
    picture::write("conjecture", [1100, 850], 1, &[panel])
}
