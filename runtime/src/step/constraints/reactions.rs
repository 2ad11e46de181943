//! The reactions of constraints over a step.

use nalgebra::SVector;

use super::Constraints;
use super::equation::OnConstraints;
use super::nearest::dependence;
use crate::numbers::Scalar;
use crate::step::{
    ClosedForm, Discrete, Discretised, Fused, Segment, State, Step, StepError, require_step_size,
};
use crate::system::Constrained;

/// Reactions of constraints.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: ClosedForm<R, N> + Discrete<R, N>,
{
    /// The multipliers λ of the `step` from `state`: the constraints act by the force Gᵀλ at q0, with ∂gₖ/∂q
    /// or ∂ψₖ/∂v for the rows of G, so that λₖ is in N or N m where gₖ is a length or an angle. It is
    /// positive where the force pushes towards greater gₖ.
    ///
    /// (h/2)Gᵀλ is what p0 lacks to be −D1 L_d − f_d⁻, the impulse of the first half of the step: λ is that
    /// of the motion at q0, to first order in h. Of redundant
    /// constraints it is the one of least Σ Sₖₖλₖ², with S = G(q1) W⁻¹ G(q0)ᵀ and W = ∂p0/∂v̄: by that norm
    /// the unit of a constraint changes none of the forces that it and others share.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// struct Pendulum;
    ///
    /// #[rayleigh_system]
    /// impl Pendulum {
    ///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
    ///         0.5 * (v[0] * v[0] + v[1] * v[1]) - 9.81 * q[1]
    ///     }
    ///     fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
    ///         [(q[0] * q[0] + q[1] * q[1]).sqrt() - 1.0]
    ///     }
    /// }
    ///
    /// let by = Pendulum.by(Midpoint, 0.01);
    /// let hanging = State::from_velocity(&Pendulum, [0.0, -1.0], [0.0, 0.0])?;
    /// let tension = by.reactions(&hanging, &by.step(&hanging)?)?;
    /// assert!((tension[0] + 9.81).abs() < 1e-12); // towards smaller lengths
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::OtherStep`] where the step was not taken from `state` by this step size,
    /// [`StepError::DependentConstraints`] where the constraints do not determine λ,
    /// [`StepError::OffConstraint`] of a state that is off one.
    pub fn reactions<const M: usize>(
        &self,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
    ) -> Result<SVector<L::Scalar, M>, StepError>
    where
        L: Constrained<N, M> + Fused<R, N, Border = Constraints<M>>,
    {
        require_step_size(self.h)?;
        let segment = Segment { q0: state.q, v: step.velocity, h: self.h };
        if let Some(taken) = taken_otherwise(&segment, &step.state.q) {
            return Err(StepError::OtherStep { h: self.h.widen(), taken: taken.widen() });
        }
        let kappa = OnConstraints::<L, R, N, M>::new(self.system, state)?.multipliers(&segment);
        let kappa = kappa.ok_or_else(|| dependence::<L, N, M>(self.system, &state.q))?;
        Ok(kappa * (L::Scalar::constant(2.0) / self.h))
    }
}

/// Roundings of the terms of q0 + h v̄ within which q1 is the end: where a step is read back, v̄ may be
/// (q1 − q0)/h.
const ROUNDINGS: f64 = 4.0;

/// The step size by which v̄ leads from q0 to `q1` in the coordinate that is farthest off, where rounding
/// does not explain that `q1` is another end than that of the segment.
fn taken_otherwise<S: Scalar, const N: usize>(segment: &Segment<S, N>, q1: &SVector<S, N>) -> Option<S> {
    let Segment { q0, v, h } = segment;
    let (mut farthest, mut taken) = (S::zero(), None);
    for ((q0, q1), v) in q0.as_slice().iter().zip(q1.as_slice()).zip(v.as_slice()) {
        let (way, off) = (*v * *h, (*q1 - (*q0 + *v * *h)).abs());
        let most = (q0.abs() + way.abs()) * (S::EPSILON * S::constant(ROUNDINGS));
        if off > most && off > farthest {
            (farthest, taken) = (off, Some((*q1 - *q0) / *v));
        }
    }
    taken
}
