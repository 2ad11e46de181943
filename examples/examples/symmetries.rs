//! Which momentum maps a friction keeps: isotropic and radial friction on the ring potential of Marsden &
//! West (example 3.2.3), and drag along one axis on a particle in space.
//!
//! The picture shows how much angular momentum each system has lost. Radial friction keeps it exactly in
//! polar coordinates and as a midpoint force; its Rayleigh function in Cartesian coordinates loses some at
//! order h³ a step, through ∂R/∂q.
//!
//! ```text
//! cargo run --release --example symmetries [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::Result;
use dalembert::noether::Generator;
use dalembert::samples::{Pair, segments, tangent_points};
use dalembert::{Discrete, Discretise, Midpoint, State, rayleigh, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Dash, Panel, RGBColor, colour, linear, logarithmic};

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
            (colour::RUNGE_KUTTA, Dash::Solid),
            &Ring { isotropic: k, ..Ring::default() },
            &rotation,
            &plane,
            start,
        )?,
        curve(
            "radial, as R(q, v) in Cartesian coordinates",
            (colour::VARIATIONAL, Dash::Dashed),
            &Ring { radial: k, ..Ring::default() },
            &rotation,
            &plane,
            start,
        )?,
        curve(
            "radial, as a force at midpoints",
            (colour::EULER, Dash::DashDotted),
            &Ring { radial_force: k, ..Ring::default() },
            &rotation,
            &plane,
            start,
        )?,
        curve(
            "radial, as R in polar coordinates: exactly 0",
            (colour::REFERENCE, Dash::Dotted),
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
    let noether = particle.by(Midpoint, H).noether();
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

/// Prints the verdict on one system and the balance along its trajectory, and samples what it has lost.
fn curve<L: Discrete<Midpoint, 2, Scalar = f64>>(
    label: &'static str,
    (colour, dash): (RGBColor, Dash),
    system: &L,
    generator: &Generator<f64, 2>,
    segments: &[Pair<f64, 2>],
    (q, v): ([f64; 2], [f64; 2]),
) -> Result<Curve<'static>> {
    let noether = system.by(Midpoint, H).noether();
    let start = State::from_velocity(system, q, v)?;
    println!("\n== {label}\n{}", noether.symmetry(generator, segments)?);
    let mut trajectory = system.by(Midpoint, H).run(start);
    let mut points = Vec::new();
    let stretch = 5;
    let mut account = noether.balance(generator, &start, trajectory.by_ref().take(stretch))?;
    for _ in 1..STEPS / stretch {
        points.push((account.steps as f64 * H, (account.end - account.start).abs()));
        let at = *trajectory.state();
        account = account + noether.balance(generator, &at, trajectory.by_ref().take(stretch))?;
    }
    println!("{account}");
    Ok(Curve::line(label, colour, 3, points).dashed(dash))
}

fn draw(curves: &[Curve<'static>]) -> Result<PathBuf> {
    let panel = Panel::new(
        "By midpoint, angular momentum is kept only where the discrete friction is radial",
        linear("time t (dimensionless)"),
        // Exact zeros stand at the floor.
        logarithmic("|J(t) − J(0)| (dimensionless)").with_floor(1e-18),
        curves.to_vec(),
    );
    picture::write("symmetries", [1100, 800], 1, &[panel])
}
