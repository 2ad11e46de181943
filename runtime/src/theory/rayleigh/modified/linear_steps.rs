//! Which steps have a modified linear system: by the derivative at states that tell.

use nalgebra::SVector;

use super::branch::require_principal;
use super::logarithm::eigenvalues;
use super::scaled::{assembled, require_finite, rescaled, scales, widened};
use crate::numbers::Scalar;
use crate::step::{Discretised, Flow, PhaseMatrix, State};
use crate::system::is_timed;
use crate::theory::rayleigh::asked::{Unasked, ask};
use crate::theory::rayleigh::modified::{ModifiedLinearSystem, ModifiedLinearSystemError};
use crate::theory::samples::at_segment;
use crate::theory::verdict::Tolerance;

/// Modified systems of linear steps.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// The modified system of a linear system by this method, from its derivative alone: of a rule, a
    /// composition or a splitting alike. See
    /// [`ModifiedLinearSystem`](crate::rayleigh::modified::ModifiedLinearSystem).
    ///
    /// The derivatives at the `states` have to be one matrix: that the system is linear, up to a constant
    /// force. The logarithm is the one that the step size leads to from 0; where that is not the principal
    /// one the step is refused.
    ///
    /// **States it needs.** Two that lie apart ([`samples`](crate::samples)). It is asked at 2n more, each
    /// of which differs from the first in one coordinate, towards another of the states given, or by its
    /// own size: states on a line do not speak for the others. Of a view the step has to be one and the
    /// same at as many times, a step each after the other.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Composition, Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn pair(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    ///     let potential = q[0] * q[0] + q[0] * q[1] + q[1] * q[1];
    ///     (0.5 * (v[0] * v[0] + v[1] * v[1] - potential), 0.5 * r * v[0] * v[0] + 0.1 * v[1] * v[1])
    /// }
    /// let pair = Pair { r: 0.5 };
    /// let states = [[0.3, -0.2], [0.1, 0.4]].map(|q| State { q: q.into(), p: vector![0.1, 0.0] });
    /// let six = pair.by(Composition::kahan_li_6(Midpoint), 0.5).modified_linear_system(&states)?;
    /// assert!(six.is_rayleigh() && six.is_dissipative());
    /// assert!((six.damping[(0, 0)] - 0.5).abs() < 1e-4);
    /// println!("{six}");
    /// # Ok::<(), dalembert::rayleigh::modified::ModifiedLinearSystemError>(())
    /// ```
    ///
    /// # Errors
    /// A [`ModifiedLinearSystemError`](crate::rayleigh::modified::ModifiedLinearSystemError) that says which
    /// hypothesis fails.
    pub fn modified_linear_system(
        &self,
        states: &[State<L::Scalar, N>],
    ) -> Result<ModifiedLinearSystem<N>, ModifiedLinearSystemError> {
        const { Self::require_unconstrained() };
        let failed = |(sample, error)| ModifiedLinearSystemError::Step { sample, error };
        let asked = ask(self, states)?;
        let [a, others @ ..] = asked.derivatives.as_slice() else {
            return Err(ModifiedLinearSystemError::TooFewStates);
        };
        if asked.different < 2 {
            return Err(ModifiedLinearSystemError::TooFewStates);
        }
        if !asked.moves {
            return Err(ModifiedLinearSystemError::AtRest);
        }
        let (first, wide) = (&states[0], widened(a));
        require_finite(&wide, 0)?;
        let s = scales(&wide, L::Scalar::EPSILON.widen()).map(f64::recip);
        let whole = |a: &PhaseMatrix<f64, N>| assembled(&rescaled(a, &s));
        let size = whole(&wide).amax();
        if is_timed(self.system) {
            self.require_one_step(first, asked.derivatives.len(), &s)?;
        }
        for (sample, other) in (1..).zip(others) {
            let other = widened(other);
            require_finite(&other, sample)?;
            let difference = (whole(&other) - whole(&wide)).amax() / size;
            if difference > Tolerance::rounding::<L::Scalar>() {
                return Err(ModifiedLinearSystemError::NotLinear { sample, difference });
            }
        }
        let derivative = |share: f64| {
            let by = self.with_step(self.step_size() * L::Scalar::constant(share));
            by.linearized_step(first).map(|(_, a)| a).map_err(|error| failed((0, error)))
        };
        let modified = ModifiedLinearSystem::of(a, self.step_size().widen(), None)?;
        require_principal(|share| eigenvalues(&whole(&widened(&derivative(share)?))))?;
        Ok(modified)
    }

    /// Fails where the step from the state, or its derivative, is another at one of the later times: springs,
    /// friction or a push that change. In the coordinates that `s` leads to.
    fn require_one_step(
        &self,
        state: &State<L::Scalar, N>,
        times: usize,
        s: &SVector<f64, N>,
    ) -> Result<(), ModifiedLinearSystemError> {
        let failed = |error| ModifiedLinearSystemError::Step { sample: 0, error };
        let at = |k: usize| -> Result<_, ModifiedLinearSystemError> {
            let taken = at_segment(self, k, |by| by.linearized_step(state)).map_err(Unasked::from)?;
            let (step, a) = taken.map_err(failed)?;
            let a = widened(&a);
            require_finite(&a, 0)?;
            let (q, p) = (step.state.q.map(Scalar::widen), step.state.p.map(Scalar::widen));
            Ok((assembled(&rescaled(&a, s)), (q.component_mul(s), p.component_div(s))))
        };
        let apart = |one: f64, size: f64| if one == 0.0 { 0.0 } else { one / size };
        let (a, (q, p)) = at(0)?;
        let start = state.q.map(Scalar::widen).component_mul(s).amax();
        let reach = [q.amax(), p.amax(), start].into_iter().fold(0.0, f64::max);
        for steps in 1..times {
            let (later, (later_q, later_p)) = at(steps)?;
            let moved = (later_q - q).amax().max((later_p - p).amax());
            let difference = apart((later - &a).amax(), a.amax()).max(apart(moved, reach));
            if difference > Tolerance::rounding::<L::Scalar>() {
                return Err(ModifiedLinearSystemError::Timed { steps, difference });
            }
        }
        Ok(())
    }
}
