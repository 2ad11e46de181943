//! Derivatives by num-dual: the one place that names its types.
//!
//! A body annotated with `#[rayleigh_system]` is written once, over [`Real<D>`](Real); D = `f64` gives the
//! plain value, a dual number the derivatives. Second derivatives come from [`HyperDualVec`]: seeding its
//! first part along one family of directions and its second part along another makes the cross block their
//! mixed second derivative. With the directions of a rule that block is the Newton matrix, and nothing else
//! is computed.

mod curve;
mod derivatives;
mod fields;
mod lift;
mod operators;
mod primitive;
mod real;
mod refused;
mod rounded;
mod second_order;
mod seeds;
mod singular;

use nalgebra::{Const, SMatrix};
use num_dual::{Derivative, DualNum, DualSVec, HyperDualVec};

use crate::numbers::Scalar;

pub use curve::at;
pub use derivatives::{
    by_input, covector_derivatives, covector_variation, derivatives, gradient, variations,
};
pub use fields::{differential, hessian, jacobian};
pub use lift::{Beside, FromCast, Given, Integer, Lift, Lower, Number, integer, lift, lower};
pub use primitive::Primitive;
pub use real::Real;
pub use refused::{Differentiated, Remainder, Roundable, remainder};
pub use rounded::{Rounded, terms_of_force, terms_of_lagrangian, terms_of_rayleigh};
pub use second_order::{hessian_along, hessian_of_product};

/// A number over a plain one, by which its operators are told.
pub trait Over: Copy {
    /// `f64` or `f32`.
    type Primitive: Primitive;
}

impl<D: DualNum<Primitive: Primitive> + Copy> Over for D {
    type Primitive = <D as DualNum>::Primitive;
}

/// A number that carries derivatives, over the scalar `F`: `f64`, `f32` or a num-dual number on them, or one
/// that carries what rounding took of its derivatives.
#[diagnostic::on_unimplemented(
    message = "`{F}` does not fit the scalar type of this system",
    label = "another scalar type than the system's",
    note = "write fields, constants and literals in the scalar type of `q` and `v`"
)]
pub trait Dual<F: Scalar>: Over<Primitive = F> + From<F> {
    /// The value without derivatives.
    fn primal(self) -> F;

    /// Replaces the value and keeps the derivatives: corrects a value reached by a less accurate way.
    fn with_primal(self, value: F) -> Self;

    /// g(self), from g, g′, g″ and g‴ at its value.
    fn chain(self, derivatives: [F; 4]) -> Self;

    /// Whether all derivatives are absent: a number that depends on neither q nor v.
    fn is_constant(self) -> bool;

    /// self + right.
    fn plus(self, right: Self) -> Self;

    /// self − right.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn minus(self, right: Self) -> Self {
        self.plus(right.negated())
    }

    /// self × right.
    fn times(self, right: Self) -> Self;

    /// self / right.
    fn over(self, right: Self) -> Self;

    /// −self.
    fn negated(self) -> Self;

    /// The constant `value`.
    #[inline]
    fn real(value: F) -> Real<Self> {
        Real(Self::from(value))
    }

    /// A field or constant of the system, whatever its type: floating-point parts become [`Real`], integers
    /// and `bool` stay.
    #[inline]
    fn lift<T: Lift<Self>>(value: T) -> T::Lifted {
        value.lift()
    }

    /// `value as f64` (or `f32`), for a number of any type.
    #[inline]
    fn number<T: Number<Self>>(value: T) -> Real<Self> {
        value.number()
    }
}

macro_rules! primitive {
    ($($float:ty)*) => {$(
        impl Dual<$float> for $float {
            #[inline]
            fn primal(self) -> $float {
                self
            }

            #[inline]
            fn with_primal(self, value: $float) -> Self {
                value
            }

            #[inline]
            fn chain(self, derivatives: [$float; 4]) -> Self {
                derivatives[0]
            }

            #[inline]
            fn is_constant(self) -> bool {
                true
            }

            #[inline]
            fn plus(self, right: Self) -> Self {
                self + right
            }

            #[inline]
            fn minus(self, right: Self) -> Self {
                self - right
            }

            #[inline]
            fn times(self, right: Self) -> Self {
                self * right
            }

            #[inline]
            fn over(self, right: Self) -> Self {
                self / right
            }

            #[inline]
            fn negated(self) -> Self {
                -self
            }
        }
    )*};
}
primitive!(f64 f32);

/// Hyper-dual numbers of fixed shape.
type HyperDualSVec<T, const M: usize, const N: usize> = HyperDualVec<T, Const<M>, Const<N>>;

/// Derivatives of a number: absent (`None`) where it depends on nothing, which is known when a body is
/// compiled.
type Part<T, const R: usize, const C: usize> = Derivative<T, Const<R>, Const<C>>;

// The operations on num-dual's numbers, written out so that they inline: num-dual's own are calls, and a body
// of thirty operations would make hundreds of them.

/// `operation` on every entry.
#[cfg_attr(not(debug_assertions), inline(always))]
fn map<T: DualNum + Copy, const R: usize, const C: usize>(
    part: Part<T, R, C>,
    operation: impl Fn(T) -> T,
) -> Part<T, R, C> {
    Derivative(part.0.map(|mut entries| {
        for entry in entries.data.0.as_flattened_mut() {
            *entry = operation(*entry);
        }
        entries
    }))
}

