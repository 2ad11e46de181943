//! Which of L, R and f has a derivative that does not exist, each function looked at by one of this module:
//! what [`Lagrangian::without_derivative`] is made of; and which of the values beside q and v is no number:
//! [`Lagrangian::non_finite_value`].

use nalgebra::SVector;

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::system::{
    DryFriction, Force, Function, Lagrangian, NoDerivative, Plain, Quantity, Rayleigh, Slips,
    derivatives_apart,
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

/// The derivative that is NaN or infinite at (q, v) of R apart from its kinks, which are no fault; or of a
/// kink whose slip or limit is one.
#[cold]
#[inline(never)]
#[must_use]
pub fn dry_friction<L: DryFriction<N, M> + ?Sized, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<NoDerivative> {
    let smooth = of_function(&system.smooth_rayleigh_derivatives(q, v));
    of(system, Function::Rayleigh, smooth, q, v).or_else(|| {
        let coordinate = of_slips(&system.slips(q, v)).filter(|_| is_point(q, v))?;
        Some(NoDerivative { function: Function::Rayleigh, coordinate, place: None })
    })
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
    let coordinate = coordinate.filter(|_| is_point(q, v))?;
    Some(NoDerivative { function, coordinate, place: system.place_without_derivative(function, q, v) })
}

/// At a point that is none no function is to blame.
fn is_point<S: Scalar, const N: usize>(q: &SVector<S, N>, v: &SVector<S, N>) -> bool {
    S::are_finite(q.as_slice()) && S::are_finite(v.as_slice())
}

/// The first coordinate that moves an element of dry friction whose slip or limit is not finite.
fn of_slips<S: Scalar, const N: usize, const M: usize>(slips: &Slips<S, N, M>) -> Option<usize> {
    let Slips { values, by_velocity, by_configuration, limits } = slips;
    let impulses = (by_velocity + by_configuration).map(|entry| entry.abs()).transpose();
    let mut elements = impulses.column_iter().zip(values).zip(limits);
    elements.find_map(|((element, slip), limit)| {
        let is_lost = !(*slip * *limit).is_finite();
        let lost = element.iter().position(|entry| !entry.is_finite());
        lost.or_else(|| element.iter().position(|entry| is_lost && *entry > S::zero()))
    })
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
