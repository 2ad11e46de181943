//! Derivatives as generated against differences, along directions with a part in every coordinate and
//! velocity.
//!
//! The comparison is compiled once ([`comparison`](crate::numbers::comparison)), its adapters to slices once
//! for each size of a system; a system has its functions alone.

use nalgebra::SVector;

use crate::numbers::comparison::{SLOPES, Sides};
use crate::numbers::nonlinear::Room;
use crate::numbers::slices::{vector, write};
use crate::numbers::{CovectorDerivatives, Derivatives, Gradient, Scalar};
use crate::system::{Compared, Force, Function, GeneratedDiffers, Lagrangian, Rayleigh};

/// A function of (q, v).
type Of<'a, S, const N: usize, T> = &'a dyn Fn(&SVector<S, N>, &SVector<S, N>) -> T;

/// A point (q, v).
type Point<'a, S, const N: usize> = [&'a SVector<S, N>; 2];

/// The slope of `written` from its `partials`, held against its differences.
#[cold]
#[inline(never)]
fn hold<S: Scalar, const N: usize>(
    function: Function,
    compared: Compared,
    [q, v]: Point<'_, S, N>,
    partials: Of<'_, S, N, [SVector<S, N>; 2]>,
    written: Of<'_, S, N, S>,
) -> Result<(), GeneratedDiffers> {
    let sides = Sides {
        written: &|q, v| written(&vector(q), &vector(v)),
        partials: &|q, v, d1, d2| {
            let [by_q, by_v] = partials(&vector(q), &vector(v));
            write(d1, &by_q);
            write(d2, &by_v);
        },
    };
    let mut buffer = [[S::constant(0.0); N]; SLOPES];
    let room = Room::new(buffer.as_flattened_mut(), N);
    match S::slopes_apart(q.as_slice(), v.as_slice(), &sides, room) {
        None => Ok(()),
        Some([generated, written]) => Err(GeneratedDiffers { function, compared, generated, written }),
    }
}

/// The gradient of a function held against its differences; also its second `derivatives`, along another
/// direction against differences of the gradient, and the first that come with them.
#[cold]
#[inline(never)]
fn hold_function<S: Scalar, const N: usize>(
    function: Function,
    at: Point<'_, S, N>,
    written: Of<'_, S, N, S>,
    gradient: Of<'_, S, N, Gradient<S, N>>,
    derivatives: Option<Of<'_, S, N, Derivatives<S, N>>>,
) -> Result<(), GeneratedDiffers> {
    let first = |q: &_, v: &_| {
        let of = gradient(q, v);
        [of.d1, of.d2]
    };
    hold(function, Compared::Derivative, at, &first, written)?;
    let Some(derivatives) = derivatives.filter(|_| cfg!(debug_assertions)) else {
        return Ok(());
    };
    let beside_second = |q: &_, v: &_| {
        let of = derivatives(q, v);
        [of.d1, of.d2]
    };
    hold(function, Compared::Derivative, at, &beside_second, written)?;
    let (mut a, mut b) = (SVector::<S, N>::zeros(), SVector::<S, N>::zeros());
    S::other_direction(at[0].as_slice(), at[1].as_slice(), a.as_mut_slice(), b.as_mut_slice());
    let second = |q: &_, v: &_| {
        let of = derivatives(q, v);
        let (mut by_q, mut by_v) = (SVector::zeros(), SVector::zeros());
        for i in 0..N {
            for j in 0..N {
                by_q[i] += of.d11[(i, j)] * a[j] + of.d12[(i, j)] * b[j];
                by_v[i] += of.d12[(j, i)] * a[j] + of.d22[(i, j)] * b[j];
            }
        }
        [by_q, by_v]
    };
    hold(function, Compared::SecondDerivative, at, &second, &|q, v| {
        let of = gradient(q, v);
        let mut along = S::constant(0.0);
        for i in 0..N {
            along += of.d1[i] * a[i] + of.d2[i] * b[i];
        }
        along
    })
}

/// ∂L/∂q and ∂L/∂v as generated against differences of L as written, along one direction; with
/// `debug_assertions` the second derivatives against those of the first.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn lagrangian_slope<L: Lagrangian<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    let second = |q: &_, v: &_| system.lagrangian_derivatives(q, v);
    hold_function(
        Function::Lagrangian,
        [q, v],
        &|q, v| system.lagrangian(q, v),
        &|q, v| system.lagrangian_gradient(q, v),
        // No program carries what it does not ask for.
        if cfg!(debug_assertions) { Some(&second) } else { None },
    )
}

/// ∂R/∂q and ∂R/∂v as generated against differences of R as written, along one direction; with
/// `debug_assertions` the second derivatives against those of the first.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn rayleigh_slope<L: Rayleigh<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    let second = |q: &_, v: &_| system.rayleigh_derivatives(q, v);
    hold_function(
        Function::Rayleigh,
        [q, v],
        &|q, v| system.rayleigh(q, v),
        &|q, v| system.rayleigh_gradient(q, v),
        if cfg!(debug_assertions) { Some(&second) } else { None },
    )
}

/// ∂f/∂q and ∂f/∂v as generated against differences of f as written: a sum of all components along one
/// direction, and where it differs, each one.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn force_slope<L: Force<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    hold_force([q, v], &|q, v| system.force(q, v), &|q, v| system.force_derivatives(q, v))
}

#[cold]
#[inline(never)]
fn hold_force<S: Scalar, const N: usize>(
    at: Point<'_, S, N>,
    written: Of<'_, S, N, SVector<S, N>>,
    derivatives: Of<'_, S, N, CovectorDerivatives<S, N>>,
) -> Result<(), GeneratedDiffers> {
    let along = |shares: &SVector<S, N>, index| {
        let partials = |q: &_, v: &_| {
            let of = derivatives(q, v);
            let (mut d1, mut d2) = (SVector::zeros(), SVector::zeros());
            for i in 0..N {
                for j in 0..N {
                    d1[i] += shares[j] * of.d1[(j, i)];
                    d2[i] += shares[j] * of.d2[(j, i)];
                }
            }
            [d1, d2]
        };
        hold(Function::Force { index }, Compared::Derivative, at, &partials, &|q, v| {
            let f = written(q, v);
            let mut sum = S::constant(0.0);
            for j in 0..N {
                sum += shares[j] * f[j];
            }
            sum
        })
    };
    let mut shares = SVector::<S, N>::zeros();
    S::shares(shares.as_mut_slice());
    let sum = along(&shares, 0);
    if sum.is_ok() {
        return sum;
    }
    for index in 0..N {
        let mut one = SVector::zeros();
        one[index] = S::constant(1.0);
        along(&one, index)?;
    }
    sum
}
