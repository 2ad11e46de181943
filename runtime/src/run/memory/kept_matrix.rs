//! Steps with a Newton matrix kept from an earlier step.
//!
//! ```text
//! v̄ ← v̄ − A⁻¹ (p0(v̄) − p)        A = ∂p0/∂v̄ of an earlier step, factored
//! ```
//!
//! Each correction costs both momenta and no second derivatives. Where the matrix is constant one correction
//! is enough; where it is not, the corrections shrink by a factor that tells how far the matrix is off. A
//! factor that is not small hands the step to Newton's method, and its matrix is kept from then on.

use nalgebra::SVector;

use crate::numbers::{Factored, NewtonMatrix, Scalar};
use crate::step::{
    Border, ClosedForm, Discrete, Fused, KeptOf, Memory, MemoryInLanes, Momenta, Report, Segment, State,
    Step, StepError, VelocityHistory,
    newton::{
        AT_FLOOR, add_finite_part, estimated_floor, held_against, held_by_weights, is_sensible,
        is_small_beside, weighted,
    },
};

/// A correction must leave at most this share of the residual.
pub(super) const CONTRACTION: f64 = 0.1;

/// If the guess leaves more than this share of p0 as residual, the old matrix is not tried: the terms at the
/// guess say nothing about rounding at the root.
pub(super) const CLOSE: f64 = 0.025;

/// Corrections before Newton's method takes over.
pub(super) const MOST: u32 = 5;

/// Where the equation is linear, a correction above this share of v̄ is followed by another.
pub(super) const SMALL: f64 = 1.0 / 64.0;

/// Where a step takes more corrections than this, the matrix is renewed.
const STALE: u32 = 3;

/// A matrix that serves fewer steps than this costs more than it saves: Newton's method then takes a number
/// of steps, twice as many each time in a row, before another is kept.
const WORTHWHILE: u32 = 3;

/// The least and the largest of these numbers of steps.
const PAUSES: [u32; 2] = [8, 1024];

/// Whether the equation is linear in v̄.
const fn is_linear<L: Fused<R, N>, R, const N: usize>() -> bool {
    L::LINEAR && !L::IS_CONSTRAINED
}

/// The Newton matrix of an earlier step, factored, and the latest mean velocities.
///
/// Where the matrix changes so fast that one kept is soon of no use, most steps are those of
/// [`VelocityHistory`].
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
    L: ClosedForm<R, N> + Discrete<R, N>,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        if self.pause > 0 {
            let step = self.history.advance(system, state, h);
            self.pause -= u32::from(step.is_ok());
            return step;
        }
        if let Some(kept) = &self.kept
            && kept.h == h
        {
            let step = self.history.extrapolation(h).and_then(|guess| {
                if is_linear::<L, R, N>() {
                    kept.linear_step(system, state, guess)
                } else {
                    kept.step(system, state, guess)
                }
            });
            if let Some(step) = step {
                if cfg!(debug_assertions) {
                    system.verify_segment(&Segment { q0: state.q, v: step.velocity, h })?;
                }
                self.history.push(step.velocity, h);
                self.served = self.served.saturating_add(1);
                if step.report.iterations > STALE {
                    self.renew(system, state, &step.velocity, h);
                }
                return Ok(step);
            }
        }
        let step = self.history.advance(system, state, h);
        if let Ok(step) = &step {
            self.renew(system, state, &step.velocity, h);
        }
        step
    }

    fn suggest(&mut self, velocity: &SVector<L::Scalar, N>, h: L::Scalar) {
        self.history.push(*velocity, h);
    }

    /// A matrix that is another's is given up where it does not serve; one of a linear equation holds no
    /// input.
    fn change_input(&mut self) {
        Memory::<L, R, N>::change_input(&mut self.history);
    }

    fn change_state(&mut self) {}
}

