//! Derivatives as generated against differences, along directions with a part in every coordinate and
//! velocity.

use nalgebra::SVector;

use super::{beside, is_tiny, sizes, slope};
use crate::numbers::{Derivatives, Gradient, Scalar};
use crate::system::{Compared, Force, Function, GeneratedDiffers, Lagrangian, Rayleigh};

/// A direction in (q, v), with a part in every one: a third to two thirds of its size.
///
/// Beside tiny entries all have their own size, and none where they are 0.
fn direction<S: Scalar, const N: usize>(point: &SVector<S, N>, phase: usize, is_own: bool) -> SVector<S, N> {
    let mut direction = if is_own { *point } else { sizes(point) };
    for i in 0..N {
        let share = 1.0 / 3.0 + ((i + phase) * 7 % 11) as f64 / 33.0;
        let sign = if (i + phase) % 3 == 1 { -1.0 } else { 1.0 };
        direction[i] *= S::constant(sign * share);
    }
    direction
}

/// A point in (q, v), and whether directions there have the size of its entries, or 1 where they are small.
#[derive(Clone, Copy)]
struct At<'a, S, const N: usize> {
    q: &'a SVector<S, N>,
    v: &'a SVector<S, N>,
    is_own: bool,
}

impl<'a, S: Scalar, const N: usize> At<'a, S, N> {
    fn new(q: &'a SVector<S, N>, v: &'a SVector<S, N>) -> Self {
        Self { q, v, is_own: q.iter().chain(v.iter()).any(|x| is_tiny(*x)) }
    }

    fn direction(self, phases: [usize; 2]) -> [SVector<S, N>; 2] {
        [direction(self.q, phases[0], self.is_own), direction(self.v, phases[1], self.is_own)]
    }

    /// Size of the terms of a function, which may cancel here: no less than its value at 1.
    fn terms(self, written: Written<'_, S, N>) -> f64 {
        if !self.is_own {
            return 0.0;
        }
        let one = SVector::repeat(S::constant(1.0));
        written(&beside(self.q, 0.75, &one), &beside(self.v, -1.25, &one)).widen().abs()
    }
}

/// A function as written.
type Written<'a, S, const N: usize> = &'a dyn Fn(&SVector<S, N>, &SVector<S, N>) -> S;

/// Its partial derivatives as generated.
type Partials<'a, S, const N: usize> = &'a dyn Fn(&SVector<S, N>, &SVector<S, N>) -> [SVector<S, N>; 2];

/// The slope of `written` from its `partials` along `direction`, and by differences, where those leave no
/// doubt that it is another.
fn refuted<S: Scalar, const N: usize>(
    at: At<'_, S, N>,
    [a, b]: &[SVector<S, N>; 2],
    partials: Partials<'_, S, N>,
    written: Written<'_, S, N>,
) -> Option<[f64; 2]> {
    let (q, v, epsilon) = (at.q, at.v, S::EPSILON.widen());
    let slope_of = |[d1, d2]: &[SVector<S, N>; 2]| {
        let mut slope = 0.0;
        for i in 0..N {
            slope += d1[i].widen() * a[i].widen() + d2[i].widen() * b[i].widen();
        }
        slope
    };
    let moved = |s: f64| {
        let (mut moved_q, mut moved_v) = (*q, *v);
        for i in 0..N {
            moved_q[i] += a[i] * S::constant(s);
            moved_v[i] += b[i] * S::constant(s);
        }
        (moved_q, moved_v)
    };
    let here = partials(q, v);
    let (slope, mut size) = (slope_of(&here), at.terms(written));
    for i in 0..N {
        let [d1, d2] = [here[0][i].widen(), here[1][i].widen()];
        size += (d1 * q[i].widen()).abs() + (d2 * v[i].widen()).abs();
    }
    let mut along = |s: f64| {
        let (q, v) = moved(s);
        written(&q, &v).widen()
    };
    let by_differences = slope::refuted(slope, epsilon, size, &mut along)?;
    let mut slope_along = |s: f64| {
        let (q, v) = moved(s);
        slope_of(&partials(&q, &v))
    };
    let is_steady = slope::is_steady(slope, by_differences, epsilon, &mut slope_along);
    is_steady.then_some([slope, by_differences])
}