/// Sum of two parts, one of which may be absent.
#[cfg_attr(not(debug_assertions), inline(always))]
fn sum<F: Primitive, T: Dual<F> + DualNum, const R: usize, const C: usize>(
    left: Part<T, R, C>,
    right: Part<T, R, C>,
) -> Part<T, R, C> {
    Derivative(match (left.0, right.0) {
        (Some(mut left), Some(right)) => {
            for (l, r) in left.data.0.as_flattened_mut().iter_mut().zip(right.data.0.as_flattened()) {
                *l = l.plus(*r);
            }
            Some(left)
        }
        (left, None) => left,
        (None, right) => right,
    })
}

/// Every entry times `factor`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn scaled<F: Primitive, T: Dual<F> + DualNum, const R: usize, const C: usize>(
    part: Part<T, R, C>,
    factor: T,
) -> Part<T, R, C> {
    map(part, |entry| entry.times(factor))
}

/// The product of a column and a row.
#[cfg_attr(not(debug_assertions), inline(always))]
fn outer<F: Primitive, T: Dual<F> + DualNum, const R: usize, const C: usize>(
    column: Part<T, R, 1>,
    row: Part<T, 1, C>,
) -> Part<T, R, C> {
    Derivative(match (column.0, row.0) {
        (Some(column), Some(row)) => {
            let mut product = SMatrix::<T, R, C>::from_element(column[0]);
            for (j, entries) in product.data.0.iter_mut().enumerate() {
                for (i, entry) in entries.iter_mut().enumerate() {
                    *entry = column.data.0[0][i].times(row.data.0[j][0]);
                }
            }
            Some(product)
        }
        _ => None,
    })
}

impl<F, T, const M: usize> Dual<F> for DualSVec<T, M>
where
    F: Primitive,
    T: Dual<F> + DualNum,
    Self: DualNum<Primitive = F> + Copy,
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn primal(self) -> F {
        self.re.primal()
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn with_primal(self, value: F) -> Self {
        Self { re: self.re.with_primal(value), ..self }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn is_constant(self) -> bool {
        self.eps.0.is_none() && self.re.is_constant()
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn chain(self, [g, g1, g2, g3]: [F; 4]) -> Self {
        let slope = self.re.chain([g1, g2, g3, nalgebra::zero()]);
        Self { re: self.re.chain([g, g1, g2, g3]), eps: scaled(self.eps, slope) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn plus(self, right: Self) -> Self {
        Self { re: self.re.plus(right.re), eps: sum(self.eps, right.eps) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn times(self, right: Self) -> Self {
        Self { re: self.re.times(right.re), eps: sum(scaled(self.eps, right.re), scaled(right.eps, self.re)) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn over(self, right: Self) -> Self {
        // (a/b)′ = (a′ − (a/b) b′)/b.
        let re = self.re.over(right.re);
        let numerator = sum(self.eps, scaled(right.eps, re.negated()));
        Self { re, eps: map(numerator, |entry| entry.over(right.re)) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn negated(self) -> Self {
        Self { re: self.re.negated(), eps: map(self.eps, T::negated) }
    }
}

impl<F, T, const M: usize, const N: usize> Dual<F> for HyperDualSVec<T, M, N>
where
    F: Primitive,
    T: Dual<F> + DualNum,
    Self: DualNum<Primitive = F> + Copy,
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn primal(self) -> F {
        self.re.primal()
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn with_primal(self, value: F) -> Self {
        Self { re: self.re.with_primal(value), ..self }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn is_constant(self) -> bool {
        self.eps1.0.is_none() && self.eps2.0.is_none() && self.re.is_constant()
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn chain(self, [g, g1, g2, g3]: [F; 4]) -> Self {
        let slope = self.re.chain([g1, g2, g3, nalgebra::zero()]);
        let curvature = self.re.chain([g2, g3, nalgebra::zero(), nalgebra::zero()]);
        Self {
            re: self.re.chain([g, g1, g2, g3]),
            eps1: scaled(self.eps1, slope),
            eps2: scaled(self.eps2, slope),
            eps1eps2: sum(scaled(self.eps1eps2, slope), outer(scaled(self.eps1, curvature), self.eps2)),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn plus(self, right: Self) -> Self {
        Self {
            re: self.re.plus(right.re),
            eps1: sum(self.eps1, right.eps1),
            eps2: sum(self.eps2, right.eps2),
            eps1eps2: sum(self.eps1eps2, right.eps1eps2),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn times(self, right: Self) -> Self {
        let cross = sum(outer(self.eps1, right.eps2), outer(right.eps1, self.eps2));
        Self {
            re: self.re.times(right.re),
            eps1: sum(scaled(self.eps1, right.re), scaled(right.eps1, self.re)),
            eps2: sum(scaled(self.eps2, right.re), scaled(right.eps2, self.re)),
            eps1eps2: sum(sum(scaled(self.eps1eps2, right.re), scaled(right.eps1eps2, self.re)), cross),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn over(self, right: Self) -> Self {
        // q = a/b: q′ = (a′ − q b′)/b, and once more for the mixed derivative.
        let re = self.re.over(right.re);
        let (negated, divided) = (re.negated(), |entry: T| entry.over(right.re));
        let eps1 = map(sum(self.eps1, scaled(right.eps1, negated)), divided);
        let eps2 = map(sum(self.eps2, scaled(right.eps2, negated)), divided);
        let cross = sum(outer(eps1, right.eps2), outer(right.eps1, eps2));
        let numerator = sum(sum(self.eps1eps2, scaled(right.eps1eps2, negated)), map(cross, T::negated));
        Self { re, eps1, eps2, eps1eps2: map(numerator, divided) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn negated(self) -> Self {
        Self {
            re: self.re.negated(),
            eps1: map(self.eps1, T::negated),
            eps2: map(self.eps2, T::negated),
            eps1eps2: map(self.eps1eps2, T::negated),
        }
    }
}
