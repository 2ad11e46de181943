//! `diffsol`: Tsitouras 5(4), stepped to the end without output on the way.
//!
//! Its implicit methods are for stiff systems, and no scene is one.

use anyhow::{Result, anyhow, bail};
use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};

use super::{MOST_STEPS, Motion};
use crate::scenes::Accelerated;

pub fn tsit45<S: Accelerated<N>, const N: usize, const M: usize>(
    scene: &S,
    start: &[f64; M],
    time: f64,
    tolerance: f64,
) -> Result<[f64; M]> {
    let motion = Motion::<S, N>::new(scene);
    let start = *start;
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs(move |y, _, _, rate| motion.rate(y, rate))
        .init(move |_, _, y| y.copy_from_slice(&start), M)
        .build()
        .map_err(|error| anyhow!("{error}"))?;
    let mut solver = problem.tsit45().map_err(|error| anyhow!("{error}"))?;
    solver.set_stop_time(time).map_err(|error| anyhow!("{error}"))?;
    for _ in 0..MOST_STEPS {
        if matches!(solver.step().map_err(|error| anyhow!("{error}"))?, OdeSolverStopReason::TstopReached) {
            return Ok(solver.state().y.batch_as_slice(0).try_into()?);
        }
    }
    bail!("more than {MOST_STEPS} steps")
}
