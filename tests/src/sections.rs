//! Sections of the cotangent bundle that several claims use.

use dalembert::hamilton_jacobi::Section;
use dalembert::nalgebra::{SMatrix, SVector, vector};

/// γ(q) = c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f64);

impl Section<1> for Constant {
    type Scalar = f64;

    fn covector(&self, _q: &SVector<f64, 1>) -> SVector<f64, 1> {
        vector![self.0]
    }

    fn jacobian(&self, _q: &SVector<f64, 1>) -> SMatrix<f64, 1, 1> {
        SMatrix::zeros()
    }
}
