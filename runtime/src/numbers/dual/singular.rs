//! Derivatives at singular points, and of many variables, one pair of variables at a time.
//!
//! A number that carries the derivatives by all variables holds a 0 for each that it does not depend on.
//! Where a slope is infinite, ∞ × 0 would make NaN of it, and the NaN would spread to variables that the
//! singular term does not depend on. Here all variables but one pair carry no derivative at all, so that what
//! depends on neither of the two has none: it is 0, as in code that is written out. What is NaN still does
//! not exist.

use core::array;

use nalgebra::{SMatrix, SVector};
use num_dual::Derivative;

use super::primitive::Primitive;
use super::seeds::{First, Second, entries};
use super::{HyperDualSVec, Real};
use crate::numbers::{Direction, Gradient, Variations};

/// Derivatives by one pair of variables.
pub type Alone<F> = Second<F, 1>;

/// The derivative by one variable.
pub type AloneFirst<F> = First<F, 1>;

/// Whether an entry is not a number.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn has_nan<F: Primitive, const R: usize, const C: usize>(entries: &SMatrix<F, R, C>) -> bool {
    // All are looked at: a loop that may end early is no vector operation.
    entries.data.0.as_flattened().iter().fold(false, |found, &entry| found | Primitive::is_nan(entry))
}

/// The derivatives that a variable carries in its first and second part, if any.
type Seeds<F> = [Option<F>; 2];

/// `f` where qₖ carries `seeds(k)` and vₖ carries `seeds(N + k)`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn seeded<F: Primitive, const N: usize, R>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Alone<F>>; N], [Real<Alone<F>>; N]) -> R,
    seeds: impl Fn(usize) -> Seeds<F>,
) -> R {
    let number = |value, seeds: Seeds<F>| {
        let [eps1, eps2] = seeds.map(|seed| Derivative(seed.map(|seed| SMatrix::from([[seed]]))));
        Real(HyperDualSVec { re: value, eps1, eps2, eps1eps2: Derivative(None) })
    };
    f(array::from_fn(|k| number(q[k], seeds(k))), array::from_fn(|k| number(v[k], seeds(N + k))))
}

/// Value, ∂f/∂q and ∂f/∂v.
#[cold]
#[inline(never)]
pub(super) fn gradient<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Alone<F>>; N], [Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> Gradient<F, N> {
    let mut gradient = Gradient { value: nalgebra::zero(), d1: SVector::zeros(), d2: SVector::zeros() };
    for i in 0..2 * N {
        let by_one = seeded(q, v, &f, |k| [only(k == i), None]).0;
        gradient.value = by_one.re;
        let part = if i < N { &mut gradient.d1 } else { &mut gradient.d2 };
        part[i % N] = entries(by_one.eps1)[0];
    }
    gradient
}

/// Value, first and second derivatives by the 2N variables (q, v).
#[cold]
#[inline(never)]
pub(super) fn derivatives<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Alone<F>>; N], [Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> (F, SVector<F, M>, SMatrix<F, M, M>) {
    let (mut value, mut first, mut second) = (nalgebra::zero(), SVector::zeros(), SMatrix::zeros());
    for i in 0..M {
        for j in i..M {
            let of_pair = seeded(q, v, &f, |k| [only(k == i), only(k == j)]).0;
            if i == j {
                value = of_pair.re;
                first[i] = entries(of_pair.eps1)[0];
            }
            second[(i, j)] = entries(of_pair.eps1eps2)[0];
            second[(j, i)] = second[(i, j)];
        }
    }
    (value, first, second)
}

/// Derivatives along `minus` and `plus`, and the mixed one.
#[cold]
#[inline(never)]
pub(super) fn variations<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    minus: Direction<F>,
    plus: Direction<F>,
    f: impl Fn([Real<Alone<F>>; N], [Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> Variations<F, N> {
    let mut variations =
        Variations { minus: SVector::zeros(), plus: SVector::zeros(), mixed: SMatrix::zeros() };
    for i in 0..N {
        for j in 0..N {
            let of_pair = seeded(q, v, &f, |k| [along(minus, i, k, N), along(plus, j, k, N)]).0;
            // A method may know its derivative by one argument better where the other one carries none.
            if i == j {
                variations.minus[i] = entries(of_pair.eps1)[0];
                variations.plus[i] = entries(of_pair.eps2)[0];
            }
            variations.mixed[(i, j)] = entries(of_pair.eps1eps2)[0];
        }
    }
    variations
}

/// `f` where qₖ carries `seed(k)` and vₖ carries `seed(N + k)`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn seeded_first<F: Primitive, const N: usize, R>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<AloneFirst<F>>; N], [Real<AloneFirst<F>>; N]) -> R,
    seed: impl Fn(usize) -> Option<F>,
) -> R {
    let number = |value, seed: Option<F>| {
        Real(First { re: value, eps: Derivative(seed.map(|seed| SMatrix::from([[seed]]))) })
    };
    f(array::from_fn(|k| number(q[k], seed(k))), array::from_fn(|k| number(v[k], seed(N + k))))
}

/// ∂f/∂q and ∂f/∂v of a covector.
#[cold]
#[inline(never)]
pub(super) fn covector_derivatives<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<AloneFirst<F>>; N], [Real<AloneFirst<F>>; N]) -> [Real<AloneFirst<F>>; N],
) -> (SMatrix<F, N, N>, SMatrix<F, N, N>) {
    let (mut d1, mut d2) = (SMatrix::zeros(), SMatrix::zeros());
    for j in 0..2 * N {
        let by_one = seeded_first(q, v, &f, |k| only(k == j));
        let column = if j < N { &mut d1 } else { &mut d2 };
        for (i, component) in by_one.into_iter().enumerate() {
            column[(i, j % N)] = entries(component.0.eps)[0];
        }
    }
    (d1, d2)
}

/// The derivative of a covector along `direction`.
#[cold]
#[inline(never)]
pub(super) fn covector_variation<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    direction: Direction<F>,
    f: impl Fn([Real<AloneFirst<F>>; N], [Real<AloneFirst<F>>; N]) -> [Real<AloneFirst<F>>; N],
) -> SMatrix<F, N, N> {
    let mut variation = SMatrix::zeros();
    for j in 0..N {
        let by_one = seeded_first(q, v, &f, |k| along(direction, j, k, N));
        for (i, component) in by_one.into_iter().enumerate() {
            variation[(i, j)] = entries(component.0.eps)[0];
        }
    }
    variation
}

/// 1 for the variable that is seeded, nothing for the others.
#[cfg_attr(not(debug_assertions), inline(always))]
fn only<F: Primitive>(is_seeded: bool) -> Option<F> {
    is_seeded.then(nalgebra::one)
}

/// The derivative that variable `k` of (q, v) carries where the unit vector eᵢ is followed along `direction`;
/// `None` of a variable that does not move: 0 × ∞ would be NaN, as of q at the first node of the trapezoidal
/// rule, which q1 does not move.
#[cfg_attr(not(debug_assertions), inline(always))]
fn along<F: Primitive>(direction: Direction<F>, i: usize, k: usize, n: usize) -> Option<F> {
    let moves = if k == i {
        direction.first
    } else if k == n + i {
        direction.second
    } else {
        return None;
    };
    (moves != F::constant(0.0)).then_some(moves)
}
