//! Two ways to one quantity, held against each other: slopes of a function against its differences, momenta
//! of a step against derivatives.
//!
//! A run does so once, where it starts. So, as in [`nonlinear`](crate::numbers::nonlinear), what compares
//! works on slices, asks for values through pointers, and is compiled once for each scalar type, with this
//! crate ([`Compares`]): a program has no more of it than what writes its functions to slices. It neither
//! allocates nor panics.

mod along;
mod lost;
mod momenta;
mod places;
mod slope;

use crate::numbers::nonlinear::Room;

pub use along::Sides;
pub use momenta::{Apart, TwoWays};
pub use places::Unit;

/// Vectors in use at once where slopes are compared: 2 for a direction, 4 for the place and the direction of
/// one coordinate, 4 for a place on the line and partial derivatives there.
pub(crate) const SLOPES: usize = 10;

/// Vectors in use at once where momenta are compared: 3 for the segment, 4 of each way, and 2 and 4 for
/// another segment.
pub(crate) const MOMENTA: usize = 17;

/// Functions that are compiled once for each scalar type, in this crate, and not in each program that has a
/// system.
pub trait Compares: Sized {
    /// The slope of a function from its partial derivatives along one direction, and by differences, where
    /// those leave no doubt that it is another, nor that some partial derivative is.
    fn slopes_apart(q: &[Self], v: &[Self], of: &Sides<'_, Self>, room: Room<'_, Self>) -> Option<[f64; 2]>;

    /// The direction at (q, v), written to `a` and `b`, along which a function is differentiated that is
    /// compared along another one.
    fn other_direction(q: &[Self], v: &[Self], a: &mut [Self], b: &mut [Self]);

    /// Shares of the components of a vector in a sum, with a part of each.
    fn shares(of: &mut [Self]);

    /// The momentum by which two ways differ at three points beside (q, v), for steps of size `h`.
    fn momenta_apart(
        q: &[Self],
        v: &[Self],
        h: Self,
        of: &TwoWays<'_, Self>,
        room: Room<'_, Self>,
    ) -> Option<Apart>;

    /// A point away from `x` by a `distance` in these units, in no special direction.
    fn beside(x: &[Self], distance: f64, unit: Unit, beside: &mut [Self]);

    /// Whether an entry is far below 1, and one whose own size differences may have.
    fn has_tiny(point: &[Self]) -> bool;

    /// Solves for `x` where the matrix is diagonal, without a 0 there.
    fn is_solved_by_diagonal(matrix: &[Self], right: &[Self], x: &mut [Self]) -> bool;

    /// The first coordinate that a derivative of a function by it is not finite: first derivatives `by_one`,
    /// second ones by x twice, by x and y, and by y twice, in columns.
    fn coordinate_lost(by_one: [&[Self]; 2], by_two: [&[Self]; 3]) -> Option<usize>;

    /// The first component of a covector with a value or a derivative that is not finite, and the coordinate
    /// of that.
    fn component_lost(value: &[Self], by_one: [&[Self]; 2]) -> Option<(usize, usize)>;

    /// Whether all entries are finite.
    fn are_finite(entries: &[Self]) -> bool;
}

macro_rules! compiled_for {
    ($($scalar:ty)*) => {$(
        impl Compares for $scalar {
            #[cold]
            #[inline(never)]
            fn slopes_apart(
                q: &[Self],
                v: &[Self],
                of: &Sides<'_, Self>,
                room: Room<'_, Self>,
            ) -> Option<[f64; 2]> {
                along::apart(q, v, of, room)
            }

            #[cold]
            #[inline(never)]
            fn other_direction(q: &[Self], v: &[Self], a: &mut [Self], b: &mut [Self]) {
                along::other_direction(q, v, a, b);
            }

            #[cold]
            #[inline(never)]
            fn shares(of: &mut [Self]) {
                along::shares(of);
            }

            #[cold]
            #[inline(never)]
            fn momenta_apart(
                q: &[Self],
                v: &[Self],
                h: Self,
                of: &TwoWays<'_, Self>,
                room: Room<'_, Self>,
            ) -> Option<Apart> {
                momenta::apart(q, v, h, of, room)
            }

            #[cold]
            #[inline(never)]
            fn beside(x: &[Self], distance: f64, unit: Unit, beside: &mut [Self]) {
                places::beside(x, distance, unit, beside);
            }

            #[cold]
            #[inline(never)]
            fn has_tiny(point: &[Self]) -> bool {
                places::has_tiny(point)
            }

            #[cold]
            #[inline(never)]
            fn is_solved_by_diagonal(matrix: &[Self], right: &[Self], x: &mut [Self]) -> bool {
                places::is_solved_by_diagonal(matrix, right, x)
            }

            #[cold]
            #[inline(never)]
            fn coordinate_lost(by_one: [&[Self]; 2], by_two: [&[Self]; 3]) -> Option<usize> {
                lost::coordinate(by_one, by_two)
            }

            #[cold]
            #[inline(never)]
            fn component_lost(value: &[Self], by_one: [&[Self]; 2]) -> Option<(usize, usize)> {
                lost::component(value, by_one)
            }

            #[cold]
            #[inline(never)]
            fn are_finite(entries: &[Self]) -> bool {
                lost::are_finite(entries)
            }
        }
    )*};
}
compiled_for!(f64 f32);
