//! A counterexample: the exact discrete force of a natural Lagrangian with a Rayleigh force need not be Rayleigh.
//!
//! For L = ½mv² − V(q) and R = ½rv² the obstruction D1 f_d^ex+ + D2 f_d^ex− is computed along the exact motion from q0 to
//! q1 in time h, for three potentials, and drawn against h with the leading term
//!
//! ```text
//! −(r/m)(q1−q0) h² ∫₀¹ τ²(1−τ)² V'''(q0 + τ(q1−q0)) dτ
//! ```
//!
//! It vanishes for the harmonic oscillator alone, the paper's example (section 3.4). All quantities are dimensionless.
//!
//! ```text
//! cargo run --release --example conjecture [picture.svg]
//! ```

use std::env;
use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use dalembert::exact::{Exact, Existence};
use dalembert::nalgebra::SVector;
use dalembert::{Rayleigh, rayleigh_system};
use dalembert_examples::results;
use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, SeriesLabelPosition};
use plotters::coord::combinators::IntoLogRange;
use plotters::drawing::IntoDrawingArea;
use plotters::element::{Circle, PathElement};
use plotters::series::LineSeries;
use plotters::style::{BLACK, Color, RGBColor, TRANSPARENT, WHITE};

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
    colour: RGBColor,
    third: fn(f64) -> f64,
    found: Vec<Existence<1>>,
}

impl Potential {
    fn of<L: Rayleigh<1, Scalar = f64>>(
        name: &'static str,
        colour: RGBColor,
        third: fn(f64) -> f64,
        system: &L,
    ) -> Result<Self> {
        let exact = Exact::rayleigh(system);
        let found = step_sizes()
            .map(|h| exact.existence(SVector::from([Q0]), SVector::from([Q1]), h))
            .collect::<Result<_, _>>()
            .with_context(|| format!("no exact discrete objects for the {name} potential"))?;
        Ok(Self { name, colour, third, found })
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

/// From 1 down by factors √2. From h ≈ 1.35 on no motion of the quartic potential joins q0 to q1 without a full swing.
fn step_sizes() -> impl Iterator<Item = f64> {
    (0..13).map(|k| 0.5_f64.powf(0.5 * f64::from(k)))
}

fn obstruction(existence: &Existence<1>) -> f64 {
    existence.mixed[(0, 0)]
}

fn main() -> Result<()> {
    let potentials = [
        Potential::of("quartic", RGBColor(213, 94, 0), |q| 6.0 * q, &Quartic { m: M, r: R })?,
        Potential::of("pendulum", RGBColor(0, 114, 178), |q| -q.sin(), &Pendulum { m: M, r: R })?,
        Potential::of("harmonic", RGBColor(0, 158, 115), |_| 0.0, &Harmonic { m: M, r: R })?,
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

/// Writes the picture to the path that the command line gives, or else to `target/conjecture.svg`.
fn draw(potentials: &[Potential]) -> Result<PathBuf> {
    let mut svg = String::new();
    draw_into(&mut svg, potentials)?;
    let path = match env::args_os().nth(1) {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("target").join("conjecture.svg"),
    };
    results::save(&path, &svg)?;
    Ok(path)
}

fn draw_into(svg: &mut String, potentials: &[Potential]) -> Result<()> {
    const FONT: &str = "sans-serif";
    const H: Range<f64> = 0.01..1.25;
    const OBSTRUCTION: Range<f64> = 1e-17..1.0;
    let root = SVGBackend::with_string(svg, (1100, 800)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption("Is the exact discrete force Rayleigh?", (FONT, 26))
        .margin(14)
        .margin_right(30)
        .x_label_area_size(56)
        .y_label_area_size(92)
        .build_cartesian_2d(H.log_scale(), OBSTRUCTION.log_scale())?;
    chart
        .configure_mesh()
        .x_desc("step size h (dimensionless)")
        .y_desc("|D1 f⁺ + D2 f⁻| (dimensionless)")
        .x_labels(6)
        .y_labels(10)
        .x_label_formatter(&|h| h.to_string())
        .y_label_formatter(&|y| power_of_ten(*y))
        .label_style((FONT, 19))
        .axis_desc_style((FONT, 21))
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(1))
        .axis_style(BLACK.stroke_width(1))
        .set_all_tick_mark_size(5)
        .draw()?;

    for potential in potentials {
        let colour = potential.colour;
        let points = potential.found.iter().map(|existence| (existence.h, obstruction(existence).abs()));
        // 0 has no logarithm: it is drawn on the lower edge.
        let visible = points.map(|(h, y)| (h, y.max(OBSTRUCTION.start)));
        chart
            .draw_series(visible.map(|at| Circle::new(at, 5, colour.filled())))?
            .label(if potential.leading(1.0) == 0.0 {
                format!("{} (0 on the lower edge)", potential.name)
            } else {
                potential.name.to_owned()
            })
            .legend(move |(x, y)| Circle::new((x + 12, y), 5, colour.filled()));
        let line: Vec<_> = step_sizes().map(|h| (h, potential.leading(h).abs())).collect();
        if line.iter().all(|point| point.1 > 0.0) {
            chart
                .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
                .label(format!("{}, leading term ∝ h²", potential.name))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], colour.stroke_width(2)));
        }
    }
    let tolerances = potentials.iter().map(|potential| {
        let points = potential.found.iter().map(|existence| (existence.h, existence.tolerance));
        LineSeries::new(points.collect::<Vec<_>>(), RGBColor(120, 120, 120).stroke_width(1))
    });
    for (index, series) in tolerances.enumerate() {
        let drawn = chart.draw_series(series)?;
        if index == 0 {
            drawn.label("what counts as 0").legend(|(x, y)| {
                PathElement::new([(x, y), (x + 24, y)], RGBColor(120, 120, 120).stroke_width(1))
            });
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::Coordinate(620, 250))
        .margin(8)
        .legend_area_size(32)
        .label_font((FONT, 19))
        .background_style(WHITE.mix(0.85))
        .draw()?;
    root.present()?;
    Ok(())
}

/// 10⁻⁶ for 1e-6.
fn power_of_ten(value: f64) -> String {
    let exponent = value.log10().round() as i32;
    let digits = exponent.abs().to_string();
    let raised = digits
        .chars()
        .filter_map(|digit| digit.to_digit(10))
        .map(|digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize]);
    let sign = if exponent < 0 { "⁻" } else { "" };
    format!("10{sign}{}", raised.collect::<String>())
}
