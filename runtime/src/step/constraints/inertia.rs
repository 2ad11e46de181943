//! The mass matrix, made ready to solve with.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Factored, NewtonMatrix, Scalar};
use crate::step::cause::explained_by_lagrangian;
use crate::step::{StepError, require_regular};
use crate::system::Lagrangian;

/// The mass matrix ∂²L/∂v² at a point, made ready to solve with: in coordinates of the plane or of space it
/// is often diagonal.
pub(super) enum Inertia<S: Scalar, const N: usize> {
    Diagonal(SVector<S, N>),
    Full(<SMatrix<S, N, N> as NewtonMatrix<S, N>>::Factored),
}

impl<S: Scalar, const N: usize> Inertia<S, N> {
    /// Of the `mass` at (q, v).
    ///
    /// # Errors
    /// [`StepError::NonFinite`], [`StepError::DegenerateLagrangian`], [`StepError::SingularCoordinates`].
    pub(super) fn of<L: Lagrangian<N, Scalar = S>>(
        system: &L,
        q: &SVector<S, N>,
        v: &SVector<S, N>,
        mass: &SMatrix<S, N, N>,
    ) -> Result<Self, StepError> {
        if let Some(inverse) = inverse_of_diagonal(mass) {
            return Ok(Self::Diagonal(inverse));
        }
        match NewtonMatrix::factored(mass) {
            Some(factored) => Ok(Self::Full(factored)),
            None => {
                let error =
                    require_regular(mass).err().unwrap_or(StepError::DegenerateLagrangian { column: 0 });
                Err(explained_by_lagrangian(system, q, v, error))
            }
        }
    }

    /// At (q, v).
    ///
    /// # Errors
    /// Those of [`of`](Self::of).
    pub(super) fn at<L: Lagrangian<N, Scalar = S>>(
        system: &L,
        q: &SVector<S, N>,
        v: &SVector<S, N>,
    ) -> Result<Self, StepError> {
        Self::of(system, q, v, &system.lagrangian_derivatives(q, v).d22)
    }

    /// M⁻¹ `right`.
    pub(super) fn solve(&self, right: &SVector<S, N>) -> SVector<S, N> {
        match self {
            Self::Diagonal(inverse) => right.component_mul(inverse),
            Self::Full(factored) => factored.solve(right),
        }
    }
}

/// 1/Mᵢᵢ, if the matrix is diagonal and regular.
fn inverse_of_diagonal<S: Scalar, const N: usize>(mass: &SMatrix<S, N, N>) -> Option<SVector<S, N>> {
    let mut inverse: SVector<S, N> = nalgebra::zero();
    let mut beside = S::zero();
    for (j, (column, inverse)) in mass.data.0.iter().zip(inverse.as_mut_slice()).enumerate() {
        for (i, entry) in column.iter().enumerate() {
            if i == j {
                *inverse = S::one() / *entry;
            } else {
                beside += entry.abs();
            }
        }
    }
    let is_regular = inverse.as_slice().iter().all(|inverse| inverse.is_finite() && *inverse != S::zero());
    (beside == S::zero() && is_regular).then_some(inverse)
}
