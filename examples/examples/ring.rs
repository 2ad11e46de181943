//! A particle in a ring potential with weak drag, over 10 000 steps: energy and angular momentum by the variational
//! midpoint rule, by the classical Runge–Kutta method at the same step size, and by an accurate reference.
//!
//! Marsden and West, Discrete mechanics and variational integrators (2001), example 3.2.3. All quantities are
//! dimensionless.
//!
//! ```text
//! cargo run --release --example ring [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::Result;
use dalembert::{Discrete, Midpoint, Rayleigh, State, Step, Trajectory, rayleigh_system};
use dalembert_examples::baseline::{self, Method};
use dalembert_examples::picture::{self, Corner, Curve, Mark, Panel, colour};
use indicatif::ProgressBar;

/// A particle of unit mass in the potential s(s − 1)², s = |q|², with isotropic drag.
pub struct Ring {
    /// Coefficient of the drag.
    pub k: f64,
}

#[rayleigh_system]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

/// The step size.
pub const H: f64 = 0.2;
/// The number of steps: T = 2000.
pub const STEPS: usize = 10_000;

fn main() -> Result<()> {
    let ring = Ring { k: 1e-3 };
    let start = start(&ring)?;

    let bar = ProgressBar::new(4 * STEPS as u64);
    let (midpoint, solver) = variational_midpoint(&ring, start, &bar)?;
    let runge_kutta = standard_method(&ring, Method::RungeKutta4, start, &bar)?;
    let reference = standard_method(&ring, Method::DormandPrince853(1e-13), start, &bar)?;
    let looser = standard_method(&ring, Method::DormandPrince853(1e-11), start, &bar)?;
    bar.finish_and_clear();

    print_energy(&ring, &midpoint, &runge_kutta, &reference)?;
    print_balance(&ring, [("midpoint", &midpoint), ("RK4", &runge_kutta), ("reference", &reference)])?;
    print_angular_momentum(&ring, &midpoint, &runge_kutta, &reference);
    print_quality(&ring, &solver, &reference, &looser)?;
    println!("\nPicture: {}", draw(&ring, &midpoint, &runge_kutta, &reference)?.display());
    Ok(())
}

/// q = (0, 1.155…) and v = (½, 0): E = 11/40, above the hump at s = ⅓.
pub fn start(ring: &Ring) -> Result<State<f64, 2>> {
    Ok(State::from_velocity(ring, [0.0, 1.15549918674982], [0.5, 0.0])?)
}

/// The states at t = 0, h, 2h, …
pub type Motion = Vec<State<f64, 2>>;

/// How the solver of the implicit step fared.
#[derive(Default)]
pub struct Solver {
    /// Newton iterations, all steps together.
    pub iterations: u32,
    /// Steps whose Newton step had to be shortened.
    pub damped: u32,
    /// The largest residual, in units of its round-off floor.
    pub worst_residual: f64,
}

/// The motion by the variational midpoint rule.
pub fn variational_midpoint(
    ring: &Ring,
    start: State<f64, 2>,
    bar: &ProgressBar,
) -> Result<(Motion, Solver)> {
    let (mut motion, mut solver) = (vec![start], Solver::default());
    for step in Trajectory::new(ring, Midpoint, H, start).take(STEPS) {
        let Step { state, report, .. } = step?;
        motion.push(state);
        solver.iterations += report.iterations;
        solver.damped += u32::from(report.damped > 0);
        solver.worst_residual = solver.worst_residual.max(report.residual / report.floor);
        bar.inc(1);
    }
    Ok((motion, solver))
}

/// The motion by a method that knows nothing of L and R but the equations of motion.
pub fn standard_method(
    ring: &Ring,
    method: Method,
    start: State<f64, 2>,
    bar: &ProgressBar,
) -> Result<Motion> {
    let states = baseline::states(ring, method, H, start)?.take(STEPS);
    std::iter::once(Ok(start)).chain(bar.wrap_iter(states)).collect()
}

/// What drag took, ∫ v·∂R/∂v dt by the trapezoidal rule over the states.
pub fn drag_work(ring: &Ring, motion: &[State<f64, 2>]) -> Result<f64> {
    let power = |state: &State<f64, 2>| -> Result<f64> {
        let v = state.velocity(ring)?;
        Ok(v.dot(&ring.rayleigh_gradient(&state.q, &v).d2))
    };
    motion.windows(2).map(|ends| Ok(0.5 * H * (power(&ends[0])? + power(&ends[1])?))).sum()
}

/// J = q × p.
pub fn angular_momentum(state: &State<f64, 2>) -> f64 {
    state.q.perp(&state.p)
}

fn time(step: usize) -> f64 {
    step as f64 * H
}

/// The steps that the tables show.
fn rows() -> impl Iterator<Item = usize> {
    (0..=STEPS).step_by(STEPS / 10)
}

