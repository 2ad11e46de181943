//! Newton's method with friction in it: 0 ∈ F(x) + D s, with s the way of u(x) where that is not 0 and
//! |s| ≤ 1 where it is.

use nalgebra::SVector;

use super::set::Held;
use super::sliding::Sliding;
use crate::numbers::{Factored, Scalar};
use crate::step::StepError;
use crate::system::Slips;

/// Iterations: one where F is linear.
const ITERATIONS: u32 = 32;

/// Roundings of x below which a correction is the last.
const ROUNDINGS: f64 = 8.0;

/// The equation at one x.
pub(super) struct Line<S, F, const N: usize, const M: usize> {
    /// F(x).
    pub(super) left: SVector<S, N>,
    /// ∂F/∂x, factored.
    pub(super) factored: F,
    /// u(x) and ∂u/∂x.
    pub(super) slips: Slips<S, N, M>,
    /// Sizes of the terms of F that friction may take away, beside which roundings of x count.
    pub(super) beside: SVector<S, N>,
    /// Whether one correction leads to the root.
    pub(super) is_linear: bool,
}

/// The root.
pub(super) struct Root<S, const N: usize, const M: usize> {
    pub(super) x: SVector<S, N>,
    /// s, and what sticks.
    pub(super) held: Held<S, M>,
    /// D s.
    pub(super) impulse: SVector<S, N>,
}

/// The root from `start`, where D is (h/2) F ∂u/∂v and `at` has the equation; nothing of it where it has no
/// matrix.
///
/// # Errors
/// [`StepError::NotConverged`]; those of friction.
#[inline(always)]
pub(super) fn root<S: Scalar, F: Factored<S, N>, const N: usize, const M: usize>(
    sizes: &[usize],
    start: &SVector<S, N>,
    h: S,
    mut at: impl FnMut(&SVector<S, N>) -> Result<Option<Line<S, F, N, M>>, StepError>,
) -> Result<Root<S, N, M>, StepError> {
    let (mut x, mut forces, mut left) = (*start, nalgebra::zero(), nalgebra::zero());
    for iteration in 0..ITERATIONS {
        let Some(line) = at(&x)? else { break };
        let sliding = Sliding::of(&line.slips, &x, (S::zero(), h), &line.factored)?;
        let Some(held) = sliding.held(sizes, &line.factored, &line.left, &forces) else { break };
        forces = held.forces;
        let impulse = sliding.impulse(&forces);
        left = line.left + impulse;
        let correction = line.factored.solve(&left);
        x -= correction;
        let is_near = || {
            let size = x.amax() + line.factored.solve(&line.beside).amax();
            correction.amax() <= size * (S::EPSILON * S::constant(ROUNDINGS))
        };
        if line.is_linear || iteration > 0 && is_near() {
            return Ok(Root { x, held, impulse });
        }
    }
    Err(StepError::NotConverged { iterations: ITERATIONS, residual: left.amax().widen(), floor: 0.0 })
}
