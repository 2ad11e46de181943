//! The step by its input and by parameters. The input u ∈ ℝᴹ is held over a step, so that it enters a
//! segment through f_d alone:
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻(q0, q1, u),   p1 = D2 L_d + f_d⁺(q0, q1, u)
//! ```

use crate::step::{Linearizable, StateBy, StepError};
use crate::system::{Driven, Parameters};

/// A system with its input held, discretised by rule `R`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no input with M = {M}, or is not discretised by `{R}`",
    label = "no input by `{R}`",
    note = "write `fn force(&self, q: [f64; {N}], v: [f64; {N}], u: [f64; {M}]) -> [f64; {N}]` in the `#[rayleigh_system]` block, list the rule in its attribute, and hold the input with `system.driven(u)`"
)]
pub trait DiscreteDriven<R, const N: usize, const M: usize>: Linearizable<R, N> + Driven<N, M> {
    /// B = ∂(q1, p1)/∂u, the input being held over the step.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_input(at: &Self::Linearized<'_>) -> Result<StateBy<Self::Scalar, N, M>, StepError>;
}

/// A system with parameters, discretised by rule `R`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no derivatives by parameters by `{R}`",
    label = "no parameters",
    note = "list the fields in the attribute: `#[rayleigh_system(parameters = [m, k])]`"
)]
pub trait DiscreteParameters<R, const N: usize, const P: usize>:
    Linearizable<R, N> + Parameters<N, P>
{
    /// ∂(q1, p1)/∂θ, (q0, p0) held.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_parameters(at: &Self::Linearized<'_>) -> Result<StateBy<Self::Scalar, N, P>, StepError>;
}
