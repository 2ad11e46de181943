//! The Hamilton–Jacobi problem with friction: characteristics, sections, caustics.
//!
//! ```text
//! cargo run --release --example hamilton_jacobi
//! ```
//!
//! Above, the damped oscillator m q̈ + r q̇ + k q = 0 by the midpoint rule, whose complete solution S_k = ½ s_k q² + λ_k q is
//! known in closed form: all characteristics pass through one point. Below, a damped pendulum released at rest: the caustic
//! is a curve with a cusp, and the carried section folds over. Prints what holds of the paper's equations as printed and of
//! the corrected ones.

use std::path::{Path, PathBuf};
use std::{env, fs};

use anyhow::{Context, Result};
use dalembert::hamilton_jacobi::{Caustic, Characteristic, HamiltonJacobi};
use dalembert::{Midpoint, ScalarField, rayleigh_system};
use nalgebra::{SMatrix, SVector, vector};
use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, SeriesLabelPosition};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement};
use plotters::series::{LineSeries, PointSeries};
use plotters::style::{BLACK, Color, RGBColor, WHITE};

#[rayleigh_system]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// S_k = ½ s q² + λ q + c.
struct Quadratic {
    s: f64,
    lambda: f64,
    constant: f64,
}

impl ScalarField<1> for Quadratic {
    type Scalar = f64;

    fn value(&self, q: &SVector<f64, 1>) -> f64 {
        0.5 * self.s * q[0] * q[0] + self.lambda * q[0] + self.constant
    }

    fn gradient(&self, q: &SVector<f64, 1>) -> SVector<f64, 1> {
        vector![self.s * q[0] + self.lambda]
    }

    fn hessian(&self, _q: &SVector<f64, 1>) -> SMatrix<f64, 1, 1> {
        SMatrix::from_element(self.s)
    }
}

/// The oscillator's S_0, …, S_K with the parameters λ_0 = `lambda` and ϕ_0 = `phase`.
fn complete_solution(system: &Oscillator, h: f64, phase: f64, lambda: f64, steps: usize) -> Vec<Quadratic> {
    let Oscillator { m, k, r } = *system;
    let (alpha, beta, rho) = (m / h - k * h / 4.0, m / h + k * h / 4.0, r / 2.0);
    let omega = (k * m - rho * rho).sqrt();
    let shrinkage = ((beta - rho) / (beta + rho)).sqrt();
    let angle = |k: usize| phase + k as f64 * omega.atan2(alpha);
    let mut constant = 0.0;
    (0..=steps)
        .map(|k| {
            let s = |k: usize| -rho - omega * angle(k).tan();
            let lambda = |k: usize| lambda * shrinkage.powi(k as i32) * phase.cos() / angle(k).cos();
            let function = Quadratic { s: s(k), lambda: lambda(k), constant };
            let mu = lambda(k) / (beta + rho);
            constant += 0.5 * (alpha - s(k + 1)) * mu * mu - lambda(k + 1) * mu;
            function
        })
        .collect()
}

