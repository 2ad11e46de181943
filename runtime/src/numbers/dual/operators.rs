//! The operators of `Real<D>`: arithmetic and comparisons between numbers of a body, references to them and
//! plain numbers.

use core::cmp::Ordering;
use core::fmt;
use core::iter::{Product, Sum};
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Rem, RemAssign, Sub, SubAssign};

use super::primitive::Primitive;
use super::{Dual, Over, Real};

/// x % y = x − y·trunc(x/y). Bodies are refused it by [`Remainder`](super::refused::Remainder); that it
/// exists for all numbers lets the compiler infer the integers that it is for.
trait Modulo<F>: Sized {
    fn modulo(self, right: Self) -> Self;
}

impl<D, F> Modulo<F> for D
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    fn modulo(self, right: Self) -> Self {
        let (x, y) = (self.primal(), right.primal());
        let remainder = x % y;
        let whole = D::from((x - remainder) / y);
        self.minus(right.times(whole)).with_primal(remainder)
    }
}

/// An operator between numbers of a differentiated body, by value and by reference.
macro_rules! operator {
    ($($trait:ident $name:ident $assign:ident $assign_name:ident $operation:ident)*) => {$(
        impl<D, F> $trait for Real<D>
        where
            F: Primitive,
            D: Dual<F> + Over<Primitive = F>,
        {
            type Output = Self;
            #[inline]
            fn $name(self, right: Self) -> Self {
                Self(self.0.$operation(right.0))
            }
        }

        impl<D, F> $trait<&Self> for Real<D>
        where
            F: Primitive,
            D: Dual<F> + Over<Primitive = F>,
        {
            type Output = Self;
            #[inline]
            fn $name(self, right: &Self) -> Self {
                self.$name(*right)
            }
        }

        impl<D, F> $trait<Real<D>> for &Real<D>
        where
            F: Primitive,
            D: Dual<F> + Over<Primitive = F>,
        {
            type Output = Real<D>;
            #[inline]
            fn $name(self, right: Real<D>) -> Real<D> {
                (*self).$name(right)
            }
        }

        impl<D, F> $trait for &Real<D>
        where
            F: Primitive,
            D: Dual<F> + Over<Primitive = F>,
        {
            type Output = Real<D>;
            #[inline]
            fn $name(self, right: Self) -> Real<D> {
                (*self).$name(*right)
            }
        }

        impl<D, F> $assign for Real<D>
        where
            F: Primitive,
            D: Dual<F> + Over<Primitive = F>,
        {
            #[inline]
            fn $assign_name(&mut self, right: Self) {
                *self = (*self).$name(right);
            }
        }

        impl<D, F> $assign<&Self> for Real<D>
        where
            F: Primitive,
            D: Dual<F> + Over<Primitive = F>,
        {
            #[inline]
            fn $assign_name(&mut self, right: &Self) {
                *self = (*self).$name(*right);
            }
        }

        operator!(primitive $trait $name $assign $assign_name f64);
        operator!(primitive $trait $name $assign $assign_name f32);
    )*};
    (primitive $trait:ident $name:ident $assign:ident $assign_name:ident $float:ty) => {
        impl<D: Dual<$float>> $trait<$float> for Real<D> {
            type Output = Self;
            #[inline]
            fn $name(self, right: $float) -> Self {
                self.$name(D::real(right))
            }
        }

        impl<D: Dual<$float>> $trait<$float> for &Real<D> {
            type Output = Real<D>;
            #[inline]
            fn $name(self, right: $float) -> Real<D> {
                (*self).$name(right)
            }
        }

        impl<D: Dual<$float>> $trait<Real<D>> for $float {
            type Output = Real<D>;
            #[inline]
            fn $name(self, right: Real<D>) -> Real<D> {
                D::real(self).$name(right)
            }
        }

        impl<D: Dual<$float>> $trait<&Real<D>> for $float {
            type Output = Real<D>;
            #[inline]
            fn $name(self, right: &Real<D>) -> Real<D> {
                D::real(self).$name(*right)
            }
        }

        impl<D: Dual<$float>> $assign<$float> for Real<D> {
            #[inline]
            fn $assign_name(&mut self, right: $float) {
                *self = (*self).$name(right);
            }
        }
    };
}
operator! {
    Add add AddAssign add_assign plus
    Sub sub SubAssign sub_assign minus
    Mul mul MulAssign mul_assign times
    Div div DivAssign div_assign over
    Rem rem RemAssign rem_assign modulo
}

impl<D, F> Neg for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.negated())
    }
}

impl<D, F> Neg for &Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    type Output = Real<D>;
    #[inline]
    fn neg(self) -> Real<D> {
        -*self
    }
}

impl<D, F> Sum for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    // From −0, as the standard library does: the sum of nothing, and of zeros, has its sign.
    #[inline]
    fn sum<I: Iterator<Item = Self>>(numbers: I) -> Self {
        Self(numbers.fold(D::from(F::constant(-0.0)), |sum, x| sum.plus(x.0)))
    }
}

impl<'a, D, F> Sum<&'a Self> for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    #[inline]
    fn sum<I: Iterator<Item = &'a Self>>(numbers: I) -> Self {
        numbers.copied().sum()
    }
}

impl<D, F> Product for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    #[inline]
    fn product<I: Iterator<Item = Self>>(numbers: I) -> Self {
        Self(numbers.fold(D::from(nalgebra::one()), |product, x| product.times(x.0)))
    }
}

impl<'a, D, F> Product<&'a Self> for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    #[inline]
    fn product<I: Iterator<Item = &'a Self>>(numbers: I) -> Self {
        numbers.copied().product()
    }
}

/// Comparisons see the value alone.
impl<D, F> PartialEq for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.0.primal() == other.0.primal()
    }
}

impl<D, F> PartialOrd for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.primal().partial_cmp(&other.0.primal())
    }
}

/// Comparisons with the plain numbers of the system.
macro_rules! primitive {
    ($($float:ty)*) => {$(
        impl<D: Dual<$float>> PartialEq<$float> for Real<D> {
            #[inline]
            fn eq(&self, other: &$float) -> bool {
                self.0.primal() == *other
            }
        }

        impl<D: Dual<$float>> PartialOrd<$float> for Real<D> {
            #[inline]
            fn partial_cmp(&self, other: &$float) -> Option<Ordering> {
                self.0.primal().partial_cmp(other)
            }
        }

        impl<D: Dual<$float>> PartialEq<Real<D>> for $float {
            #[inline]
            fn eq(&self, other: &Real<D>) -> bool {
                *self == other.0.primal()
            }
        }

        impl<D: Dual<$float>> PartialOrd<Real<D>> for $float {
            #[inline]
            fn partial_cmp(&self, other: &Real<D>) -> Option<Ordering> {
                self.partial_cmp(&other.0.primal())
            }
        }
    )*};
}
primitive!(f64 f32);

/// `f64::from(x)` for the plain numbers that `f64` takes, those of single precision among them.
macro_rules! from_plain {
    ($($plain:ty)*) => {$(
        impl<D, F> From<$plain> for Real<D>
        where
            F: Primitive + From<$plain>,
            D: Dual<F> + Over<Primitive = F>,
        {
            #[inline]
            fn from(value: $plain) -> Self {
                Self(D::from(<F as From<$plain>>::from(value)))
            }
        }
    )*};
}
from_plain!(f64 f32 i8 i16 i32 u8 u16 u32 bool);

impl<D, F> Default for Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    fn default() -> Self {
        Self(D::from(nalgebra::zero()))
    }
}

impl<D: fmt::Debug> fmt::Debug for Real<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.0, f)
    }
}
