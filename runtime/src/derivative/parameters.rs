//! The step's derivative by parameters of the system.

use nalgebra::SVector;

use crate::step::{Discrete, DiscreteParameters, Discretised, State, StateBy, StepError, StepWith};

/// Derivatives by the fields that `#[rayleigh_system(parameters = […])]` lists.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The step with ∂(q1, p1)/∂θ.
    ///
    /// # Errors
    /// Those of [`linearized_step`](Self::linearized_step).
    pub fn step_by_parameters<const P: usize>(
        &self,
        state: &State<L::Scalar, N>,
    ) -> Result<StepWith<L::Scalar, N, StateBy<L::Scalar, N, P>>, StepError>
    where
        L: DiscreteParameters<R, N, P>,
    {
        self.system.step_by_parameters(state, self.h, self.guess.as_ref())
    }

    /// ∂(q1, p1)/∂θ of the step that leads from q0 to q1, (q0, p0) held.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, rayleigh_system};
    ///
    /// #[rayleigh_system(parameters = [r])]
    /// fn drag(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    ///     let _ = q;
    ///     (0.5 * m * v[0] * v[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let (m, r, h) = (2.0, 0.5, 0.1);
    /// // From p0 the step goes to q1 = q0 + h p0/(m + hr/2).
    /// let p0 = 1.0;
    /// let q1 = h * p0 / (m + h * r / 2.0);
    /// let by_r = Drag { m, r }.by(Midpoint, h).state_by_parameters(&vector![0.0], &vector![q1])?;
    /// assert!((by_r.q[0] + h * h / 2.0 * p0 / (m + h * r / 2.0).powi(2)).abs() < 1e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linearization`](Self::linearization).
    pub fn state_by_parameters<const P: usize>(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError>
    where
        L: DiscreteParameters<R, N, P>,
    {
        self.system.state_by_parameters(q0, q1, self.h)
    }
}