/// `count` numbers from `from` to `to`.
fn spread(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

fn main() -> Result<()> {
    let (h, steps) = (0.25, 20);
    let system = Oscillator { m: 1.0, k: 1.0, r: 0.5 };
    let theory = HamiltonJacobi::new(&system, Midpoint, h);
    let family = complete_solution(&system, h, -0.4, 0.7, steps);
    let carry = |q: f64| theory.carry(&family[0], &vector![q], steps);
    let fan = spread(-2.0, 2.0, 17).into_iter().map(carry).collect::<Result<Vec<_>, _>>()?;
    println!("Damped oscillator, m = k = 1, r = 1/2, h = 1/4, closed-form S_k, k = 0 … {steps}\n");
    let samples = spread(-2.0, 2.0, 9).into_iter().map(|q| vector![q]).collect::<Vec<_>>();
    println!("{}", theory.check_generating_functions(&family, &samples)?);
    println!("{}", theory.characteristics_report(&fan));
    let trajectory: Vec<_> = fan[12].states.iter().map(|state| state.q).collect();
    println!("The same S_k in the equations as the paper prints them, on the characteristic from q = 1:\n");
    println!("{}", theory.as_printed(&family, &trajectory)?);
    println!("{}", theory.along_trajectory(&trajectory)?);
    println!("{}", theory.hamilton_equations(&trajectory));

    let (rest, swings) = (Quadratic { s: 0.0, lambda: 0.0, constant: 0.0 }, 40);
    let swinging = Pendulum { r: 0.1 };
    let swing = HamiltonJacobi::new(&swinging, Midpoint, 0.1);
    let swing_carry = |q: f64| swing.carry(&rest, &vector![q], swings);
    let swing_fan = spread(-2.9, 2.9, 41).into_iter().map(swing_carry).collect::<Result<Vec<_>, _>>()?;
    println!("Damped pendulum, r = 1/10, h = 1/10, released at rest\n");
    println!("{}", swing.characteristics_report(&swing_fan));
    let dense = spread(-2.9, 2.9, 401).into_iter().map(swing_carry).collect::<Result<Vec<_>, _>>()?;

    // Lines of the sections in closed form, over the range that the fan covers at that k.
    let lines = [0, 4, 8, 9, 14].map(|k| {
        let on_line = |q: f64| (q, family[k].s * q + family[k].lambda);
        let ends = [&fan[0], &fan[fan.len() - 1]].map(|characteristic| characteristic.states[k].q[0]);
        (k, spread(ends[0], ends[1], 2).into_iter().map(on_line).collect())
    });
    let folds = [0, 10, 16, 20, 30].map(|k| (k, section_points(&dense, k)));
    let path = picture(&[
        fan_panel("Damped oscillator: characteristics c_k(x)", h, &fan, &caustics(&fan)),
        section_panel("Its sections γ_k: carried points, closed-form lines", lines, Some(&fan)),
        fan_panel("Damped pendulum from rest: characteristics", 0.1, &swing_fan, &caustics(&dense)),
        section_panel("Its sections γ_k fold over beyond the caustic", folds, None),
    ])?;
    println!("picture: {}", path.display());
    Ok(())
}

fn caustics(fan: &[Characteristic<f64, 1>]) -> Vec<Caustic<1>> {
    fan.iter().flat_map(Characteristic::caustics).collect()
}

/// (q_k, p_k) on every characteristic.
fn section_points(fan: &[Characteristic<f64, 1>], k: usize) -> Vec<(f64, f64)> {
    fan.iter().map(|characteristic| (characteristic.states[k].q[0], characteristic.states[k].p[0])).collect()
}

/// Points of one colour, as a line or as dots.
struct Curve {
    label: Option<String>,
    colour: RGBColor,
    dots: bool,
    points: Vec<(f64, f64)>,
}

struct Panel {
    title: &'static str,
    x: &'static str,
    y: &'static str,
    /// Where the legend covers nothing.
    legend: SeriesLabelPosition,
    curves: Vec<Curve>,
}

/// Colours that readers with any colour vision tell apart (Okabe and Ito, 2008).
const COLOURS: [RGBColor; 5] = [
    RGBColor(0, 0, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
];
const CAUSTIC: RGBColor = RGBColor(213, 94, 0);

fn fan_panel(title: &'static str, h: f64, fan: &[Characteristic<f64, 1>], caustics: &[Caustic<1>]) -> Panel {
    let mut curves: Vec<_> = fan
        .iter()
        .enumerate()
        .map(|(index, characteristic)| Curve {
            label: (index == 0).then(|| "characteristics".to_owned()),
            colour: COLOURS[1],
            dots: false,
            points: (0..characteristic.states.len())
                .map(|k| (k as f64 * h, characteristic.states[k].q[0]))
                .collect(),
        })
        .collect();
    curves.push(Curve {
        label: Some("caustic, det Q = 0".to_owned()),
        colour: CAUSTIC,
        dots: true,
        points: caustics.iter().map(|c| ((c.step as f64 + c.fraction) * h, c.q[0])).collect(),
    });
    Panel { title, x: "time kh", y: "configuration q", legend: SeriesLabelPosition::UpperRight, curves }
}

fn section_panel(
    title: &'static str,
    lines: [(usize, Vec<(f64, f64)>); 5],
    carried: Option<&[Characteristic<f64, 1>]>,
) -> Panel {
    let mut curves = Vec::new();
    for ((k, points), colour) in lines.into_iter().zip(COLOURS) {
        curves.push(Curve { label: Some(format!("k = {k}")), colour, dots: false, points });
        if let Some(fan) = carried {
            curves.push(Curve { label: None, colour, dots: true, points: section_points(fan, k) });
        }
    }
    let legend =
        if carried.is_some() { SeriesLabelPosition::LowerLeft } else { SeriesLabelPosition::UpperRight };
    Panel { title, x: "configuration q", y: "momentum p", legend, curves }
}

/// Units of the drawing to a pixel: plotters rounds coordinates to whole units, which shows as steps in thin lines.
const PIXEL: i32 = 8;
const SIZE: [i32; 2] = [1300, 1000];
const FONT: &str = "sans-serif";

/// Writes the panels to the path that the command line gives, or else to `target/hamilton_jacobi.svg`.
fn picture(panels: &[Panel]) -> Result<PathBuf> {
    let mut svg = String::new();
    let units = SIZE.map(|pixels| (pixels * PIXEL) as u32);
    {
        let root = SVGBackend::with_string(&mut svg, units.into()).into_drawing_area();
        root.fill(&WHITE)?;
        for (area, panel) in root.split_evenly((2, 2)).iter().zip(panels) {
            draw(area, panel)?;
        }
        root.present()?;
    }
    let header = |width: i32, height: i32| format!("<svg width=\"{width}\" height=\"{height}\"");
    let svg = svg.replacen(&header(SIZE[0] * PIXEL, SIZE[1] * PIXEL), &header(SIZE[0], SIZE[1]), 1);
    let path = match env::args_os().nth(1) {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("target").join("hamilton_jacobi.svg"),
    };
    fs::create_dir_all(path.parent().unwrap_or(Path::new("")))
        .and_then(|()| fs::write(&path, svg))
        .with_context(|| format!("cannot write {}; give another path as argument", path.display()))?;
    Ok(path)
}

fn draw(area: &DrawingArea<SVGBackend<'_>, Shift>, panel: &Panel) -> Result<()> {
    let extent = |of: fn(&(f64, f64)) -> f64| {
        let all = || panel.curves.iter().flat_map(|curve| &curve.points).map(of);
        let (least, most) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        let margin = 0.04 * (most - least);
        least - margin..most + margin
    };
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, (FONT, 22 * PIXEL))
        .margin(14 * PIXEL)
        .x_label_area_size(48 * PIXEL)
        .y_label_area_size(70 * PIXEL)
        .build_cartesian_2d(extent(|point| point.0), extent(|point| point.1))?;
    chart
        .configure_mesh()
        .x_desc(panel.x)
        .y_desc(panel.y)
        .x_labels(8)
        .y_labels(8)
        .x_label_formatter(&|x| format!("{x:.1}"))
        .y_label_formatter(&|y| format!("{y:.1}"))
        .label_style((FONT, 17 * PIXEL))
        .axis_desc_style((FONT, 19 * PIXEL))
        .bold_line_style(BLACK.mix(0.12).stroke_width(PIXEL as u32))
        .light_line_style(BLACK.mix(0.0))
        .draw()?;
    for curve in &panel.curves {
        let (colour, points) = (curve.colour, curve.points.iter().copied());
        let drawn = if curve.dots {
            let dots: PointSeries<_, _, Circle<_, _>, _> =
                PointSeries::new(points, 3 * PIXEL, colour.filled());
            chart.draw_series(dots)?
        } else {
            chart.draw_series(LineSeries::new(points, colour.stroke_width(3 * PIXEL as u32 / 2)))?
        };
        if let Some(label) = &curve.label {
            let width = if curve.dots { 6 } else { 2 } * PIXEL as u32;
            drawn.label(label.as_str()).legend(move |(x, y)| {
                PathElement::new([(x, y), (x + 22 * PIXEL, y)], colour.stroke_width(width))
            });
        }
    }
    chart
        .configure_series_labels()
        .position(panel.legend.clone())
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3).stroke_width(PIXEL as u32))
        .label_font((FONT, 17 * PIXEL))
        .legend_area_size(30 * PIXEL)
        .margin(8 * PIXEL)
        .draw()?;
    Ok(())
}
