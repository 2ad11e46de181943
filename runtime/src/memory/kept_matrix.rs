//! Steps with a Newton matrix kept from an earlier step.
//!
//! ```text
//! v̄ ← v̄ − A⁻¹ (p0(v̄) − p)        A = ∂p0/∂v̄ of an earlier step, factored
//! ```
//!
//! Each correction costs both momenta and no second derivatives. Where the matrix is constant one correction is enough; where
//! it is not, the corrections shrink by a factor that tells how far the matrix is off. A factor that is not small hands the
//! step to Newton's method, and its matrix is kept from then on.

use nalgebra::SVector;

use super::{Memory, VelocityHistory};
use crate::linear::{Factored, NewtonMatrix};
use crate::newton::{estimated_floor, held_against, weighted};
use crate::{Discrete, Report, Scalar, State, Step, StepError};

/// A correction must leave at most this share of the residual.
const CONTRACTION: f64 = 0.1;

/// Corrections before Newton's method takes over.
const MOST: u32 = 5;

/// Where a step takes more corrections than this, the matrix is renewed.
const STALE: u32 = 3;

/// A matrix that serves fewer steps than this costs more than it saves: Newton's method then takes a number of steps, twice
/// as many each time in a row, before another is kept.
const WORTHWHILE: u32 = 4;

/// The least and the largest of these numbers of steps.
const PAUSES: [u32; 2] = [8, 1024];

/// The Newton matrix of an earlier step, factored, and the latest mean velocities.
///
/// Where the matrix changes so fast that one kept is soon of no use, most steps are those of [`VelocityHistory`].
#[derive(Clone, Copy, Debug)]
pub struct KeptMatrix<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> {
    history: VelocityHistory<S, N>,
    kept: Option<Kept<S, M, N>>,
    /// Steps that the matrix has served.
    served: u32,
    /// Steps to take without one.
    pause: u32,
    next_pause: u32,
}

/// A matrix and the step size that it belongs to.
#[derive(Clone, Copy, Debug)]
struct Kept<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> {
    h: S,
    matrix: M,
    factored: M::Factored,
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Default for KeptMatrix<S, M, N> {
    fn default() -> Self {
        let [next_pause, _] = PAUSES;
        Self { history: VelocityHistory::default(), kept: None, served: 0, pause: 0, next_pause }
    }
}

impl<L, R, const N: usize> Memory<L, R, N> for KeptMatrix<L::Scalar, L::Matrix, N>
where
    L: Discrete<R, N>,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        if self.pause > 0 {
            let step = self.history.advance(system, state, h)?;
            self.pause -= 1;
            return Ok(step);
        }
        if let Some(kept) = &self.kept
            && kept.h == h
            && let Some(guess) = if L::LINEAR { self.history.latest() } else { self.history.extrapolation(h) }
            && let Some(step) = kept.step(system, state, guess)
        {
            self.history.push(step.velocity, h);
            self.served = self.served.saturating_add(1);
            if step.report.iterations > STALE {
                self.renew(system, state, &step, h);
            }
            return Ok(step);
        }
        let step = self.history.advance(system, state, h)?;
        self.renew(system, state, &step, h);
        Ok(step)
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> KeptMatrix<S, M, N> {
    /// Keeps the matrix at the end of the step; none if it cannot be factored, or if the last one was not worth it.
    #[cold]
    #[inline(never)]
    fn renew<L, R>(&mut self, system: &L, state: &State<S, N>, step: &Step<S, N>, h: S)
    where
        L: Discrete<R, N, Scalar = S, Matrix = M>,
    {
        if self.kept.as_ref().is_some_and(|kept| kept.h == h) {
            if L::LINEAR {
                return;
            }
            let [shortest, longest] = PAUSES;
            if self.served < WORTHWHILE {
                (self.kept, self.pause) = (None, self.next_pause);
                self.next_pause = (2 * self.next_pause).min(longest);
                return;
            }
            self.next_pause = shortest;
        }
        self.served = 0;
        let matrix = system.step_kernel(&state.q, &step.velocity, h).matrix;
        self.kept = matrix.factored().map(|factored| Kept { h, matrix, factored });
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Kept<S, M, N> {
    /// The step from `guess`; nothing where the corrections do not shrink fast, or a number is none.
    #[inline]
    fn step<L, R>(&self, system: &L, state: &State<S, N>, guess: SVector<S, N>) -> Option<Step<S, N>>
    where
        L: Discrete<R, N, Scalar = S, Matrix = M>,
    {
        let State { q, p } = state;
        let mut v = guess;
        let floor = estimated_floor(p, &self.matrix, &v);
        let weights = floor.map(|floor| S::one() / floor);
        let mut correction: SVector<S, N> = nalgebra::zero();
        let mut last_size = None;
        for iterations in 0..=MOST {
            let momenta = system.momenta(q, &v, self.h);
            let residual = momenta.p0 - p;
            let (worst, its_floor, is_root) = held_against(&residual, &floor);
            // At least one correction: extrapolation alone, step after step, would let rounding grow.
            if iterations > 0 && is_root {
                let last_correction = correction.amax();
                let report =
                    Report { iterations, damped: 0, residual: worst, floor: its_floor, last_correction };
                let state = State { q: q + v * self.h, p: p + (momenta.p1 - momenta.p0) };
                state.require_finite().ok()?;
                return Some(Step { state, velocity: v, report });
            }
            if L::LINEAR {
                // Rounding holds the residual up: the general path has the verdict.
                if iterations > 0 {
                    return None;
                }
            } else {
                let size = weighted(&residual, &weights);
                if let Some(last) = last_size
                    && !(size <= last * S::constant(CONTRACTION))
                {
                    return None;
                }
                last_size = Some(size);
            }
            correction = self.factored.solve(&residual);
            v -= correction;
        }
        None
    }
}
