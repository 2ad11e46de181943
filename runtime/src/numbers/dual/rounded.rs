//! Sizes of terms that cancel in first derivatives, by a number that carries what rounding took of them.
//!
//! Of a function that is written out the macro writes these sizes out; of one that is evaluated over other
//! numbers this number adds them up. A running error bound, over ε (N. J. Higham, Accuracy and Stability of
//! Numerical Algorithms, 2002, section 3.3): the sizes of what each operation rounds, carried to the result.

use core::array;

use nalgebra::SVector;

use super::primitive::Primitive;
use super::{Dual, Over, Real};
use crate::numbers::CancellingTerms;

/// A value with its derivatives by M variables, each with what rounding took of it, over ε.
#[derive(Clone, Copy, Debug)]
pub struct Rounded<F, const M: usize> {
    value: Part<F>,
    /// `None` for a number that depends on no variable.
    slopes: Option<[Part<F>; M]>,
    /// Whether it is a multiple of variables, or a sum of such.
    is_linear: bool,
}

/// A number, and what rounding took of it, over ε.
#[derive(Clone, Copy, Debug)]
struct Part<F> {
    value: F,
    lost: F,
}

fn size<F: Primitive>(value: F) -> F {
    Primitive::abs(value)
}

impl<F: Primitive> Part<F> {
    fn exact(value: F) -> Self {
        Self { value, lost: nalgebra::zero() }
    }

    fn plus(self, right: Self) -> Self {
        let value = self.value + right.value;
        // Adding 0 does not round.
        let rounds = self.value != F::constant(0.0) && right.value != F::constant(0.0);
        let own = if rounds { size(value) } else { nalgebra::zero() };
        Self { value, lost: self.lost + right.lost + own }
    }

    fn times(self, right: Self) -> Self {
        let value = self.value * right.value;
        Self { value, lost: self.lost * size(right.value) + size(self.value) * right.lost + size(value) }
    }

    fn over(self, right: Self) -> Self {
        let value = self.value / right.value;
        let lost = (self.lost + size(value) * right.lost) / size(right.value) + size(value);
        Self { value, lost }
    }

    fn negated(self) -> Self {
        Self { value: -self.value, lost: self.lost }
    }

    /// g(x), where `value` is g and `slope` is g′ at x, each rounded once.
    fn chain(self, value: F, slope: F) -> Self {
        Self { value, lost: size(slope) * self.lost + size(value) }
    }
}

impl<F: Primitive, const M: usize> Rounded<F, M> {
    fn variable(value: F, index: usize) -> Self {
        let slope = |i| Part::exact(if i == index { nalgebra::one() } else { nalgebra::zero() });
        Self { value: Part::exact(value), slopes: Some(array::from_fn(slope)), is_linear: true }
    }

    /// A number that is linear in the variables where `is_linear`: exact then.
    fn of(value: Part<F>, slopes: Option<[Part<F>; M]>, is_linear: bool) -> Self {
        let value = if is_linear { Part::exact(value.value) } else { value };
        Self { value, slopes, is_linear }
    }

    /// The rounding of the derivative by variable `index`, over ε.
    fn lost(&self, index: usize) -> F {
        self.slopes.map_or(nalgebra::zero(), |slopes| slopes[index].lost)
    }
}

impl<F: Primitive, const M: usize> Over for Rounded<F, M> {
    type Primitive = F;
}

macro_rules! from {
    ($($float:ty)*) => {$(
        impl<const M: usize> From<$float> for Rounded<$float, M> {
            fn from(value: $float) -> Self {
                Self { value: Part::exact(value), slopes: None, is_linear: false }
            }
        }
    )*};
}
from!(f64 f32);

