//! A long run that may be interrupted at any moment, by Ctrl-C or a power cut, and goes on when it is started
//! again: a chaotic double pendulum with weak friction, five million steps. Its energy is all that can be
//! asked of it, and falls as friction takes it. Beside it so many steps of the classical Runge–Kutta method,
//! which takes energy itself.
//!
//! All quantities are dimensionless.
//!
//! ```text
//! cargo run --release --example long_run [picture.svg]
//! ```

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use dalembert::{Midpoint, State, rayleigh_system};
use dalembert_examples::baseline::{self, Method};
use dalembert_examples::picture::{self, Curve, Dash, Panel, colour, linear};
use dalembert_examples::saved_run::{SavedRun, Schedule};

/// Two equal pendulums, one hung from the other, with friction in the upper joint.
#[rayleigh_system]
fn double_pendulum(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    let kinetic = v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos();
    (kinetic + 2.0 * q[0].cos() + q[1].cos(), 0.5 * r * v[0] * v[0])
}

const H: f64 = 0.02;
const SCHEDULE: Schedule = Schedule { row: 5_000, rows_to_checkpoint: 20, end: 5_000_000 };

fn main() -> Result<()> {
    let system = DoublePendulum { r: 2e-6 };
    let start = State::from_velocity(&system, [2.5, 1.5], [0.0, 0.0])?;
    let target = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("target");
    let run = SavedRun::in_folder(target.join("long_run"));
    println!("Rows and checkpoint: {}", run.rows().with_file_name("").display());
    println!("Interrupt it and start it again: it goes on. Remove the folder to begin anew.\n");
    let row = |time: f64, state: &State<f64, 2>| {
        let energy = state.energy(&system).unwrap_or(f64::NAN);
        format!("{time},{energy},{},{}", state.q[0], state.q[1])
    };
    let end = run.run((&system, Midpoint), (H, start), SCHEDULE, row)?;

    let text = fs::read_to_string(run.rows())?;
    let points: Vec<(f64, f64)> = text
        .lines()
        .map(|line| {
            let mut entries = line.split(',').map(str::parse::<f64>);
            let mut number = || entries.next().context("a row is short")?.context("a row has no number");
            Ok((number()?, number()?))
        })
        .collect::<Result<_>>()?;
    let runge_kutta = baseline::states(&system, Method::RungeKutta4, H, start)?
        .take(SCHEDULE.end as usize)
        .skip(SCHEDULE.row as usize - 1)
        .step_by(SCHEDULE.row as usize);
    let runge_kutta = runge_kutta.map(|state| Ok(state?.energy(&system)?)).collect::<Result<Vec<_>>>()?;
    println!("     time t   energy E, midpoint   Runge–Kutta 4");
    for ((time, energy), beside) in points.iter().zip(&runge_kutta).skip(99).step_by(100) {
        println!("{time:11.1} {energy:20.6} {beside:15.6}");
    }
    println!("\nAt the end q = ({}, {}).", end.q[0], end.q[1]);
    let first = (0.0, start.energy(&system)?);
    let beside = points.iter().zip(runge_kutta).map(|((time, _), energy)| (*time, energy));
    let beside = [first].into_iter().chain(beside).collect();
    let points = [first].into_iter().chain(points).collect();
    let curves = vec![
        Curve::line("midpoint, h = 0.02, every 5 000th step", colour::VARIATIONAL, 1, points),
        Curve::line("Runge–Kutta 4, equal h", colour::RUNGE_KUTTA, 2, beside).dashed(Dash::Dashed),
    ];
    let panel = Panel::new(
        "Five million steps of chaos: midpoint loses energy to friction, Runge–Kutta 4 itself",
        linear("time t (dimensionless)"),
        linear("energy E (dimensionless)"),
        curves,
    );
    println!("\nPicture: {}", picture::write("long_run", [1000, 600], 1, &[panel])?.display());
    Ok(())
}
