//! A particle in a ring potential with weak drag, over 10 000 steps: its orbit, its energy and its angular
//! momentum by the variational midpoint rule, by the classical Runge–Kutta method at the same step size and
//! at the same cost, steps of h/7, and by an accurate reference. The energy's errors by the midpoint rule
//! stay what they are after the first rounds; where a short run is all that is asked for, Runge–Kutta is the
//! better one. And the modified energy Ẽ of the midpoint rule, which falls as the modified friction takes it,
//! beside E.
//!
//! Marsden and West, Discrete mechanics and variational integrators (2001), example 3.2.3. All quantities are
//! dimensionless.
//!
//! ```text
//! cargo run --release --example ring [picture.svg]    # errors go to picture-errors.svg
//! ```

use std::iter::once;
use std::path::PathBuf;

use anyhow::{Context, Result};
use dalembert::step::Step;
use dalembert::{Discretise, Lagrangian, Midpoint, Rayleigh, State, rayleigh_system};
use dalembert_examples::baseline::{self, Method};
use dalembert_examples::picture::{self, Axis, Curve, Dash, Panel, colour, linear, logarithmic};
use dalembert_examples::results;
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

/// Steps of Runge–Kutta, its forces written out and compiled as L's and R's derivatives are, that take as
/// long as one step of the midpoint rule.
pub const AS_LONG: usize = 7;

/// The steps that the pictures of the orbit and of lost energies show.
const SHOWN: usize = 200;

fn main() -> Result<()> {
    let ring = Ring { k: 1e-3 };
    let start = start(&ring)?;

    // Drawn on a terminal only.
    let bar = ProgressBar::new(5 * STEPS as u64);
    let (midpoint, solver) = variational_midpoint(&ring, start, &bar)?;
    let motions = Motions {
        orbit: orbit(&ring, start)?,
        midpoint,
        runge_kutta: standard_method(&ring, Method::RungeKutta4, 1, start, &bar)?,
        finer: standard_method(&ring, Method::RungeKutta4, AS_LONG, start, &bar)?,
        reference: standard_method(&ring, Method::DormandPrince853(1e-13), 1, start, &bar)?,
    };
    let looser = standard_method(&ring, Method::DormandPrince853(1e-11), 1, start, &bar)?;
    bar.finish_and_clear();

    let Motions { midpoint, runge_kutta, finer, reference, .. } = &motions;
    print_energy([midpoint, runge_kutta, finer, reference]);
    print_balance(midpoint, runge_kutta, reference);
    let [plain, modified] = energies(&ring, start, H, STEPS)?;
    print_modified(&ring, start, &plain, &modified)?;
    print_angular_momentum(&ring, midpoint, runge_kutta, reference);
    print_quality(&solver, reference, &looser);
    let [picture, errors] = draw(&motions, &plain, &modified)?;
    println!("\nPictures: {}, {}", picture.display(), errors.display());
    Ok(())
}

/// The motion by each method, and the orbit.
struct Motions {
    orbit: [Vec<(f64, f64)>; 2],
    midpoint: Motion,
    runge_kutta: Motion,
    /// By steps of Runge–Kutta that take as long.
    finer: Motion,
    reference: Motion,
}

/// q = (0, 1.155…) and v = (½, 0): E = 11/40.
pub fn start(ring: &Ring) -> Result<State<f64, 2>> {
    Ok(State::from_velocity(ring, [0.0, 1.15549918674982], [0.5, 0.0])?)
}

/// A motion at t = 0, h, 2h, …: one entry for each time.
#[derive(Default)]
pub struct Motion {
    /// E = v·∂L/∂v − L at the node (q, p).
    pub energy: Vec<f64>,
    /// E on the segment that ends at the node, taken at its midpoint and mean velocity; at t = 0 that of the
    /// node.
    pub segment_energy: Vec<f64>,
    /// J = q × p.
    pub angular_momentum: Vec<f64>,
    /// What drag takes in unit time, v·∂R/∂v.
    pub drag_power: Vec<f64>,
}

impl Motion {
    fn of(ring: &Ring, states: &[State<f64, 2>]) -> Result<Self> {
        let mut motion = Self::default();
        let mut previous = None;
        for state in states {
            let v = state.velocity(ring)?;
            let energy = ring.energy(&state.q, &v);
            let segment_energy =
                previous.map_or(energy, |q0| ring.by(Midpoint, H).segment_energy(q0, &state.q));
            motion.energy.push(energy);
            motion.segment_energy.push(segment_energy);
            motion.angular_momentum.push(state.q.perp(&state.p));
            motion.drag_power.push(v.dot(&ring.rayleigh_gradient(&state.q, &v).d2));
            previous = Some(&state.q);
        }
        Ok(motion)
    }