impl<F: Primitive, const M: usize> Dual<F> for Rounded<F, M>
where
    Self: From<F>,
{
    fn primal(self) -> F {
        self.value.value
    }

    fn with_primal(self, value: F) -> Self {
        Self { value: Part { value, ..self.value }, ..self }
    }

    fn chain(self, [g, g1, g2, _]: [F; 4]) -> Self {
        let slope = self.value.chain(g1, g2);
        let slopes = self.slopes.map(|slopes| slopes.map(|own| own.times(slope)));
        Self::of(self.value.chain(g, g1), slopes, false)
    }

    fn is_constant(self) -> bool {
        self.slopes.is_none()
    }

    fn plus(self, right: Self) -> Self {
        let slopes = match (self.slopes, right.slopes) {
            (Some(a), Some(b)) => Some(array::from_fn(|i| a[i].plus(b[i]))),
            (a, b) => a.or(b),
        };
        Self::of(self.value.plus(right.value), slopes, self.is_linear && right.is_linear)
    }

    fn times(self, right: Self) -> Self {
        let slopes = match (self.slopes, right.slopes) {
            (Some(a), Some(b)) => {
                Some(array::from_fn(|i| a[i].times(right.value).plus(self.value.times(b[i]))))
            }
            (Some(a), None) => Some(a.map(|a| a.times(right.value))),
            (None, b) => b.map(|b| b.map(|b| self.value.times(b))),
        };
        let is_linear = self.is_linear && right.is_constant() || self.is_constant() && right.is_linear;
        Self::of(self.value.times(right.value), slopes, is_linear)
    }

    fn over(self, right: Self) -> Self {
        // (a/b)′ = (a′ − (a/b) b′)/b.
        let value = self.value.over(right.value);
        let taken = |b: Part<F>| value.negated().times(b);
        let slopes = match (self.slopes, right.slopes) {
            (Some(a), Some(b)) => Some(array::from_fn(|i| a[i].plus(taken(b[i])).over(right.value))),
            (Some(a), None) => Some(a.map(|a| a.over(right.value))),
            (None, b) => b.map(|b| b.map(|b| taken(b).over(right.value))),
        };
        Self::of(value, slopes, self.is_linear && right.is_constant())
    }

    fn negated(self) -> Self {
        let slopes = self.slopes.map(|slopes| slopes.map(Part::negated));
        Self { value: self.value.negated(), slopes, ..self }
    }
}

/// q and v as the variables, q first; M = 2N.
fn variables<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
) -> [[Real<Rounded<F, M>>; N]; 2] {
    const { assert!(M == 2 * N) };
    [
        array::from_fn(|i| Real(Rounded::variable(q[i], i))),
        array::from_fn(|i| Real(Rounded::variable(v[i], N + i))),
    ]
}

/// Sizes of the terms that cancel in ∂L/∂v and ∂L/∂q.
#[cold]
#[inline(never)]
pub fn terms_of_lagrangian<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    lagrangian: impl Fn([Real<Rounded<F, M>>; N], [Real<Rounded<F, M>>; N]) -> Real<Rounded<F, M>>,
) -> CancellingTerms<F, N> {
    let [q, v] = variables(q, v);
    let l = lagrangian(q, v).0;
    CancellingTerms {
        momentum: SVector::from_fn(|i, _| l.lost(N + i)),
        rate: SVector::from_fn(|i, _| l.lost(i)),
    }
}

/// Sizes of the terms that cancel in ∂R/∂v.
#[cold]
#[inline(never)]
pub fn terms_of_rayleigh<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    rayleigh: impl Fn([Real<Rounded<F, M>>; N], [Real<Rounded<F, M>>; N]) -> Real<Rounded<F, M>>,
) -> SVector<F, N> {
    let [q, v] = variables(q, v);
    let r = rayleigh(q, v).0;
    SVector::from_fn(|i, _| r.lost(N + i))
}

/// Sizes of the terms that cancel in f.
#[cold]
#[inline(never)]
pub fn terms_of_force<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    force: impl Fn([Real<Rounded<F, M>>; N], [Real<Rounded<F, M>>; N]) -> [Real<Rounded<F, M>>; N],
) -> SVector<F, N> {
    let [q, v] = variables(q, v);
    force(q, v).map(|component| component.0.value.lost).into()
}
