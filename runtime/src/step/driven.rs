//! The step by its input. The input u ∈ ℝᴹ is held over a step, so that it enters a segment through f_d
//! alone:
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻(q0, q1, u),   p1 = D2 L_d + f_d⁺(q0, q1, u)
//! ```

use nalgebra::SVector;

use crate::step::discrete::explained_on;
use crate::step::{Discrete, Linearization, MomentaBy, State, StepError, StepWith};
use crate::system::Driven;

/// A system with its input held, discretised by rule `R`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no input with M = {M}, or is not discretised by `{R}`",
    label = "no input by `{R}`",
    note = "write `fn force(&self, q: [f64; {N}], v: [f64; {N}], u: [f64; {M}]) -> [f64; {N}]` in the `#[rayleigh_system]` block, list the rule in its attribute, and hold the input with `system.driven(u)`"
)]
pub trait DiscreteDriven<R, const N: usize, const M: usize>: Discrete<R, N> + Driven<N, M> {
    /// Both momenta by the input, on the segment from q0 with mean velocity `v`: −∂f_d⁻/∂u and ∂f_d⁺/∂u.
    fn momenta_by_input(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> MomentaBy<Self::Scalar, N, M>;

    /// The step's derivatives by state and input on the segment (`q0`, `q1`):
    /// [`Discretised::linearization_with_input`](crate::Discretised::linearization_with_input).
    ///
    /// # Errors
    /// Those of [`Discrete::linearization`].
    fn linearization_with_input(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<Linearization<Self::Scalar, N, M>, StepError> {
        let by_input = self.momenta_by_input(q0, &((q1 - q0) / h), h);
        Linearization::with_input(&self.legendre_derivatives(q0, q1, h), &by_input)
            .map_err(|error| explained_on(self, q0, &((q1 - q0) / h), h, error))
    }

    /// The step with its derivatives by state and input:
    /// [`Discretised::linearized_step_with_input`](crate::Discretised::linearized_step_with_input).
    ///
    /// # Errors
    /// Those of [`Flow::linearized_step`](crate::step::Flow::linearized_step).
    fn linearized_step_with_input(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
    ) -> Result<StepWith<Self::Scalar, N, Linearization<Self::Scalar, N, M>>, StepError> {
        let step = self.step(state, h, guess)?;
        Ok((step, self.linearization_with_input(&state.q, &step.state.q, h)?))
    }
}