impl<L, R, const N: usize> MemoryInLanes<L, R, N> for KeptMatrix<L::Scalar, L::Matrix, N>
where
    L: ClosedForm<R, N> + Discrete<R, N>,
{
    const KEEPS: bool = true;

    fn history(&mut self) -> &mut VelocityHistory<L::Scalar, N> {
        &mut self.history
    }

    fn is_by_newton(&self) -> bool {
        self.pause > 0
    }

    fn kept(&self, h: L::Scalar) -> Option<KeptOf<'_, L, R, N>> {
        let kept = self.kept.as_ref().filter(|kept| self.pause == 0 && kept.h == h);
        kept.map(|Kept { matrix, factored, .. }| (matrix, factored))
    }

    fn has_paused(&mut self) {
        self.pause -= 1;
    }

    fn has_served(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        (velocity, h): (SVector<L::Scalar, N>, L::Scalar),
        corrections: u32,
    ) -> bool {
        self.served = self.served.saturating_add(1);
        let is_stale = corrections > STALE;
        if is_stale {
            self.renew(system, state, &velocity, h);
        }
        is_stale
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> KeptMatrix<S, M, N> {
    /// Keeps the matrix at the end of the step; none if it cannot be factored, or if the last one was not
    /// worth it.
    #[cold]
    #[inline(never)]
    fn renew<L, R>(&mut self, system: &L, state: &State<S, N>, velocity: &SVector<S, N>, h: S)
    where
        L: Fused<R, N, Scalar = S, Matrix = M>,
    {
        if !is_linear::<L, R, N>() && self.kept.as_ref().is_some_and(|kept| kept.h == h) {
            let [shortest, longest] = PAUSES;
            if self.served < WORTHWHILE {
                (self.kept, self.pause) = (None, self.next_pause);
                self.next_pause = (2 * self.next_pause).min(longest);
                return;
            }
            self.next_pause = shortest;
        }
        self.served = 0;
        let matrix = system.step_kernel(&Segment { q0: state.q, v: *velocity, h }).matrix;
        self.kept = matrix.factored().map(|factored| Kept { h, matrix, factored });
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Kept<S, M, N> {
    /// The step from `guess`; nothing where the corrections do not shrink fast, or a number is none.
    #[inline]
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "a size that is NaN must fail the comparison")]
    fn step<L, R>(&self, system: &L, state: &State<S, N>, guess: SVector<S, N>) -> Option<Step<S, N>>
    where
        L: Fused<R, N, Scalar = S, Matrix = M>,
    {
        let p = &state.p;
        let first = Segment { q0: state.q, v: guess, h: self.h };
        let underway = <L::Border as Border<L, R, N>>::underway(system, &first, &self.factored)?;
        let mut floor = estimated_floor(p, &self.matrix, &guess);
        let mut weights: SVector<S, N> = nalgebra::zero();
        let mut segment = first;
        let mut correction: SVector<S, N> = nalgebra::zero();
        let mut last_size = S::constant(CLOSE) / (S::EPSILON * S::constant(CONTRACTION));
        // At least one correction: extrapolation alone, step after step, would let rounding grow.
        for iterations in 0..=MOST {
            let mut momenta = system.momenta(&segment);
            let without = momenta.p0;
            let residual = <L::Border as Border<L, R, N>>::residual(
                &underway,
                system,
                &segment,
                &self.factored,
                p,
                &mut momenta,
            );
            if iterations == 0 {
                floor = <L::Border as Border<L, R, N>>::floor(floor, &without, &momenta.p0);
                weights = floor.map(|floor| S::one() / floor);
            }
            let size = weighted(&residual, &weights);
            let is_solved = iterations > 0 && size <= S::constant(AT_FLOOR);
            if is_solved && !<L::Border as Border<L, R, N>>::is_off(&underway, system, &segment) {
                let (residual, floor) = if is_small_beside(&residual, p) {
                    held_by_weights(&residual, &floor, &weights, size)
                } else {
                    self.held_with_care(system, state, segment.v, residual)
                }?;
                let last_correction = correction.amax();
                let report = Report { iterations, damped: 0, residual, floor, last_correction };
                let step = Step::completed(state, self.h, segment.v, &momenta, report).ok()?;
                return <L::Border as Border<L, R, N>>::completed(system, step, self.h);
            }
            if !is_solved && !(size <= last_size * S::constant(CONTRACTION)) {
                return if iterations > 0 && !L::IS_CONSTRAINED {
                    self.held_up(system, state, segment.v, momenta, (iterations, correction))
                } else {
                    None
                };
            }
            last_size = size;
            correction = self.factored.solve(&residual);
            segment.v -= correction;
        }
        None
    }

    /// The `residual` at `v` and its floor, by the matrix there: one of a collision that is over is larger by
    /// any factor, and with it the floor. Nothing where the residual is no root's.
    #[cold]
    #[inline(never)]
    fn held_with_care<L, R>(
        &self,
        system: &L,
        State { q, p }: &State<S, N>,
        v: SVector<S, N>,
        residual: SVector<S, N>,
    ) -> Option<(S, S)>
    where
        L: Fused<R, N, Scalar = S, Matrix = M>,
    {
        let floor = estimated_floor(p, &system.step_kernel(&Segment { q0: *q, v, h: self.h }).matrix, &v);
        let (residual, floor, is_root) = held_against(&residual, &floor);
        is_root.then_some((residual, floor))
    }

    /// The step to `v`, whose residual has stopped falling, if the rounding of q explains it; nothing if not.
    ///
    /// Forces that cancel, as those of neighbouring springs do on a long wave, are rounded as each is. What q
    /// does to p0 is, by the midpoint and the trapezoidal rule, 2/h times what of the matrix J(h) is even
    /// in h, less the mass matrix:
    ///
    /// ```text
    /// E = (J(h) + J(−h))/2 − J(0) = −(h²/4) ∂²L/∂q² + …      floorᵢ += 4ε (2/|h|) Σⱼ |Eᵢⱼ||qⱼ|
    /// ```
    ///
    /// Damping adds terms that are odd in h: it acts on v, with which it vanishes.
    #[cold]
    #[inline(never)]
    fn held_up<L, R>(
        &self,
        system: &L,
        state: &State<S, N>,
        v: SVector<S, N>,
        momenta: Momenta<S, N>,
        (iterations, correction): (u32, SVector<S, N>),
    ) -> Option<Step<S, N>>
    where
        L: Fused<R, N, Scalar = S, Matrix = M>,
    {
        let State { q, p } = state;
        let matrix = |h| system.step_kernel(&Segment { q0: *q, v, h }).matrix;
        // 2E.
        let (now, mass) = (matrix(self.h), matrix(S::zero()));
        let even = now.plus(&matrix(-self.h), S::one()).plus(&mass, -S::constant(2.0));
        let unit = S::constant(4.0) * S::EPSILON / self.h.abs();
        let floor = estimated_floor(p, &now, &v) + even.magnitudes(&(q * unit));
        let mut terms: SVector<S, N> = nalgebra::zero();
        for of in [p, &mass.magnitudes(&v)] {
            add_finite_part(terms.as_mut_slice(), S::one(), of.as_slice());
        }
        let is_sensible = is_sensible(floor.as_slice(), terms.as_slice());
        let (residual, floor, is_root) = held_against(&(momenta.p0 - p), &floor);
        let report = Report { iterations, damped: 0, residual, floor, last_correction: correction.amax() };
        if !is_root || !is_sensible {
            return None;
        }
        Step::completed(state, self.h, v, &momenta, report).ok()
    }

    /// The step where the equation is linear, from any `guess`; nothing where rounding holds the residual up
    /// or a number is none: the general path has the verdict.
    #[inline]
    fn linear_step<L, R>(&self, system: &L, state: &State<S, N>, guess: SVector<S, N>) -> Option<Step<S, N>>
    where
        L: Fused<R, N, Scalar = S, Matrix = M>,
    {
        let p = &state.p;
        let mut segment = Segment { q0: state.q, v: guess, h: self.h };
        let mut correction: SVector<S, N> = nalgebra::zero();
        let mut iterations = 0;
        // The factors' rounding is the same at every step, and so is its share of a correction: a drift,
        // unless corrections are small.
        while iterations == 0 || iterations == 1 && correction.amax() > segment.v.amax() * S::constant(SMALL)
        {
            correction = self.factored.solve(&(system.momenta(&segment).p0 - p));
            segment.v -= correction;
            iterations += 1;
        }
        let momenta = system.momenta(&segment);
        let floor = estimated_floor(p, &self.matrix, &segment.v);
        let (residual, floor, is_root) = held_against(&(momenta.p0 - p), &floor);
        if !is_root {
            return None;
        }
        let report = Report { iterations, damped: 0, residual, floor, last_correction: correction.amax() };
        Step::completed(state, self.h, segment.v, &momenta, report).ok()
    }
}
