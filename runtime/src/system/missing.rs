//! Which of L, R and f has a derivative that does not exist, each function looked at by one of this module:
//! what [`Lagrangian::without_derivative`] is made of; and which of the values beside q and v is no number:
//! [`Lagrangian::non_finite_value`].

use nalgebra::SVector;

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar, comparison::Compares as _};
use crate::system::{
    Force, Function, Lagrangian, NoDerivative, Plain, Quantity, Rayleigh, derivatives_apart,
};

/// The derivative of L that is NaN or infinite at (q, v).
#[cold]
#[inline(never)]
#[must_use]
pub fn lagrangian<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<NoDerivative> {
    of(system, Function::Lagrangian, of_function(&derivatives_apart(system, q, v)), q, v)
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

/// The first entry of an input that is NaN or infinite.
#[cold]
#[inline(never)]
#[must_use]
pub fn input<S: Scalar>(u: &[S]) -> Option<(Quantity, usize)> {
    u.iter().position(|entry| !entry.is_finite()).map(|index| (Quantity::InputEntry, index))
}

/// A time that is NaN or infinite.
#[cold]
#[inline(never)]
#[must_use]
pub fn time<S: Scalar>(t: S) -> Option<(Quantity, usize)> {
    (!t.is_finite()).then_some((Quantity::Time, 0))
}

/// The first of these fields that is NaN, with their names.
#[cold]
#[inline(never)]
#[must_use]
pub fn field<S>(fields: &[(&'static str, &dyn Plain<S>)]) -> Option<(Quantity, usize)> {
    fields.iter().find_map(|(name, value)| value.is_no_number().then_some((Quantity::Field { name }, 0)))
}

fn of<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    function: Function,
    coordinate: Option<usize>,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<NoDerivative> {
    let coordinate = coordinate?;
    // At a point that is none no function is to blame.
    if !L::Scalar::are_finite(q.as_slice()) || !L::Scalar::are_finite(v.as_slice()) {
        return None;
    }
    Some(NoDerivative { function, coordinate, place: system.place_without_derivative(function, q, v) })
}

/// The first coordinate that a derivative by it is not finite.
fn of_function<S: Scalar, const N: usize>(of: &Derivatives<S, N>) -> Option<usize> {
    S::coordinate_lost(
        [of.d1.as_slice(), of.d2.as_slice()],
        [of.d11.as_slice(), of.d12.as_slice(), of.d22.as_slice()],
    )
}

/// The first component with a value or a derivative that is not finite, and the coordinate of that.
fn of_covector<S: Scalar, const N: usize>(of: &CovectorDerivatives<S, N>) -> Option<(usize, usize)> {
    S::component_lost(of.value.as_slice(), [of.d1.as_slice(), of.d2.as_slice()])
}
