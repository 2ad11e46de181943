//! `differential-equations`: Dormand–Prince 8(5,3), output at its steps only.
//!
//! Its Verner 8(7) stalls at tolerances about 1e-11 (version 0.7.0), and is left out.

use anyhow::{Result, anyhow};
use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};

use super::{MOST_STEPS, Motion, last};
use crate::scenes::Accelerated;

impl<S: Accelerated<N>, const N: usize, const M: usize> ODE<f64, [f64; M]> for Motion<'_, S, N> {
    #[inline]
    fn diff(&self, _: f64, y: &[f64; M], rate: &mut [f64; M]) {
        self.rate(y, rate);
    }
}

pub fn dop853<S: Accelerated<N>, const N: usize, const M: usize>(
    scene: &S,
    start: &[f64; M],
    time: f64,
    tolerance: f64,
) -> Result<[f64; M]> {
    let solution = IVP::ode(&Motion::<S, N>::new(scene), 0.0, time, *start)
        .method(ExplicitRungeKutta::dop853().max_steps(MOST_STEPS as usize))
        .rtol(tolerance)
        .atol(tolerance)
        .solve()
        .map_err(|error| anyhow!("{error:?}"))?;
    Ok(*last(&solution.y)?)
}