/// Whether a partial derivative is refuted by itself, here and where its coordinate or velocity is larger:
/// what rounding takes of terms that cancel, as in √(1 + v²) − 1, is not missing there.
#[cold]
#[inline(never)]
fn one_is_refuted<S: Scalar, const N: usize>(
    at: At<'_, S, N>,
    partials: Partials<'_, S, N>,
    written: Written<'_, S, N>,
) -> bool {
    let is_refuted = |k: usize, factor: f64| {
        let (mut q, mut v) = (*at.q, *at.v);
        let entry = if k < N { &mut q[k] } else { &mut v[k - N] };
        *entry *= S::constant(factor);
        let at = At { q: &q, v: &v, ..at };
        let [mut a, mut b] = at.direction([0, 5]);
        for i in 0..N {
            if i != k {
                a[i] = S::constant(0.0);
            }
            if i + N != k {
                b[i] = S::constant(0.0);
            }
        }
        refuted(at, &[a, b], partials, written).is_some()
    };
    let factors = slope::factors(S::EPSILON.widen());
    (0..2 * N).any(|k| factors.into_iter().all(|factor| is_refuted(k, factor)))
}

/// The slope of `written` from its `partials`, held against its differences along the [`direction`] of
/// (q, v).
fn hold<S: Scalar, const N: usize>(
    function: Function,
    compared: Compared,
    at: At<'_, S, N>,
    partials: Partials<'_, S, N>,
    written: Written<'_, S, N>,
) -> Result<(), GeneratedDiffers> {
    let largest = slope::largest(S::EPSILON.widen());
    if !at.q.iter().chain(at.v.iter()).all(|x| x.widen().abs() <= largest) {
        return Ok(());
    }
    match refuted(at, &at.direction([0, 5]), partials, written) {
        Some([generated, by_differences]) if one_is_refuted(at, partials, written) => {
            Err(GeneratedDiffers { function, compared, generated, written: by_differences })
        }
        _ => Ok(()),
    }
}

/// The gradient of a function held against its differences; with `debug_assertions` also its second
/// derivatives, along another direction against differences of the gradient, and the first that come with
/// them.
fn hold_function<S: Scalar, const N: usize>(
    function: Function,
    at: At<'_, S, N>,
    written: impl Fn(&SVector<S, N>, &SVector<S, N>) -> S,
    gradient: impl Fn(&SVector<S, N>, &SVector<S, N>) -> Gradient<S, N>,
    derivatives: impl Fn(&SVector<S, N>, &SVector<S, N>) -> Derivatives<S, N>,
) -> Result<(), GeneratedDiffers> {
    let first = |q: &_, v: &_| {
        let of = gradient(q, v);
        [of.d1, of.d2]
    };
    hold(function, Compared::Derivative, at, &first, &written)?;
    if !cfg!(debug_assertions) {
        return Ok(());
    }
    let beside_second = |q: &_, v: &_| {
        let of = derivatives(q, v);
        [of.d1, of.d2]
    };
    hold(function, Compared::Derivative, at, &beside_second, &written)?;
    let [a, b] = at.direction([3, 1]);
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
    hold_function(
        Function::Lagrangian,
        At::new(q, v),
        |q, v| system.lagrangian(q, v),
        |q, v| system.lagrangian_gradient(q, v),
        |q, v| system.lagrangian_derivatives(q, v),
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
        At::new(q, v),
        |q, v| system.rayleigh(q, v),
        |q, v| system.rayleigh_gradient(q, v),
        |q, v| system.rayleigh_derivatives(q, v),
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
    let along = |shares: &SVector<L::Scalar, N>, index| {
        let partials = |q: &_, v: &_| {
            let of = system.force_derivatives(q, v);
            let (mut d1, mut d2) = (SVector::zeros(), SVector::zeros());
            for i in 0..N {
                for j in 0..N {
                    d1[i] += shares[j] * of.d1[(j, i)];
                    d2[i] += shares[j] * of.d2[(j, i)];
                }
            }
            [d1, d2]
        };
        hold(Function::Force { index }, Compared::Derivative, At::new(q, v), &partials, &|q, v| {
            let f = system.force(q, v);
            let mut sum = L::Scalar::constant(0.0);
            for j in 0..N {
                sum += shares[j] * f[j];
            }
            sum
        })
    };
    let sum = along(&direction(&SVector::zeros(), 2, false), 0);
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
