//! `ode_solvers`: Dormand–Prince 8(5,3), output at its steps only.

use anyhow::{Result, anyhow};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, SVector, System};

use super::{MOST_STEPS, Motion, last};
use crate::scenes::Accelerated;

impl<S: Accelerated<N>, const N: usize, const M: usize> System<f64, SVector<f64, M>> for Motion<'_, S, N> {
    #[inline]
    fn system(&self, _: f64, y: &SVector<f64, M>, rate: &mut SVector<f64, M>) {
        self.rate(y.as_slice(), rate.as_mut_slice());
    }
}

pub fn dop853<S: Accelerated<N>, const N: usize, const M: usize>(
    scene: &S,
    start: &[f64; M],
    time: f64,
    tolerance: f64,
) -> Result<[f64; M]> {
    // Defaults but for the output and the number of steps, which ends long runs at 100 000.
    let mut solver = Dop853::from_param(
        Motion::<S, N>::new(scene),
        0.0,
        time,
        time,
        SVector::from(*start),
        tolerance,
        tolerance,
        0.9,
        0.0,
        0.333,
        6.0,
        time,
        0.0,
        MOST_STEPS,
        1000,
        OutputType::Sparse,
    );
    solver.integrate().map_err(|error| anyhow!("{error}"))?;
    Ok((*last(solver.y_out())?).into())
}
