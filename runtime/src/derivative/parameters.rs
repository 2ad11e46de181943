//! Derivatives by parameters of a system: masses, lengths, friction coefficients.

use nalgebra::{SMatrix, SVector};

use crate::numbers::derivatives::linear;
use crate::{Direction, Discrete, Lagrangian, MomentaBy, Scalar, State, StateBy, StepError, StepWith};

/// Derivatives of ∂F/∂q and ∂F/∂v by P parameters, F being L or R.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientBy<S, const N: usize, const P: usize> {
    /// ∂²F/∂q∂θ, shape N×P.
    pub d1: SMatrix<S, N, P>,
    /// ∂²F/∂v∂θ, shape N×P.
    pub d2: SMatrix<S, N, P>,
}

linear!(GradientBy<P> { d1, d2 });

impl<S: Scalar, const N: usize, const P: usize> GradientBy<S, N, P> {
    /// Derivative along `direction`: entry (i, j) is first·∂²F/∂qᵢ∂θⱼ + second·∂²F/∂vᵢ∂θⱼ.
    #[inline]
    #[must_use]
    pub fn along(&self, direction: Direction<S>) -> SMatrix<S, N, P> {
        self.d1 * direction.first + self.d2 * direction.second
    }
}

/// L, R and f by the P parameters that `#[rayleigh_system(parameters = [m, c[0]])]` lists, in that order.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no derivatives by parameters",
    label = "no parameters",
    note = "list the fields in the attribute: `#[rayleigh_system(parameters = [m, k])]`"
)]
pub trait Parameters<const N: usize, const P: usize>: Lagrangian<N> {
    /// The parameters, as listed.
    const PARAMETERS: [&'static str; P];

    /// ∂²L/∂q∂θ and ∂²L/∂v∂θ at (q, v).
    fn lagrangian_by_parameters(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> GradientBy<Self::Scalar, N, P>;

    /// ∂²R/∂q∂θ and ∂²R/∂v∂θ at (q, v); 0 where there is no R.
    #[inline]
    fn rayleigh_by_parameters(
        &self,
        _q: &SVector<Self::Scalar, N>,
        _v: &SVector<Self::Scalar, N>,
    ) -> GradientBy<Self::Scalar, N, P> {
        GradientBy::zero()
    }

    /// ∂f/∂θ at (q, v), shape N×P; 0 where there is no f.
    #[inline]
    fn force_by_parameters(
        &self,
        _q: &SVector<Self::Scalar, N>,
        _v: &SVector<Self::Scalar, N>,
    ) -> SMatrix<Self::Scalar, N, P> {
        SMatrix::zeros()
    }
}

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

    /// ∂(q1, p1)/∂θ on the segment (`q0`, `q1`), (q0, p0) held: [`Discretised::state_by_parameters`](crate::Discretised::state_by_parameters).
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
        self.legendre_derivatives(q0, q1, h).answer(&by_parameters)
    }

    /// The step with ∂(q1, p1)/∂θ: [`Discretised::step_by_parameters`](crate::Discretised::step_by_parameters).
    ///
    /// # Errors
    /// Those of [`Discrete::linearized_step`].
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
