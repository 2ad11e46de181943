//! Systems with an input: the force's derivative by u, and that of the momenta.
//!
//! The input u ∈ ℝᴹ is held over a step, so that it enters a segment through f_d alone:
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻(q0, q1, u),   p1 = D2 L_d + f_d⁺(q0, q1, u)
//! ```

use nalgebra::{SMatrix, SVector};

use crate::numbers::derivatives::linear;
use crate::{Discrete, Force, Linearization, Scalar, State, StepError, StepWith};

/// What `system.driven(u)` takes for the input u ∈ ℝᴹ: `[S; M]`, or an `SVector<S, M>`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an input of this system: it takes an array `[{S}; {M}]`, or an `SVector<{S}, {M}>`",
    label = "not `[{S}; {M}]`"
)]
pub trait Input<S, const M: usize> {
    /// u₁ … u_M.
    fn entries(self) -> [S; M];
}

impl<S: Scalar, const M: usize> Input<S, M> for [S; M] {
    #[inline]
    fn entries(self) -> [S; M] {
        self
    }
}

impl<S: Scalar, const M: usize> Input<S, M> for SVector<S, M> {
    #[inline]
    fn entries(self) -> [S; M] {
        self.into()
    }
}

/// A system with its input u ∈ ℝᴹ held: the views that `#[rayleigh_system]` makes of systems with
/// `fn force(&self, q: [f64; N], v: [f64; N], u: [f64; M]) -> [f64; N]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no input with M = {M}",
    label = "no input",
    note = "write `fn force(&self, q: [f64; {N}], v: [f64; {N}], u: [f64; {M}]) -> [f64; {N}]` in the `#[rayleigh_system]` block, and hold the input with `system.driven(u)`"
)]
pub trait Driven<const N: usize, const M: usize>: Force<N> {
    /// ∂f/∂u at (q, v) and the input held, shape N×M: entry (i, j) is ∂fᵢ/∂uⱼ.
    fn force_by_input(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> SMatrix<Self::Scalar, N, M>;
}

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

    /// The step's derivatives by state and input on the segment (`q0`, `q1`): [`Discretised::linearization_with_input`](crate::Discretised::linearization_with_input).
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
    }

    /// The step with its derivatives by state and input: [`Discretised::linearized_step_with_input`](crate::Discretised::linearized_step_with_input).
    ///
    /// # Errors
    /// Those of [`Discrete::linearized_step`].
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

/// Derivatives of both momenta of a segment by M quantities other than its configurations, which are held fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentaBy<S, const N: usize, const M: usize> {
    /// ∂p0/∂θ, shape N×M.
    pub p0: SMatrix<S, N, M>,
    /// ∂p1/∂θ, shape N×M.
    pub p1: SMatrix<S, N, M>,
}

linear!(MomentaBy<M> { p0, p1 });
