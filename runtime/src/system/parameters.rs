//! Parameters of a system, such as masses, lengths, friction coefficients: L, R and f by them.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Direction, Scalar, derivatives::linear};
use crate::system::Lagrangian;

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

    /// ∂²R/∂q∂θ and ∂²R/∂v∂θ at (q, v), of R without its kinks where the rule takes these apart; 0 where
    /// there is no R.
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