fn print_energy(
    ring: &Ring,
    midpoint: &[State<f64, 2>],
    runge_kutta: &[State<f64, 2>],
    reference: &[State<f64, 2>],
) -> Result<()> {
    println!("Energy, h = {H}; errors are against the reference, segments end at t. All is dimensionless.");
    println!("     t  reference   midpoint     error    segment       RK4     error");
    for k in rows() {
        let exact = reference[k].energy(ring)?;
        let [variational, standard] = [midpoint[k].energy(ring)?, runge_kutta[k].energy(ring)?];
        let segment = match k {
            0 => "–".to_string(),
            _ => format!("{:.6}", ring.segment_energy(&midpoint[k - 1].q, &midpoint[k].q, H)),
        };
        println!(
            "{:6} {exact:10.6} {variational:10.6} {:9.1e} {segment:>10} {standard:9.6} {:9.1e}",
            time(k),
            variational - exact,
            standard - exact,
        );
    }
    Ok(())
}

fn print_balance(ring: &Ring, motions: [(&str, &Motion); 3]) -> Result<()> {
    println!("\nWhere the energy went    lost      to drag   to the method");
    for (name, motion) in motions {
        let lost = motion[0].energy(ring)? - motion[STEPS].energy(ring)?;
        let work = drag_work(ring, motion)?;
        println!("{name:20} {lost:11.7} {work:11.7} {:11.1e}", lost - work);
    }
    Ok(())
}

fn print_angular_momentum(
    ring: &Ring,
    midpoint: &[State<f64, 2>],
    runge_kutta: &[State<f64, 2>],
    reference: &[State<f64, 2>],
) {
    println!("\nAngular momentum; errors are against the exact J(t) = J(0) exp(−k t).");
    println!("     t      exact   midpoint     error       RK4     error  reference's error");
    for k in rows() {
        let exact = angular_momentum(&reference[0]) * (-ring.k * time(k)).exp();
        let [variational, standard, accurate] =
            [midpoint, runge_kutta, reference].map(|motion| angular_momentum(&motion[k]));
        println!(
            "{:6} {exact:10.6} {variational:10.6} {:9.1e} {standard:9.6} {:9.1e} {:18.1e}",
            time(k),
            variational - exact,
            standard - exact,
            accurate - exact,
        );
    }
}

fn print_quality(ring: &Ring, solver: &Solver, reference: &Motion, looser: &Motion) -> Result<()> {
    let mut uncertainty = 0.0_f64;
    for (tight, loose) in reference.iter().zip(looser) {
        uncertainty = uncertainty.max((tight.energy(ring)? - loose.energy(ring)?).abs());
    }
    println!(
        "\nMidpoint: {:.2} Newton iterations a step, {} of {STEPS} steps damped, worst residual {:.1} × round-off.",
        f64::from(solver.iterations) / STEPS as f64,
        solver.damped,
        solver.worst_residual,
    );
    println!("Reference: DOP853 to 1e-13; to 1e-11 its energy differs by at most {uncertainty:.0e}.");
    Ok(())
}

fn draw(
    ring: &Ring,
    midpoint: &[State<f64, 2>],
    runge_kutta: &[State<f64, 2>],
    reference: &[State<f64, 2>],
) -> Result<PathBuf> {
    let panel =
        |title, y, legend, quantity: &dyn Fn(usize, &State<f64, 2>) -> Result<f64>| -> Result<Panel> {
            let curve = |label, colour, width, motion: &[State<f64, 2>]| -> Result<Curve> {
                let points = motion.iter().enumerate().map(|(k, state)| Ok((time(k), quantity(k, state)?)));
                Ok(Curve { label, colour, mark: Mark::Line(width), points: points.collect::<Result<_>>()? })
            };
            let curves = vec![
                curve("reference", colour::REFERENCE, 3, reference)?,
                curve("Runge–Kutta 4", colour::RUNGE_KUTTA, 2, runge_kutta)?,
                curve("variational midpoint", colour::VARIATIONAL, 1, midpoint)?,
            ];
            Ok(Panel { title, x: "time t (dimensionless)", y, legend, curves })
        };
    let energy = |_, state: &State<f64, 2>| Ok(state.energy(ring)?);
    let energy_error = |k: usize, state: &State<f64, 2>| Ok(state.energy(ring)? - reference[k].energy(ring)?);
    let momentum = |_, state: &State<f64, 2>| Ok(angular_momentum(state));
    let momentum_error =
        |k: usize, state: &State<f64, 2>| Ok(angular_momentum(state) - angular_momentum(&reference[k]));
    let panels = [
        panel("Energy, h = 0.2", "E (dimensionless)", Corner::UpperRight, &energy)?,
        panel("Angular momentum, h = 0.2", "J (dimensionless)", Corner::LowerRight, &momentum)?,
        panel("Error of the energy", "E − reference", Corner::LowerRight, &energy_error)?,
        panel("Error of the angular momentum", "J − reference", Corner::UpperRight, &momentum_error)?,
    ];
    picture::write("ring", [1600, 1100], 2, &panels)
}
