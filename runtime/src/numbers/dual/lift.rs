//! From the user's types to those over `Real<D>` and back.

use super::primitive::Primitive as Plain;
use super::{Dual, Over, Real};

/// A value that can be taken into a differentiated body: numbers, `bool`, arrays, tuples and options of them.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be used in a differentiated body",
    label = "neither a number, nor a bool, nor an array of them",
    note = "a system's L, R and f may depend on numbers, bools and arrays of them; keep other data outside the struct, or convert it to numbers first"
)]
pub trait Lift<D>: Sized {
    /// A type of this shape, with `Real<D>` for floating-point numbers.
    type Lifted;

    /// The value with constants for floating-point numbers.
    fn lift(self) -> Self::Lifted;
}

/// A value of a differentiated body that can be handed back to plain code.
pub trait Lower: Sized {
    /// A type of this shape, with plain floating-point numbers.
    type Lowered;

    /// The value without derivatives.
    fn lower(self) -> Self::Lowered;
}

/// A number that `as f64` accepts: an integer or a floating-point number.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be cast to the scalar type of this system",
    label = "neither an integer nor a floating-point number of this system"
)]
pub trait Number<D> {
    /// The number as a `Real<D>`.
    fn number(self) -> Real<D>;
}

/// A value that a cast to an integer accepts: an integer or a `bool`.
#[diagnostic::on_unimplemented(
    message = "a floating-point number of a differentiated body cannot become an integer",
    label = "an integer has no derivative",
    note = "keep it as a floating-point number; to choose between cases, compare: `if q[0] > 0.0 {{ … }} else {{ … }}`"
)]
pub trait Integer<T> {
    /// `self as T`.
    fn integer(self) -> T;
}

/// An input or a time, of the scalar's precision: where it is lifted, D is told by the lifted value alone.
pub trait Given<D> {
    /// A type of this shape, with `Real<D>` for numbers.
    type Lifted;

    /// The value with constants for numbers.
    fn lift(self) -> Self::Lifted;
}

/// [`Given::lift`] as a function.
#[inline]
pub fn lift<D, T: Given<D>>(value: T) -> T::Lifted {
    value.lift()
}

/// [`Lower::lower`] as a function.
#[inline]
pub fn lower<T: Lower>(value: T) -> T::Lowered {
    value.lower()
}

/// `value as T` for integers.
#[inline]
pub fn integer<V: Integer<T>, T>(value: V) -> T {
    value.integer()
}

/// The type that a floating-point number `T` has beside numbers over the scalar `Self`: [`Real`] if it is of
/// the scalar's precision, its own if it is of the other one, until it is converted.
pub trait Beside<T, D> {
    /// [`Real`], or `T`.
    type Held;

    /// The number there.
    fn hold(value: T) -> Self::Held;
}

macro_rules! floats {
    ($($float:ident beside $other:ident)*) => {$(
        impl<D: Over<Primitive: Beside<$float, D>>> Lift<D> for $float {
            type Lifted = <D::Primitive as Beside<$float, D>>::Held;
            #[inline]
            fn lift(self) -> Self::Lifted {
                <D::Primitive as Beside<$float, D>>::hold(self)
            }
        }

        impl<D: Dual<$float>> Given<D> for $float {
            type Lifted = Real<D>;
            #[inline]
            fn lift(self) -> Real<D> {
                D::real(self)
            }
        }

        impl<D: Dual<$float>> Beside<$float, D> for $float {
            type Held = Real<D>;
            #[inline]
            fn hold(value: $float) -> Real<D> {
                D::real(value)
            }
        }

        impl<D> Beside<$float, D> for $other {
            type Held = $float;
            #[inline]
            fn hold(value: $float) -> $float {
                value
            }
        }

        impl FromCast<$float> for $float {
            #[inline]
            fn from_cast(value: $float) -> Self {
                value
            }
        }

        impl FromCast<$float> for $other {
            #[inline]
            fn from_cast(value: $float) -> Self {
                value as Self
            }
        }

        #[diagnostic::do_not_recommend]
        impl<D, F> Number<D> for $float
        where
            F: Plain + FromCast<$float>,
            D: Dual<F> + Over<Primitive = F>,
        {
            #[inline]
            fn number(self) -> Real<D> {
                D::real(F::from_cast(self))
            }
        }

        impl Lower for Real<$float> {
            type Lowered = $float;
            #[inline]
            fn lower(self) -> $float {
                self.0
            }
        }
    )*};
}
floats!(f64 beside f32 f32 beside f64);

