//! Derivatives as generated against differences, along directions with a part in every coordinate and
//! velocity.

use nalgebra::SVector;

use super::{sizes, slope};
use crate::numbers::{Derivatives, Gradient, Scalar};
use crate::system::{Compared, Force, Function, GeneratedDiffers, Lagrangian, Rayleigh};

/// A direction in (q, v), with a part in every one: a third to two thirds of its size.
fn direction<S: Scalar, const N: usize>(point: &SVector<S, N>, phase: usize) -> SVector<S, N> {
    let mut direction = sizes(point);
    for i in 0..N {
        let share = 1.0 / 3.0 + ((i + phase) * 7 % 11) as f64 / 33.0;
        let sign = if (i + phase) % 3 == 1 { -1.0 } else { 1.0 };
        direction[i] *= S::constant(sign * share);
    }
    direction
}

/// The slope of `written` from its partial derivatives `d1` and `d2`, held against its differences along the
/// [`direction`] of (q, v).
fn hold<S: Scalar, const N: usize>(
    function: Function,
    compared: Compared,
    [q, v]: [&SVector<S, N>; 2],
    [d1, d2]: [&SVector<S, N>; 2],
    written: &dyn Fn(&SVector<S, N>, &SVector<S, N>) -> S,
) -> Result<(), GeneratedDiffers> {
    let epsilon = S::EPSILON.widen();
    let largest = slope::largest(epsilon);
    if !q.iter().chain(v.iter()).all(|x| x.widen().abs() <= largest) {
        return Ok(());
    }
    let (a, b) = (direction(q, 0), direction(v, 5));
    let (mut slope, mut size) = (0.0, 0.0);
    for i in 0..N {
        let [d1, d2] = [d1[i].widen(), d2[i].widen()];
        slope += d1 * a[i].widen() + d2 * b[i].widen();
        size += (d1 * q[i].widen()).abs() + (d2 * v[i].widen()).abs();
    }
    let mut along = |s: f64| {
        let (mut moved_q, mut moved_v) = (*q, *v);
        for i in 0..N {
            moved_q[i] += a[i] * S::constant(s);
            moved_v[i] += b[i] * S::constant(s);
        }
        written(&moved_q, &moved_v).widen()
    };
    match slope::refuted(slope, epsilon, size, &mut along) {
        None => Ok(()),
        Some(written) => Err(GeneratedDiffers { function, compared, generated: slope, written }),
    }
}

/// The gradient of a function held against its differences; with `debug_assertions` also its second
/// derivatives, along another direction against differences of the gradient, and the first that come with
/// them.
fn hold_function<S: Scalar, const N: usize>(
    function: Function,
    at: [&SVector<S, N>; 2],
    written: impl Fn(&SVector<S, N>, &SVector<S, N>) -> S,
    gradient: impl Fn(&SVector<S, N>, &SVector<S, N>) -> Gradient<S, N>,
    derivatives: impl FnOnce() -> Derivatives<S, N>,
) -> Result<(), GeneratedDiffers> {
    let [q, v] = at;
    let of = gradient(q, v);
    hold(function, Compared::Derivative, at, [&of.d1, &of.d2], &written)?;
    if !cfg!(debug_assertions) {
        return Ok(());
    }
    let of = derivatives();
    hold(function, Compared::Derivative, at, [&of.d1, &of.d2], &written)?;
    let (a, b) = (direction(q, 3), direction(v, 1));
    let (mut by_q, mut by_v) = (SVector::zeros(), SVector::zeros());
    for i in 0..N {
        for j in 0..N {
            by_q[i] += of.d11[(i, j)] * a[j] + of.d12[(i, j)] * b[j];
            by_v[i] += of.d12[(j, i)] * a[j] + of.d22[(i, j)] * b[j];
        }
    }
    hold(function, Compared::SecondDerivative, at, [&by_q, &by_v], &|q, v| {
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
    hold_function(
        Function::Lagrangian,
        [q, v],
        |q, v| system.lagrangian(q, v),
        |q, v| system.lagrangian_gradient(q, v),
        || system.lagrangian_derivatives(q, v),
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
    hold_function(
        Function::Rayleigh,
        [q, v],
        |q, v| system.rayleigh(q, v),
        |q, v| system.rayleigh_gradient(q, v),
        || system.rayleigh_derivatives(q, v),
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
    let of = system.force_derivatives(q, v);
    let along = |shares: &SVector<L::Scalar, N>, index| {
        let (mut d1, mut d2) = (SVector::zeros(), SVector::zeros());
        for i in 0..N {
            for j in 0..N {
                d1[i] += shares[j] * of.d1[(j, i)];
                d2[i] += shares[j] * of.d2[(j, i)];
            }
        }
        hold(Function::Force { index }, Compared::Derivative, [q, v], [&d1, &d2], &|q, v| {
            let f = system.force(q, v);
            let mut sum = L::Scalar::constant(0.0);
            for j in 0..N {
                sum += shares[j] * f[j];
            }
            sum
        })
    };
    let sum = along(&direction(&SVector::zeros(), 2), 0);
    if sum.is_ok() {
        return sum;
    }
    for index in 0..N {
        let mut one = SVector::zeros();
        one[index] = L::Scalar::constant(1.0);
        along(&one, index)?;
    }
    sum
}
