//! Steps in parts: the root that Newton's method misses from the state alone.
//!
//! The root of a step is a curve v̄(h) that starts at the velocity of the state; the step continues the motion
//! if it lies on it. Where no iteration from the state leads to the root, h grows part by part, each solved
//! from the root before: a short homotopy (E. L. Allgower and K. Georg, Numerical Continuation Methods, 1990,
//! chapter 2). It ends where the curve turns back, and then there is no such root.

use nalgebra::SVector;

use super::careful::{MAX_ITERATIONS, careful};
use super::verdict::Inertia;
use super::{Equations, Reached, Solution, from_rest};
use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::{Momenta, State, StepError, StepKernel};

/// The first part of h, from which parts double, and the least.
const FIRST: f64 = 1.0 / 1024.0;

/// Parts that are tried.
const PARTS: u32 = 24;

/// Iterations for each: what needs more has left the root.
pub(crate) const ITERATIONS: u32 = 10;

/// p0 and the Newton matrix as a function of (q, v̄, h).
type Kernel<'f, S, M, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>, S) -> StepKernel<S, N, M> + 'f;

/// Both momenta as a function of (q, v̄, h).
type BothMomenta<'f, S, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>, S) -> Momenta<S, N> + 'f;

/// Sizes of terms that cancel in p0 as a function of (q, v̄, h).
type Cancelling<'f, S, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>, S) -> SVector<S, N> + 'f;

/// The equation of a step as functions of (q, v̄, h), of which `inertia` does not depend on h; behind
/// pointers, for steps that take long.
pub(crate) struct StepEquations<'f, S, M, const N: usize> {
    pub(crate) kernel: &'f Kernel<'f, S, M, N>,
    pub(crate) momenta: &'f BothMomenta<'f, S, N>,
    pub(crate) inertia: &'f Inertia<'f, S, N>,
    pub(crate) cancelling: &'f Cancelling<'f, S, N>,
    pub(crate) state: &'f State<S, N>,
    pub(crate) h: S,
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> StepEquations<'_, S, M, N> {
    fn with<T>(&self, h: S, ask: impl FnOnce(&Equations<'_, S, M, N>) -> T) -> T {
        ask(&Equations {
            evaluate: &|q, v| (self.kernel)(q, v, h),
            finish: &|q, v| (self.momenta)(q, v, h),
            inertia: self.inertia,
            cancelling: &|q, v| (self.cancelling)(q, v, h),
            state: self.state,
            h,
        })
    }

    /// The root of the part `share` of h, from `v`, if it is near.
    fn part(&self, share: S, v: &SVector<S, N>) -> Option<SVector<S, N>> {
        let reached = Reached { v: *v, iterations: MAX_ITERATIONS - ITERATIONS };
        self.with(self.h * share, |part| careful(part, reached)).ok().map(|solution| solution.unknown)
    }
}

/// The step where the undamped method from `start` has only `reached` so far: by the damped method and, where
/// `start` is not a guess of the caller's, from rest and in parts.
///
/// # Errors
/// What the damped method ends with, or what it ends with from rest.
#[cold]
#[inline(never)]
pub(crate) fn at_length<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    of: &StepEquations<'_, S, M, N>,
    start: SVector<S, N>,
    is_guess: bool,
    reached: Reached<S, N>,
) -> Result<Solution<S, N>, StepError> {
    of.with(of.h, |whole| {
        let error = match careful(whole, reached) {
            Err(error) if !is_guess => error,
            found => return found,
        };
        from_rest(whole, &start, error).or_else(|error| {
            let v = along_h(start, &|share, v| of.part(share, v));
            v.and_then(|v| careful(whole, Reached { v, iterations: 0 }).ok()).ok_or(error)
        })
    })
}

/// The root for the whole of h, reached part by part; `root` gives the root of a share of h from that of
/// another, if it is near.
#[cold]
#[inline(never)]
pub(crate) fn along_h<S: Scalar, G: Copy>(start: G, root: &dyn Fn(S, &G) -> Option<G>) -> Option<G> {
    let first = S::constant(FIRST);
    let (mut at, mut reached, mut part) = (start, S::zero(), first);
    for _ in 0..PARTS {
        let share = if reached + part < S::one() { reached + part } else { S::one() };
        match root(share, &at) {
            Some(next) if share == S::one() => return Some(next),
            Some(next) => {
                (at, reached) = (next, share);
                part += part;
            }
            // The first part is so short that only what has no motion at all fails.
            None if part <= first => return None,
            None => part *= S::constant(0.25),
        }
    }
    None
}
