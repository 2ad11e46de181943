//! The errors of points that make no table.

use core::fmt;

/// The way from points to a function: the name of a constructor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Interpolation {
    /// [`Table::linear`](crate::system::Table::linear).
    Linear,
    /// [`Table::spline`](crate::system::Table::spline).
    Spline,
    /// [`Table::monotone`](crate::system::Table::monotone).
    Monotone,
    /// [`Table::periodic`](crate::system::Table::periodic).
    Periodic,
}

impl Interpolation {
    /// All of them, in the order of [`Table`](crate::system::Table)'s constructors.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Spline, Self::Monotone, Self::Periodic];

    /// The fewest points.
    pub(super) const fn fewest(self) -> usize {
        if matches!(self, Self::Periodic) { 3 } else { 2 }
    }
}

impl fmt::Display for Interpolation {
    /// The name of the constructor.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Linear => "linear",
            Self::Spline => "spline",
            Self::Monotone => "monotone",
            Self::Periodic => "periodic",
        })
    }
}

/// Why points make no table: the first that is wrong.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum TableError {
    /// There are fewer points than the interpolation needs.
    TooShort {
        /// The constructor.
        of: Interpolation,
        /// How many there are.
        points: usize,
    },
    /// The slices are of different lengths.
    Lengths {
        /// The length of x.
        x: usize,
        /// The length of y.
        y: usize,
        /// The length of the slice for the cubics.
        pieces: usize,
    },
    /// An x is NaN or infinite, or its distance from the first one is.
    KnotNotFinite {
        /// The constructor.
        of: Interpolation,
        /// The place in x.
        index: usize,
    },
    /// A y is NaN or infinite.
    ValueNotFinite {
        /// The constructor.
        of: Interpolation,
        /// The place in y.
        index: usize,
    },
    /// An x is not above the one before.
    NotIncreasing {
        /// The constructor.
        of: Interpolation,
        /// The place in x.
        index: usize,
        /// The x before.
        before: f64,
        /// The x there.
        x: f64,
    },
    /// The last y is another than the first one, which it is a period later.
    NotPeriodic {
        /// The first y.
        first: f64,
        /// The last y.
        last: f64,
    },
    /// A coefficient of the cubic that starts at a point is beyond the largest number: points are too close
    /// to each other for their values.
    TooSteep {
        /// The constructor.
        of: Interpolation,
        /// The place of the point.
        index: usize,
    },
    /// In single precision a point is not above the one before, or a number of its cubic is too large.
    SinglePrecision {
        /// The place of the point.
        index: usize,
    },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooShort { of, points } => {
                write!(f, "`Table::{of}`: {points} points are too few; give at least {}", of.fewest())
            }
            Self::Lengths { x, y, pieces } => write!(
                f,
                "`TableSlice`: x has {x} numbers, y {y} and pieces {pieces}; give one y and one piece for each x"
            ),
            Self::KnotNotFinite { of, index } => {
                write!(
                    f,
                    "`Table::{of}`: x[{index}] is NaN, infinite or infinitely far from x[0]; leave the point out"
                )
            }
            Self::ValueNotFinite { of, index } => {
                write!(f, "`Table::{of}`: y[{index}] is NaN or infinite; leave the point out")
            }
            Self::NotIncreasing { of, index, before, x } => write!(
                f,
                "`Table::{of}`: x[{index}] = {x} is not above x[{}] = {before}; sort the points by x, and keep one of each x",
                index.saturating_sub(1)
            ),
            Self::NotPeriodic { first, last } => write!(
                f,
                "`Table::periodic`: the last y is {last} and the first {first}; end with the first point of the next turn"
            ),
            Self::TooSteep { of, index } => write!(
                f,
                "`Table::{of}`: the cubic from point {index} on has a coefficient beyond the largest number; its points are too close for their values"
            ),
            Self::SinglePrecision { index } => write!(
                f,
                "`Table::single`: `f32` does not tell point {index} from the one before, or cannot hold its numbers; leave it out, or choose other units"
            ),
        }
    }
}

debug_by_display!(TableError);

impl core::error::Error for TableError {}
