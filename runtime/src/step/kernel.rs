//! The equation of a step and the momenta of a segment, as data.

use nalgebra::{SMatrix, SVector};

use crate::numbers::derivatives::linear;

/// The step's equation at a trial v̄ = (q1 − q0)/h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepKernel<S, const N: usize, M = SMatrix<S, N, N>> {
    /// The momentum −D1 L_d − f_d⁻ at q0, to be matched with the state's.
    pub p0: SVector<S, N>,
    /// Newton matrix ∂p0/∂v̄ = −h (D2 D1 L_d + D2 f_d⁻).
    pub matrix: M,
}

/// Both momenta of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momenta<S, const N: usize> {
    /// −D1 L_d − f_d⁻, at q0.
    pub p0: SVector<S, N>,
    /// D2 L_d + f_d⁺, at q1.
    pub p1: SVector<S, N>,
}

/// Derivatives of both momenta of a segment by M quantities other than its configurations, which are held
/// fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentaBy<S, const N: usize, const M: usize> {
    /// ∂p0/∂θ, shape N×M.
    pub p0: SMatrix<S, N, M>,
    /// ∂p1/∂θ, shape N×M.
    pub p1: SMatrix<S, N, M>,
}

linear!(StepKernel { p0, matrix });
linear!(Momenta { p0, p1 });
linear!(MomentaBy<M> { p0, p1 });
