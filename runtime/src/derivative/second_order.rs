//! The step's second derivatives.

use nalgebra::SVector;

use crate::step::{Discrete, DiscreteSecondOrder, Discretised, State, StepError, StepHessian, StepWith};

/// Second derivatives of the step, contracted with a covector (`step_derivatives = second`): by the input as
/// well where the system holds one.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The step with the second derivatives of `covector`.q·q1 + `covector`.p·p1.
    ///
    /// # Errors
    /// Those of [`linearized_step`](Self::linearized_step).
    pub fn step_with_hessian<const M: usize>(
        &self,
        state: &State<L::Scalar, N>,
        covector: &State<L::Scalar, N>,
    ) -> Result<StepWith<L::Scalar, N, StepHessian<L::Scalar, N, M>>, StepError>
    where
        L: DiscreteSecondOrder<R, N, M>,
    {
        self.system.step_with_hessian(state, self.h, self.guess.as_ref(), covector)
    }

    /// Second derivatives of `covector`.q·q1 + `covector`.p·p1 for the step that leads from q0 to q1.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system(step_derivatives = second)]
    /// fn quartic(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.25 * q[0].powi(4)
    /// }
    /// let covector = State { q: vector![0.0], p: vector![1.0] };
    /// let hessian = Quartic {}.by(Midpoint, 0.1).step_hessian(&vector![1.0], &vector![1.0], &covector)?;
    /// assert!(hessian.qq[0] < 0.0); // the restoring force grows faster than linearly
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linearization`](Self::linearization).
    pub fn step_hessian<const M: usize>(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        covector: &State<L::Scalar, N>,
    ) -> Result<StepHessian<L::Scalar, N, M>, StepError>
    where
        L: DiscreteSecondOrder<R, N, M>,
    {
        self.system.step_hessian(q0, q1, self.h, covector)
    }
}
