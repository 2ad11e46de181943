//! A study as a program for any number of machines: it takes some of the members and a folder, and writes
//! what is missing there. Members never talk, and what is there is done, so that no more is needed:
//!
//! ```text
//! cargo run --release -p dalembert-ensemble --features parquet --example cluster -- --members 0..262144 cloud/
//! sbatch --array=0-3 ensemble/examples/cluster.sbatch cloud/
//! ```
//!
//! A cloud of 262 144 satellites of one orbit of eccentricity 0.1, scattered by an error in the velocity of a
//! thousandth, with thin drag: where they are after 10 revolutions.

use std::ops::{ControlFlow, Range};
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use dalembert::{Splitting, State, StepError, rayleigh_system};
use dalembert_ensemble::{Ensemble, Progress};
use lexopt::Arg;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A satellite with drag; the semi-major axis of the orbit is 1, its period 2π.
#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn satellite(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt(), 0.5 * r * speed)
}

const SEED: u64 = 1;
/// 64 steps a revolution.
const H: f64 = core::f64::consts::TAU / 64.0;
/// Ten revolutions.
const STEPS: u64 = 640;

fn member(number: u64) -> Result<(Satellite, State<f64, 2>), StepError> {
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    random.set_stream(number);
    let mut scatter = |size: f64| random.random_range(-size..size);
    let satellite = Satellite { r: 1e-5 * (1.0 + scatter(0.5)) };
    let e: f64 = 0.1;
    let speed = ((1.0 + e) / (1.0 - e)).sqrt();
    let start = State::from_velocity(&satellite, [1.0 - e, 0.0], [scatter(1e-3), speed + scatter(1e-3)])?;
    Ok((satellite, start))
}

fn main() -> Result<()> {
    let (numbers, folder) = arguments()?;
    let study = Ensemble::new(member).by(Splitting::blanes_moan_6(), H).steps(STEPS).in_lanes().on_progress(
        |Progress { done, failed, members }| {
            eprint!("\r{done} of {members} members, {failed} failed ");
            ControlFlow::Continue(())
        },
    );
    let parts = study.parts(&folder).members_per_part(16_384).column("r", |of| of.r).metadata("seed", SEED);
    let written = parts.write(numbers)?;
    eprintln!();
    println!("{}: {written}", folder.display());
    Ok(())
}

fn arguments() -> Result<(Range<u64>, PathBuf)> {
    let (mut numbers, mut folder) = (0..262_144, None);
    let mut arguments = lexopt::Parser::from_env();
    while let Some(argument) = arguments.next()? {
        match argument {
            Arg::Long("members") => {
                let text = arguments.value()?.into_string().unwrap_or_default();
                let (start, end) = text.split_once("..").context("--members takes two numbers, 0..1000")?;
                numbers = start.parse()?..end.parse()?;
            }
            Arg::Value(path) => folder = Some(PathBuf::from(path)),
            other => bail!(other.unexpected()),
        }
    }
    Ok((numbers, folder.context("the folder to write to: cluster [--members 0..1000] FOLDER")?))
}
