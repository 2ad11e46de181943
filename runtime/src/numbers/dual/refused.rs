//! Operations that have no derivative: bounds that no dual number has, for rustc to say so of their use.

/// A number that `%` may give in a differentiated body: an integer.
#[diagnostic::on_unimplemented(
    message = "`%` cannot be used on floating-point numbers of a differentiated body",
    label = "the remainder jumps, and has no derivative there",
    note = "angles need no wrapping: coordinates live in ℝ; for a periodic function use `sin` and `cos`"
)]
pub trait Remainder {}

/// A number that rounding and bit methods accept: no type is one, since they have no derivative.
#[diagnostic::on_unimplemented(
    message = "rounding and bit methods cannot be used in a differentiated body",
    label = "piecewise constant: it has no useful derivative",
    note = "leave it out, or choose between smooth cases with `if`"
)]
pub trait Roundable {}

/// A receiver of methods of one's own: no dual number is one, since such a method has no derivative.
#[diagnostic::on_unimplemented(
    message = "this method has no derivative over dual numbers",
    label = "no method of floating-point numbers that is differentiated",
    note = "of a trait of your own it is known for plain numbers alone: write it as a function of the annotated block, `fn curve(x: f64) -> f64`, and call that, `Self::curve(q[0])`; on fields and constants alone it can stay"
)]
pub trait Differentiated {}

/// `left % right`, given as `remainder(left % right)`, for integers.
#[inline]
pub fn remainder<T: Remainder>(remainder: T) -> T {
    remainder
}

macro_rules! integers {
    ($($int:ty)*) => {$(
        #[diagnostic::do_not_recommend]
        impl Remainder for $int {}
    )*};
}
integers!(i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize);
