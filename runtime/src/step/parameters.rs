//! The step by parameters of the system.

use nalgebra::SVector;

use crate::step::discrete::explained_on;
use crate::step::{Discrete, MomentaBy, State, StateBy, StepError, StepWith};
use crate::system::Parameters;

/// Both momenta of a segment by the parameters, by rule `R`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no derivatives by parameters by `{R}`",
    label = "no parameters",
    note = "list the fields in the attribute: `#[rayleigh_system(parameters = [m, k])]`"
)]
pub trait DiscreteParameters<R, const N: usize, const P: usize>: Discrete<R, N> + Parameters<N, P> {
    /// ∂p0/∂θ and ∂p1/∂θ on the segment from q0 with mean velocity `v`.
    fn momenta_by_parameters(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> MomentaBy<Self::Scalar, N, P>;

    /// ∂(q1, p1)/∂θ on the segment (`q0`, `q1`), (q0, p0) held:
    /// [`Discretised::state_by_parameters`](crate::Discretised::state_by_parameters).
    ///
    /// # Errors
    /// Those of [`Discrete::linearization`].
    fn state_by_parameters(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<StateBy<Self::Scalar, N, P>, StepError> {
        let by_parameters = self.momenta_by_parameters(q0, &((q1 - q0) / h), h);
        self.legendre_derivatives(q0, q1, h)
            .answer(&by_parameters)
            .map_err(|error| explained_on(self, q0, &((q1 - q0) / h), h, error))
    }

    /// The step with ∂(q1, p1)/∂θ:
    /// [`Discretised::step_by_parameters`](crate::Discretised::step_by_parameters).
    ///
    /// # Errors
    /// Those of [`Flow::linearized_step`](crate::step::Flow::linearized_step).
    fn step_by_parameters(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
    ) -> Result<StepWith<Self::Scalar, N, StateBy<Self::Scalar, N, P>>, StepError> {
        let step = self.step(state, h, guess)?;
        Ok((step, self.state_by_parameters(&state.q, &step.state.q, h)?))
    }
}
