//! Which of L, R and f has a derivative that does not exist, each function looked at by one of this module:
//! what [`Lagrangian::without_derivative`] is made of.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::system::{Force, Function, Lagrangian, NoDerivative, Rayleigh};

/// The derivative of L that is NaN or infinite at (q, v).
#[cold]
#[inline(never)]
#[must_use]
pub fn lagrangian<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<NoDerivative> {
    of(system, Function::Lagrangian, of_function(&system.lagrangian_derivatives(q, v)), q, v)
}

/// The derivative of R that is NaN or infinite at (q, v).
#[cold]
#[inline(never)]
#[must_use]
pub fn rayleigh<L: Rayleigh<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<NoDerivative> {
    of(system, Function::Rayleigh, of_function(&system.rayleigh_derivatives(q, v)), q, v)
}

/// The first component of f with a derivative that is NaN or infinite at (q, v).
#[cold]
#[inline(never)]
#[must_use]
pub fn force<L: Force<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<NoDerivative> {
    let (index, coordinate) = of_covector(&system.force_derivatives(q, v))?;
    of(system, Function::Force { index }, Some(coordinate), q, v)
}

fn of<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    function: Function,
    coordinate: Option<usize>,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<NoDerivative> {
    // At a point that is none no function is to blame.
    let is_point = is_finite(q) && is_finite(v);
    coordinate.filter(|_| is_point).map(|coordinate| NoDerivative {
        function,
        coordinate,
        place: system.place_without_derivative(function, q, v),
    })
}

/// The first coordinate that a derivative by it is not finite.
fn of_function<S: Scalar, const N: usize>(of: &Derivatives<S, N>) -> Option<usize> {
    let is_lost = |i: usize| {
        let rows = [&of.d11, &of.d12, &of.d22].into_iter().any(|block| !is_finite_row(block, i));
        let mut mixed = of.d12.column(i).into_iter();
        rows || !of.d1[i].is_finite() || !of.d2[i].is_finite() || mixed.any(|entry| !entry.is_finite())
    };
    (0..N).find(|&i| is_lost(i))
}

/// The first component with a value or a derivative that is not finite, and the coordinate of that.
fn of_covector<S: Scalar, const N: usize>(of: &CovectorDerivatives<S, N>) -> Option<(usize, usize)> {
    let is_lost = |i: usize, j: usize| !of.d1[(i, j)].is_finite() || !of.d2[(i, j)].is_finite();
    let coordinate = |i: usize| {
        let first = (0..N).find(|&j| is_lost(i, j));
        first.or(if of.value[i].is_finite() { None } else { Some(i) })
    };
    (0..N).find_map(|i| Some((i, coordinate(i)?)))
}

fn is_finite<S: Scalar, const N: usize>(of: &SVector<S, N>) -> bool {
    of.iter().all(|entry| entry.is_finite())
}

fn is_finite_row<S: Scalar, const N: usize>(block: &SMatrix<S, N, N>, row: usize) -> bool {
    (0..N).all(|column| block[(row, column)].is_finite())
}
