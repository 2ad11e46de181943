//! The start of a run: whether the system is the one written.

use nalgebra::SVector;

use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::{State, StepError};
use crate::system::{
    Lagrangian, derivatives_apart,
    verification::{around, has_two_values},
};

/// Verifies a system where a run starts, `elapsed` after its own time.
#[cold]
#[inline(never)]
pub(crate) fn verify_start<L: Lagrangian<N>, const N: usize>(
    system: &L,
    elapsed: f64,
    state: &State<L::Scalar, N>,
) -> Result<(), StepError> {
    if !has_two_values(L::STRUCTURE.engine) {
        return Ok(());
    }
    system.later(L::Scalar::constant(elapsed), |system| {
        // One Newton iteration for ∂L/∂v(q, v) = p from rest: exact where L is quadratic in v, and a point as
        // good as any elsewhere.
        let rest = SVector::zeros();
        let l = derivatives_apart(system, &state.q, &rest);
        let v = l.d22.solve(&(state.p - l.d2)).unwrap_or(rest);
        Ok(around(system, &state.q, &v)?)
    })
}