#[diagnostic::do_not_recommend]
impl<D> Lift<D> for Real<D> {
    type Lifted = Self;
    #[inline]
    fn lift(self) -> Self {
        self
    }
}

#[diagnostic::do_not_recommend]
impl<D> Number<D> for Real<D> {
    #[inline]
    fn number(self) -> Self {
        self
    }
}

macro_rules! unchanged {
    ($($type:ty)*) => {$(
        #[diagnostic::do_not_recommend]
        impl<D> Lift<D> for $type {
            type Lifted = Self;
            #[inline]
            fn lift(self) -> Self {
                self
            }
        }

        impl Lower for $type {
            type Lowered = Self;
            #[inline]
            fn lower(self) -> Self {
                self
            }
        }
    )*};
}
unchanged!(i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize bool);

macro_rules! casts {
    ($from:ty => $($to:ty)*) => {$(
        #[diagnostic::do_not_recommend]
        impl Integer<$to> for $from {
            #[inline]
            fn integer(self) -> $to {
                self as $to
            }
        }
    )*};
}

macro_rules! integers {
    ($($int:ty)*) => {$(
        casts!($int => i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize);

        impl FromCast<$int> for f64 {
            #[inline]
            fn from_cast(value: $int) -> Self {
                value as Self
            }
        }

        impl FromCast<$int> for f32 {
            #[inline]
            fn from_cast(value: $int) -> Self {
                value as Self
            }
        }

        #[diagnostic::do_not_recommend]
        impl<D, F> Number<D> for $int
        where
            F: Plain + FromCast<$int>,
            D: Dual<F> + Over<Primitive = F>,
        {
            #[inline]
            fn number(self) -> Real<D> {
                Real(D::from(F::from_cast(self)))
            }
        }
    )*};
}
integers!(i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize);
casts!(bool => i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize);

/// `number as f64`, `number as f32`.
pub trait FromCast<T> {
    /// The nearest number.
    fn from_cast(value: T) -> Self;
}

#[diagnostic::do_not_recommend]
impl<D, T: Lift<D>, const M: usize> Lift<D> for [T; M] {
    type Lifted = [T::Lifted; M];
    #[inline]
    fn lift(self) -> Self::Lifted {
        self.map(T::lift)
    }
}

impl<D, T: Given<D>, const M: usize> Given<D> for [T; M] {
    type Lifted = [T::Lifted; M];
    #[inline]
    fn lift(self) -> Self::Lifted {
        self.map(T::lift)
    }
}

impl<T: Lower, const M: usize> Lower for [T; M] {
    type Lowered = [T::Lowered; M];
    #[inline]
    fn lower(self) -> Self::Lowered {
        self.map(T::lower)
    }
}

#[diagnostic::do_not_recommend]
impl<D, T: Lift<D>> Lift<D> for Option<T> {
    type Lifted = Option<T::Lifted>;
    #[inline]
    fn lift(self) -> Self::Lifted {
        self.map(T::lift)
    }
}

impl<T: Lower> Lower for Option<T> {
    type Lowered = Option<T::Lowered>;
    #[inline]
    fn lower(self) -> Self::Lowered {
        self.map(T::lower)
    }
}

macro_rules! tuples {
    ($($name:ident)+) => {
        #[diagnostic::do_not_recommend]
        impl<D, $($name: Lift<D>),+> Lift<D> for ($($name,)+) {
            type Lifted = ($($name::Lifted,)+);
            #[inline]
            fn lift(self) -> Self::Lifted {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                ($($name.lift(),)+)
            }
        }

        impl<$($name: Lower),+> Lower for ($($name,)+) {
            type Lowered = ($($name::Lowered,)+);
            #[inline]
            fn lower(self) -> Self::Lowered {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                ($($name.lower(),)+)
            }
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C E);
tuples!(A B C E F);
tuples!(A B C E F G);