    /// What was lost from the first state to the last.
    pub fn energy_lost(&self) -> f64 {
        self.energy[0] - self.energy[STEPS]
    }

    /// What drag took of it, ∫ v·∂R/∂v dt by the trapezoidal rule.
    pub fn drag_work(&self) -> f64 {
        self.drag_power.windows(2).map(|ends| 0.5 * H * (ends[0] + ends[1])).sum()
    }
}

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
    let (mut states, mut solver) = (vec![start], Solver::default());
    for step in ring.by(Midpoint, H).run(start).take(STEPS) {
        let Step { state, report, .. } = step?;
        states.push(state);
        solver.iterations += report.iterations;
        solver.damped += u32::from(report.damped > 0);
        solver.worst_residual = solver.worst_residual.max(report.residual / report.floor);
        bar.inc(1);
    }
    Ok((Motion::of(ring, &states)?, solver))
}

/// An energy along the run of the midpoint rule, and the friction that takes it.
#[derive(Default)]
pub struct Balance {
    /// E or Ẽ at the nodes.
    pub energy: Vec<f64>,
    /// What friction takes in unit time, 2R or 2R̃.
    pub loss: Vec<f64>,
}

impl Balance {
    /// ∫ loss dt up to each node, of the cubics through four nodes: its error is of fourth order.
    pub fn taken(&self, h: f64) -> Vec<f64> {
        let (loss, last) = (&self.loss, self.loss.len() - 1);
        let mut taken = vec![0.0];
        for k in 0..last {
            let weights = |from: usize, w: [f64; 4]| -> f64 {
                loss[from..].iter().zip(w).map(|(loss, weight)| loss * weight).sum()
            };
            let sum = match k {
                0 => weights(0, [9.0, 19.0, -5.0, 1.0]),
                k if k + 1 == last => weights(last - 3, [1.0, -5.0, 19.0, 9.0]),
                k => weights(k - 1, [-1.0, 13.0, 13.0, -1.0]),
            };
            taken.push(taken[k] + h / 24.0 * sum);
        }
        taken
    }

    /// energy + ∫ loss dt − energy(0) at each node: what friction leaves unexplained.
    pub fn remainder(&self, h: f64) -> Vec<f64> {
        let explained = self.taken(h);
        self.energy.iter().zip(explained).map(|(energy, taken)| energy + taken - self.energy[0]).collect()
    }

    /// The largest of them.
    pub fn worst(&self, h: f64) -> f64 {
        self.remainder(h).iter().fold(0.0, |worst: f64, left| worst.max(left.abs()))
    }
}

/// E with R, and Ẽ with R̃, along the run of the midpoint rule with step size `h`.
pub fn energies(ring: &Ring, start: State<f64, 2>, h: f64, steps: usize) -> Result<[Balance; 2]> {
    let by = ring.by(Midpoint, h);
    let modified_system = by.modified_system()?;
    let [mut plain, mut modified] = [Balance::default(), Balance::default()];
    let run = by.run(start).take(steps).map(|step| step.map(|step| step.state));
    for state in once(Ok(start)).chain(run) {
        let state = state?;
        let v = state.velocity(ring)?;
        plain.energy.push(ring.energy(&state.q, &v));
        plain.loss.push(2.0 * ring.rayleigh(v.into()));
        let v = modified_system.velocity(&state)?;
        modified.energy.push(modified_system.energy(&state.q, &v));
        modified.loss.push(2.0 * modified_system.rayleigh(&state.q, &v));
    }
    Ok([plain, modified])
}

/// The motion by a method that knows nothing of L and R but the equations of motion, in parts of each step.
pub fn standard_method(
    ring: &Ring,
    method: Method,
    substeps: usize,
    start: State<f64, 2>,
    bar: &ProgressBar,
) -> Result<Motion> {
    let states = baseline::states(ring, method, H / substeps as f64, start)?;
    let states = states.skip(substeps - 1).step_by(substeps).take(STEPS);
    let states: Vec<_> = once(Ok(start)).chain(bar.wrap_iter(states)).collect::<Result<_>>()?;
    Motion::of(ring, &states)
}

fn time(step: usize) -> f64 {
    step as f64 * H
}

/// The steps that the tables show.
fn rows() -> impl Iterator<Item = usize> {
    (0..=STEPS).step_by(STEPS / 10)
}

