//! Which momentum maps a friction keeps: isotropic and radial friction on the ring potential of Marsden & West (example
//! 3.2.3), and drag along one axis on a particle in space.
//!
//! The picture shows how much angular momentum each system has lost. Radial friction keeps it exactly in polar coordinates
//! and as a midpoint force; its Rayleigh function in Cartesian coordinates loses some at order h³ a step, through ∂R/∂q.
//!
//! ```text
//! cargo run --release --example symmetries [picture.svg]
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};

use dalembert::noether::{Generator, Noether};
use dalembert::samples::{Segment, segments, tangent_points};
use dalembert::{Discrete, Midpoint, State, Trajectory, rayleigh, rayleigh_system};
use dalembert_examples::results;
use plotters::prelude::*;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The ring potential with three frictions: isotropic, radial from a Rayleigh function, radial as a force.
#[derive(Clone, Copy, Default)]
struct Ring {
    isotropic: f64,
    radial: f64,
    radial_force: f64,
}

#[rayleigh_system]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        let radial_speed_squared = (q[0] * v[0] + q[1] * v[1]).powi(2) / s;
        0.5 * self.isotropic * (v[0] * v[0] + v[1] * v[1]) + 0.5 * self.radial * radial_speed_squared
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let s = q[0] * q[0] + q[1] * q[1];
        let factor = -self.radial_force * (q[0] * v[0] + q[1] * v[1]) / s;
        [factor * q[0], factor * q[1]]
    }
}

/// The same with radial friction in polar coordinates (r, θ): R_d depends on r1 − r0 alone.
#[derive(Clone, Copy)]
struct PolarRing {
    radial: f64,
}

#[rayleigh_system]
impl PolarRing {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0];
        0.5 * (v[0] * v[0] + s * v[1] * v[1]) - s * (s - 1.0).powi(2)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.radial * v[0] * v[0]
    }
}

/// A particle in a central potential with drag along the axis (1, 2, 2)/3.
#[derive(Clone, Copy)]
struct Particle {
    k: f64,
}

#[rayleigh_system]
impl Particle {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - s * s
    }
    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        let along = (v[0] + 2.0 * v[1] + 2.0 * v[2]) / 3.0;
        0.5 * self.k * along * along
    }
}

const H: f64 = 0.1;
const STEPS: usize = 1000;
const RADIUS: f64 = 1.15549918674982;

fn main() -> Result<()> {
    let k = 0.1;
    let rotation = Generator::rotation(0, 1);
    let angle = Generator::translation("∂θ", [0.0, 1.0]);
    let plane = segments([0.5, 0.5], [1.2, 1.2], [0.1; 2], 200);
    let start = ([0.0, RADIUS], [0.5, 0.0]);
    let curves = [
        curve(
            "isotropic drag",
            RGBColor(213, 94, 0),
            &Ring { isotropic: k, ..Ring::default() },
            &rotation,
            &plane,
            start,
        )?,
        curve(
            "radial, R(q, v) in Cartesian coordinates",
            RGBColor(0, 114, 178),
            &Ring { radial: k, ..Ring::default() },
            &rotation,
            &plane,
            start,
        )?,
        curve(
            "radial, midpoint force",
            RGBColor(0, 158, 115),
            &Ring { radial_force: k, ..Ring::default() },
            &rotation,
            &plane,
            start,
        )?,
        curve(
            "radial, R in polar coordinates",
            BLACK,
            &PolarRing { radial: k },
            &angle,
            &segments([0.7, -3.0], [1.3, 3.0], [0.1, 0.1], 200),
            ([RADIUS, 0.0], [0.0, -0.5 / RADIUS]),
        )?,
    ];

    println!("\n== so(3) and drag along (1, 2, 2)/3");
    let rotations = [
        Generator::rotation(1, 2).named("Lx"),
        Generator::rotation(2, 0).named("Ly"),
        Generator::rotation(0, 1).named("Lz"),
    ];
    let particle = Particle { k };
    let noether = Noether::new(&particle, Midpoint, H);
    println!("{}", noether.subalgebra(&rotations, &segments([-1.0; 3], [1.0; 3], [0.1; 3], 60))?);

    println!("\n== Rayleigh structure of the ring");
    let radial_force = Ring { radial_force: k, ..Ring::default() };
    println!("radial friction as a force: {}", rayleigh::structure(&radial_force, Midpoint, H, &plane)?);
    let radial = Ring { radial: k, ..Ring::default() };
    println!("as a Rayleigh function: {}", rayleigh::structure(&radial, Midpoint, H, &plane)?);
    println!("{}", rayleigh::dissipation(&radial, &tangent_points([0.5; 2], [1.2; 2], [1.0; 2], 200))?);

    println!("\npicture: {}", draw(&curves)?.display());
    Ok(())
}

/// |J_k − J_0| over time.
struct Curve {
    label: &'static str,
    colour: RGBColor,
    points: Vec<(f64, f64)>,
}

/// Prints the verdict on one system and the balance along its trajectory, and samples what it has lost.
fn curve<L: Discrete<Midpoint, 2, Scalar = f64>>(
    label: &'static str,
    colour: RGBColor,
    system: &L,
    generator: &Generator<f64, 2>,
    segments: &[Segment<f64, 2>],
    (q, v): ([f64; 2], [f64; 2]),
) -> Result<Curve> {
    let noether = Noether::new(system, Midpoint, H);
    let start = State::from_velocity(system, q, v)?;
    println!("\n== {label}\n{}", noether.symmetry(generator, segments)?);
    let mut trajectory = Trajectory::new(system, Midpoint, H, start);
    let mut points = Vec::new();
    let stretch = 5;
    let mut account = noether.balance(generator, &start, trajectory.by_ref().take(stretch))?;
    for _ in 1..STEPS / stretch {
        points.push((account.steps as f64 * H, (account.end - account.start).abs()));
        let at = *trajectory.state();
        account = account + noether.balance(generator, &at, trajectory.by_ref().take(stretch))?;
    }
    println!("{account}");
    Ok(Curve { label, colour, points })
}

/// Writes the picture to the path that the command line gives, or to `target/symmetries.svg`.
fn draw(curves: &[Curve]) -> Result<PathBuf> {
    let path = match std::env::args_os().nth(1) {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("target").join("symmetries.svg"),
    };
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, (1000, 640)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption("Angular momentum lost under friction, k = 0.1, midpoint rule, h = 0.1", ("sans-serif", 24))
        .margin(16)
        .margin_right(30)
        .x_label_area_size(50)
        .y_label_area_size(90)
        .build_cartesian_2d(0.0..STEPS as f64 * H, (1e-18..1e1).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("time t (dimensionless)")
        .x_label_formatter(&|t| format!("{t:.0}"))
        .y_desc("|J(t) − J(0)| (dimensionless)")
        .y_label_formatter(&|y: &f64| format!("1e{:.0}", y.log10()))
        .label_style(("sans-serif", 17))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for Curve { label, colour, points } in curves {
        let style = colour.stroke_width(2);
        // A logarithm has no place for an exact 0: it is drawn on the lower edge.
        chart
            .draw_series(LineSeries::new(points.iter().map(|(t, lost)| (*t, lost.max(1e-18))), style))?
            .label(*label)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleRight)
        .legend_area_size(34)
        .label_font(("sans-serif", 17))
        .background_style(WHITE)
        .border_style(BLACK)
        .draw()?;
    root.present()?;
    drop(chart);
    drop(root);
    results::save(&path, &svg)?;
    Ok(path)
}
