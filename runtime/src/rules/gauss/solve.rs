//! The stages from one velocity, by the first method that solves for them: the fixed point where it
//! contracts, else simplified Newton's method, else Newton's. From an extrapolation that is far off the last
//! two may find another root than the motion's: they start at a velocity of the state.

use nalgebra::SVector;

use super::problem::{Problem, Solution};
use super::{fixed_point, newton, simplified};
use crate::numbers::{Scalar, lanes::splat};
use crate::step::StepError;
use crate::system::ForcedLagrangian;

/// Solves for the stages from the one velocity `guess`.
#[inline]
pub(super) fn solve<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &SVector<T, N>,
) -> Result<Solution<T, N, S>, StepError> {
    fixed_point::iterate(problem, &splat(guess)).map_or_else(|| by_matrices(problem, guess), Ok)
}

/// Without the fixed point.
#[cold]
#[inline(never)]
pub(super) fn by_matrices<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &SVector<T, N>,
) -> Result<Solution<T, N, S>, StepError> {
    match simplified::iterate(problem, guess) {
        Some(solution) => Ok(solution),
        None => newton::solve(problem, &splat(guess), newton::MAX_ITERATIONS),
    }
}
