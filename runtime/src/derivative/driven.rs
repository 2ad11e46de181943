//! The step's derivative by the input.

use nalgebra::SVector;

use crate::step::{Discrete, DiscreteDriven, Discretised, Linearization, State, StepError, StepWith};

/// Derivatives by the input of a system that holds one, `system.driven(u)`.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The step with its derivatives A by the state and B = ∂(q1, p1)/∂u by the input, which is held over the
    /// step.
    ///
    /// # Errors
    /// Those of [`linearized_step`](Self::linearized_step).
    pub fn linearized_step_with_input<const M: usize>(
        &self,
        state: &State<L::Scalar, N>,
    ) -> Result<StepWith<L::Scalar, N, Linearization<L::Scalar, N, M>>, StepError>
    where
        L: DiscreteDriven<R, N, M>,
    {
        self.system.linearized_step_with_input(state, self.h, self.guess.as_ref())
    }

    /// A and B of the step that leads from q0 to q1: (q1, p1) ≈ … + A (q0, p0) + B u.
    ///
    /// ```
    /// use dalembert::derivative::Linearization;
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// struct Cart {
    ///     m: f64,
    /// }
    ///
    /// #[rayleigh_system]
    /// impl Cart {
    ///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * self.m * v[0] * v[0]
    ///     }
    ///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
    ///         u
    ///     }
    /// }
    /// let (m, h) = (2.0, 0.1);
    /// let cart = Cart { m };
    /// let state = State::from_velocity(&cart, [0.0], [0.5])?;
    /// let driven = cart.driven([0.3]);
    /// let by = driven.by(Midpoint, h);
    /// let end = by.step(&state)?.state;
    /// let Linearization { a, b, .. } = by.linearization_with_input(&state.q, &end.q)?;
    /// assert!((a.q_by_p[0] - h / m).abs() < 1e-16);
    /// assert!((b.q[0] - h * h / (2.0 * m)).abs() < 1e-16 && (b.p[0] - h).abs() < 1e-16);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linearization`](Self::linearization).
    pub fn linearization_with_input<const M: usize>(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<Linearization<L::Scalar, N, M>, StepError>
    where
        L: DiscreteDriven<R, N, M>,
    {
        self.system.linearization_with_input(q0, q1, self.h)
    }
}
