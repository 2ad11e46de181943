//! Slices as vectors, and vectors as slices.

use nalgebra::SVector;

use crate::numbers::Scalar;

/// A slice as the vector that it is: of N entries, known to the compiler, which then copies them at once.
pub(crate) fn vector<S: Scalar, const N: usize>(slice: &[S]) -> SVector<S, N> {
    <&[S; N]>::try_from(slice).map_or_else(|_| nalgebra::zero(), |entries| SVector::from(*entries))
}

/// Writes a vector to a slice of N entries.
pub(crate) fn write<S: Scalar, const N: usize>(to: &mut [S], from: &SVector<S, N>) {
    if let Ok(to) = <&mut [S; N]>::try_from(to) {
        *to = (*from).into();
    }
}
