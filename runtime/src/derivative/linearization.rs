//! The step's derivative by the state that it starts from.

use nalgebra::SVector;

use crate::step::{Discrete, Discretised, Flow, Linearization, State, StepError, StepWith};

/// Derivatives by the state.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// The step with its derivative A = ∂(q1, p1)/∂(q0, p0).
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64) -> f64 {
    ///     0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    /// }
    /// let state = State { q: vector![0.3], p: vector![-0.2] };
    /// let (step, linearization) = Oscillator { m: 1.0, k: 1.0 }.by(Gauss::<4>, 0.5).linearized_step(&state)?;
    /// // The rotation by the angle h, to order 8.
    /// let a = linearization.a;
    /// assert!((a.q_by_q[0] - 0.5_f64.cos()).abs() < 1e-9 && (a.q_by_p[0] - 0.5_f64.sin()).abs() < 1e-9);
    /// assert!((step.state.q[0] - (a.q_by_q[0] * 0.3 - a.q_by_p[0] * 0.2)).abs() < 1e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`step`](Self::step); [`StepError::SingularNewtonMatrix`] where the step has no derivative.
    pub fn linearized_step(
        &self,
        state: &State<L::Scalar, N>,
    ) -> Result<StepWith<L::Scalar, N, Linearization<L::Scalar, N>>, StepError> {
        self.system.linearized_step(state, self.h, self.guess.as_ref())
    }
}

/// Derivatives on a segment.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// A of the step that leads from q0 to q1.
    ///
    /// By [`Gauss`](crate::Gauss) [`linearized_step`](Self::linearized_step) costs less: this solves for the
    /// stages anew, and two ends need not determine a segment.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    ///     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let (m, k, r, h) = (1.0, 1.0, 0.5, 0.25);
    /// let a = Oscillator { m, k, r }.by(Midpoint, h).linearization(&vector![0.0], &vector![0.2])?.a;
    /// let determinant = (4.0 * m + h * h * k - 2.0 * h * r) / (4.0 * m + h * h * k + 2.0 * h * r);
    /// assert!((a.assembled::<2>().determinant() - determinant).abs() < 1e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] if ∂p0/∂q1 is singular: there the step has no derivative.
    pub fn linearization(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<Linearization<L::Scalar, N>, StepError> {
        self.system.linearization(q0, q1, self.h)
    }
}