fn print_energy([midpoint, runge_kutta, finer, reference]: [&Motion; 4]) {
    println!("Energy, h = {H}; errors are against the reference, segments end at t. All is dimensionless.");
    println!(
        "     t  reference   midpoint     error    segment       RK4     error  RK4, h/{AS_LONG}, error"
    );
    for k in rows() {
        let [exact, node, rk4, finer] =
            [reference, midpoint, runge_kutta, finer].map(|motion| motion.energy[k]);
        let segment = midpoint.segment_energy[k];
        println!(
            "{:6} {exact:10.6} {node:10.6} {:9.1e} {segment:10.6} {rk4:9.6} {:9.1e} {:16.1e}",
            time(k),
            node - exact,
            rk4 - exact,
            finer - exact,
        );
    }
    println!("Steps of RK4 by h/{AS_LONG} take as long as one of the midpoint rule.");
}

fn print_balance(midpoint: &Motion, runge_kutta: &Motion, reference: &Motion) {
    println!(
        "\nWhere the energy went    lost      to drag  to the method (reference: to the sum over states)"
    );
    for (name, motion) in [("midpoint", midpoint), ("RK4", runge_kutta), ("reference", reference)] {
        let (lost, work) = (motion.energy_lost(), motion.drag_work());
        println!("{name:20} {lost:11.7} {work:11.7} {:11.1e}", lost - work);
    }
}

fn print_modified(ring: &Ring, start: State<f64, 2>, plain: &Balance, modified: &Balance) -> Result<()> {
    println!(
        "\nE with R, and the modified Ẽ with R̃, along the midpoint rule's run: what friction leaves unexplained"
    );
    println!("        T      h   of E, at most   of Ẽ, at most");
    println!("{:9} {H:6} {:15.1e} {:15.1e}", time(STEPS), plain.worst(H), modified.worst(H));
    for (h, steps) in [(0.2, 100), (0.1, 200), (0.05, 400), (0.025, 800)] {
        let [plain, modified] = energies(ring, start, h, steps)?;
        println!("{:9} {h:6} {:15.1e} {:15.1e}", h * steps as f64, plain.worst(h), modified.worst(h));
    }
    let largest = ring.by(Midpoint, H).modified_system()?.largest_step(&start.q)?;
    println!("R̃ ≥ 0 at the start for h ≤ {largest:.3}, by the terms of h².");
    Ok(())
}

fn print_angular_momentum(ring: &Ring, midpoint: &Motion, runge_kutta: &Motion, reference: &Motion) {
    println!("\nAngular momentum; errors are against the exact J(t) = J(0) exp(−k t).");
    println!("     t      exact   midpoint     error       RK4     error  reference's error");
    for k in rows() {
        let exact = reference.angular_momentum[0] * (-ring.k * time(k)).exp();
        let [node, rk4, accurate] =
            [midpoint, runge_kutta, reference].map(|motion| motion.angular_momentum[k]);
        println!(
            "{:6} {exact:10.6} {node:10.6} {:9.1e} {rk4:9.6} {:9.1e} {:18.1e}",
            time(k),
            node - exact,
            rk4 - exact,
            accurate - exact,
        );
    }
}

fn print_quality(solver: &Solver, reference: &Motion, looser: &Motion) {
    let uncertainty = difference(&reference.energy, &looser.energy).fold(0.0, |a: f64, b| a.max(b.abs()));
    println!(
        "\nMidpoint: {:.2} Newton iterations a step, {} of {STEPS} steps damped, worst residual {:.1} × round-off.",
        f64::from(solver.iterations) / STEPS as f64,
        solver.damped,
        solver.worst_residual,
    );
    println!("Reference: DOP853 to 1e-13; to 1e-11 its energy differs by at most {uncertainty:.0e}.");
}

fn difference(a: &[f64], b: &[f64]) -> impl Iterator<Item = f64> {
    a.iter().zip(b).map(|(a, b)| a - b)
}

/// The orbit over the first 40 units of time and over the last, between the steps as well.
fn orbit(ring: &Ring, start: State<f64, 2>) -> Result<[Vec<(f64, f64)>; 2]> {
    let mut run = ring.by(Midpoint, H).run(start);
    let mut part = |from: usize| -> Result<Vec<_>> {
        let samples = run.sample_at((0..=10 * SHOWN).map(|k| time(from) + k as f64 * 0.1 * H));
        Ok(samples.map(|sample| sample.map(|at| (at.state.q[0], at.state.q[1]))).collect::<Result<_, _>>()?)
    };
    Ok([part(0)?, part(STEPS - SHOWN)?])
}

