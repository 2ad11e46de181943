//! The step size up to which R̃ is ≥ 0:
//! [`ModifiedSystem::largest_step`](crate::rayleigh::modified::ModifiedSystem::largest_step).

use nalgebra::SMatrix;

use crate::numbers::Scalar;
use crate::rules::modes;
use crate::theory::rayleigh::modified::ModifiedSystemError;
use crate::theory::verdict::Tolerance;

/// The largest h up to which C − (h²/12)(CM⁻¹V″ + V″M⁻¹C) is positive semidefinite.
pub(super) fn largest_step<S: Scalar, const N: usize>(
    mass: &SMatrix<S, N, N>,
    damping: &SMatrix<S, N, N>,
    hessian: &SMatrix<S, N, N>,
) -> Result<S, ModifiedSystemError> {
    if hessian.iter().any(|entry| !entry.is_finite()) {
        return Err(ModifiedSystemError::NonFinite);
    }
    let (_, w, c) = modes(mass, damping);
    let a = w * hessian * w.transpose();
    // What rounding makes of a 0.
    let roundings = S::constant(Tolerance::rounding::<S>());
    let (none, uncoupled) = (c.amax() * roundings, a.amax() * roundings);
    if c.iter().any(|&c| c < -none) {
        return Err(ModifiedSystemError::NotDissipative);
    }
    let has_friction = c.map(|c| c > none);
    let mut form = SMatrix::<S, N, N>::zeros();
    for i in 0..N {
        for j in 0..N {
            match (has_friction[i], has_friction[j]) {
                (true, true) => form[(i, j)] = a[(i, j)] * (c[i] + c[j]) / (c[i] * c[j]).sqrt(),
                (true, false) if a[(i, j)].abs() > uncoupled => return Ok(S::zero()),
                _ => {}
            }
        }
    }
    let (.., eigenvalues) = modes(&SMatrix::identity(), &form);
    // The largest of NaNs is none of them; what overflows says nothing.
    if eigenvalues.iter().any(|eigenvalue| !eigenvalue.is_finite()) {
        return Err(ModifiedSystemError::NonFinite);
    }
    let largest = eigenvalues.max();
    Ok(if largest > S::zero() { (S::constant(12.0) / largest).sqrt() } else { S::constant(f64::INFINITY) })
}
