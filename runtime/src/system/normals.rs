//! The normals of the constraints at a point, and the way back to them.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;

/// The normals of N = g⁻¹(0) at a point q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normals<S, const N: usize> {
    /// ν, an orthonormal basis of the span of the ∂gₖ/∂q: as many of its first columns, and 0 in the others.
    ///
    /// 1 − ννᵀ projects onto the tangent space of N.
    pub frame: SMatrix<S, N, N>,
    /// The least δ with ∂g/∂q·δ = g: q − δ is on N to first order.
    pub offset: SVector<S, N>,
}

/// Roundings of a gradient within which it depends on those before it.
const ROUNDINGS: f64 = 1024.0;

impl<S: Scalar, const N: usize> Normals<S, N> {
    /// The normals by these gradients and values, by Gram and Schmidt, twice: a gradient that depends on
    /// those before it adds none.
    pub(super) fn of(constraints: impl Iterator<Item = (SVector<S, N>, S)>) -> Self {
        let mut found = Self { frame: nalgebra::zero(), offset: nalgebra::zero() };
        let mut rank = 0;
        for (gradient, value) in constraints {
            found.add(&mut rank, &gradient, value);
        }
        found
    }

    /// Adds the normal of a constraint of this gradient and value.
    fn add(&mut self, rank: &mut usize, gradient: &SVector<S, N>, value: S) {
        // In its own unit, so that no square overflows.
        let unit = gradient.amax();
        let gradient = gradient / unit;
        let size = gradient.norm_squared().sqrt();
        let mut normal = gradient;
        for _ in 0..2 {
            normal -= self.frame * self.frame.tr_mul(&normal);
        }
        let beside = normal.norm_squared().sqrt();
        // A NaN adds none: values that are not finite are errors of their own.
        if beside > size * S::EPSILON * S::constant(ROUNDINGS)
            && let Some(column) = self.frame.data.0.get_mut(*rank)
        {
            normal /= beside;
            *column = normal.into();
            *rank += 1;
            let left = value / unit - gradient.dot(&self.offset);
            self.offset += normal * (left / gradient.dot(&normal));
        }
    }
}