/// Orbit and energy; and in a second picture the errors.
fn draw(motions: &Motions, plain: &Balance, modified: &Balance) -> Result<[PathBuf; 2]> {
    let against_time = |values: &mut dyn Iterator<Item = f64>| -> Vec<_> {
        values.enumerate().map(|(k, value)| (time(k), value)).collect()
    };
    let axis = linear("time t (dimensionless)");
    let Motions { orbit: [first, last], midpoint, runge_kutta, finer, reference } = motions;
    let energy = |label, colour, width, motion: &Motion| {
        Curve::line(label, colour, width, against_time(&mut motion.energy.iter().copied()))
    };
    let falling = [
        Panel::new(
            "A particle in a ring potential, with friction",
            linear("x (dimensionless)"),
            linear("y (dimensionless)"),
            vec![
                Curve::line("t up to 40", colour::SIXTH, 2, first.clone()),
                Curve::line("t from 1960 to 2000", colour::VARIATIONAL, 4, last.clone()),
            ],
        )
        .to_equal_scale(),
        Panel::new(
            "Its energy: off by up to 9e-3, without trend",
            axis,
            linear("energy E (dimensionless)"),
            vec![
                energy("midpoint, h = 0.2", colour::VARIATIONAL, 3, midpoint),
                energy("accurate", colour::REFERENCE, 1, reference),
            ],
        ),
    ];
    let path = picture::write("ring", [1240, 560], 2, &falling)?;

    let errors = |title, y: Axis<'static>, quantity: fn(&Motion) -> &Vec<f64>| {
        let curve = |label, colour, motion| {
            let errors: Vec<_> = difference(quantity(motion), quantity(reference)).collect();
            Curve::line(label, colour, 2, largest_of_fifty(&errors))
        };
        let curves = vec![
            curve("midpoint", colour::VARIATIONAL, midpoint),
            curve("Runge–Kutta 4, equal h", colour::RUNGE_KUTTA, runge_kutta).dashed(Dash::Dashed),
            curve("Runge–Kutta 4, h/7: equal cost", colour::EULER, finer).dashed(Dash::Dotted),
        ];
        Panel::new(title, axis, y, curves)
    };
    let lines = |values: Vec<f64>, steps: usize| against_time(&mut values.into_iter().take(steps + 1));
    let lost = |balance: &Balance| balance.energy.iter().map(|energy| balance.energy[0] - energy).collect();
    let losses = vec![
        Curve::line("E(0) − E", colour::FOURTH, 2, lines(lost(plain), SHOWN)),
        Curve::line("Ẽ(0) − Ẽ", colour::VARIATIONAL, 6, lines(lost(modified), SHOWN)),
        Curve::line("∫ 2R̃ dt", colour::REFERENCE, 2, lines(modified.taken(H), SHOWN)).dashed(Dash::Dashed),
    ];
    let unexplained = vec![
        Curve::line(
            "of E, by 2R (dip: change of sign)",
            colour::FOURTH,
            2,
            largest_of_fifty(&plain.remainder(H)),
        )
        .dashed(Dash::Dashed),
        Curve::line("of Ẽ, by 2R̃", colour::VARIATIONAL, 2, largest_of_fifty(&modified.remainder(H))),
    ];
    let errors = [
        errors(
            "Energy: at equal cost Runge–Kutta 4 is ahead",
            logarithmic("|E − reference|, largest of 50 (dimensionless)").with_floor(1e-7).from_to(1e-7, 1.0),
            |motion| &motion.energy,
        ),
        errors(
            "Angular momentum: ahead as well",
            logarithmic("|J − reference|, largest of 50 (dimensionless)")
                .with_floor(1e-9)
                .from_to(1e-9, 1e-1),
            |motion| &motion.angular_momentum,
        ),
        Panel::new(
            "The energy Ẽ of the modified system falls evenly",
            axis,
            linear("lost since t = 0 (dimensionless)"),
            losses,
        ),
        Panel::new(
            "Not explained by friction: less of Ẽ than of E",
            axis,
            logarithmic("|energy + ∫ friction dt − energy(0)| (dimensionless)").from_to(1e-5, 1e-1),
            unexplained,
        ),
    ];
    let second = path.with_file_name(format!(
        "{}-errors.svg",
        path.file_stem().context("a name of the picture")?.to_string_lossy()
    ));
    results::save(&second, &picture::svg([1240, 1160], 2, &errors)?)?;
    Ok([path, second])
}

/// The largest of every 50 steps, without the band below it.
fn largest_of_fifty(values: &[f64]) -> Vec<(f64, f64)> {
    let of = |steps: &[f64]| steps.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    (1..).step_by(50).map(|k| time(k + 25)).zip(values[1..].chunks_exact(50).map(of)).collect()
}
