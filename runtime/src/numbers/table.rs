//! Curves given by points: a cubic between each two knots.
//!
//! ```text
//! f(x) = c₀ + c₁ s + c₂ s² + c₃ s³,   s = x − xᵢ,   xᵢ ≤ x < xᵢ₊₁
//! ```
//!
//! The value at a knot is that of the point to the last bit. Beyond the ends f keeps its value, goes on by
//! its slope, or repeats itself.

mod error;
mod pieces;
mod points;

pub use error::{Interpolation, TableError};

use crate::numbers::{Curve, Scalar};

/// The course of a table beyond its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Beyond {
    Held,
    Straight,
    Repeated,
}

impl Beyond {
    /// The course that an interpolation has unless it is told otherwise.
    const fn after(of: Interpolation) -> Self {
        if matches!(of, Interpolation::Periodic) { Self::Repeated } else { Self::Held }
    }
}

/// A curve through K points, which it holds: an array of knots and one of cubics, without `std`.
///
/// | made by | between the points | continuous | |
/// |---|---|---|---|
/// | [`linear`](Self::linear) | lines | f | |
/// | [`spline`](Self::spline) | cubics | f, f′, f″ | as `CubicSpline` of SciPy |
/// | [`monotone`](Self::monotone) | cubics | f, f′ | as `PchipInterpolator` of SciPy |
/// | [`periodic`](Self::periodic) | cubics | f, f′, f″ | goes on for ever |
///
/// At a knot derivatives are those to its right, at the last one those to its left. Beyond the ends f keeps
/// the value of the end point, with derivatives 0, as a thrust does after the fire is out; after
/// [`straight_beyond`](Self::straight_beyond) it goes on by the slope that it has at the end. f(NaN) is NaN.
///
/// Points are looked at once, here: a table that exists is right. In a constant a wrong one ends the
/// compiler:
///
/// ```
/// use dalembert::system::{Table, TableError};
///
/// /// Drag coefficient over the Mach number.
/// const DRAG: Table<5> = match Table::monotone([0.0, 0.8, 1.0, 1.2, 3.0], [0.3, 0.32, 0.6, 0.7, 0.4]) {
///     Ok(table) => table,
///     Err(_) => panic!("the Mach numbers do not increase"),
/// };
/// assert_eq!([DRAG.at(1.0), DRAG.at(9.0)], [0.6, 0.4]);
///
/// let wrong = Table::linear([0.0, 1.0, 1.0], [0.0, 2.0, 3.0]);
/// assert!(matches!(wrong, Err(TableError::NotIncreasing { index: 2, .. })));
/// ```
///
/// # Order across knots
///
/// Where a force, which is f itself or f′ of a table in L, has a jump in its k-th derivative, a step over the
/// knot adds an error of order k + 1, to which Gauss rules of high order fall back: 3 where a spline is in L,
/// 2 where it is monotone. A run that ends its steps at the knot keeps its order: by a terminal event of
/// [`watch`](crate::Trajectory::watch) at `q − knot`. A linear table in L has a force that jumps, where the
/// equation of a step may have no solution: take a spline there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table<const K: usize, T = f64> {
    knots: [T; K],
    pieces: [[T; 4]; K],
    of: Interpolation,
    beyond: Beyond,
}

/// A curve through points whose number is known when the program runs, in slices of the caller's: what a
/// [`Table`] is with arrays of its own.
///
/// A system owns what it is made of, so that a field is a `TableSlice<'static>`, of data that live as long as
/// the program:
///
/// ```
/// use dalembert::system::{TableError, TableSlice};
///
/// let file = "0.0 12.0\n0.5 30.0\n2.0 25.0\n2.2 0.0";
/// let numbers = |column| file.lines().filter_map(move |line| line.split(' ').nth(column)?.parse().ok());
/// let (times, thrusts): (Vec<f64>, Vec<f64>) = (numbers(0).collect(), numbers(1).collect());
///
/// let pieces = vec![[0.0; 4]; times.len()];
/// let thrust: TableSlice<'static> = TableSlice::linear(times.leak(), &thrusts, pieces.leak())?;
/// assert_eq!([thrust.at(0.25), thrust.at(5.0)], [21.0, 0.0]);
/// # Ok::<(), TableError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSlice<'t, T = f64> {
    knots: &'t [T],
    pieces: &'t [[T; 4]],
    beyond: Beyond,
}

/// The constructors, of which there is one for each interpolation, of both kinds of tables.
macro_rules! constructors {
    ($($(#[$doc:meta])* $name:ident $kind:ident;)*) => {
        /// Constructors, which a constant may call.
        impl<const K: usize> Table<K> {
            $(
                $(#[$doc])*
                ///
                /// # Errors
                ///
                /// [`TableError`]: the first x that is not above the one before, the first number that is NaN
                /// or infinite, too few points, or a slope beyond the largest number.
                pub const fn $name(x: [f64; K], y: [f64; K]) -> Result<Self, TableError> {
                    Self::through(Interpolation::$kind, x, y)
                }
            )*

            /// The table of an interpolation that is known when the program runs.
            ///
            /// # Errors
            ///
            /// [`TableError`]: those of the constructor of that name.
            pub const fn through(of: Interpolation, x: [f64; K], y: [f64; K]) -> Result<Self, TableError> {
                let mut pieces = [[0.0; 4]; K];
                match pieces::fill(of, &x, &y, &mut pieces) {
                    Ok(()) => Ok(Self { knots: x, pieces, of, beyond: Beyond::after(of) }),
                    Err(error) => Err(error),
                }
            }
        }

        /// Constructors: `pieces`, as long as x and y, is written over.
        impl<'t> TableSlice<'t> {
            $(
                $(#[$doc])*
                ///
                /// # Errors
                ///
                /// [`TableError`]: as those of [`Table`], and slices of different lengths.
                pub const fn $name(
                    x: &'t [f64],
                    y: &[f64],
                    pieces: &'t mut [[f64; 4]],
                ) -> Result<Self, TableError> {
                    Self::through(Interpolation::$kind, x, y, pieces)
                }
            )*

            /// The table of an interpolation that is known when the program runs.
            ///
            /// # Errors
            ///
            /// [`TableError`]: those of the constructor of that name.
            pub const fn through(
                of: Interpolation,
                x: &'t [f64],
                y: &[f64],
                pieces: &'t mut [[f64; 4]],
            ) -> Result<Self, TableError> {
                match pieces::fill(of, x, y, pieces) {
                    Ok(()) => Ok(Self { knots: x, pieces, beyond: Beyond::after(of) }),
                    Err(error) => Err(error),
                }
            }
        }
    };
}
constructors! {
    /// Straight lines between the points, at least two of them.
    linear Linear;
    /// The cubics whose second derivatives are continuous, and the third ones at the second knot from either
    /// end: the not-a-knot spline. Of three points it is a parabola, of two a line.
    spline Spline;
    /// Cubics that rise and fall where the points do, and turn at points alone (Fritsch and Butland).
    monotone Monotone;
    /// The periodic spline, of at least three points; the last is the first of the next turn, and has its
    /// value.
    periodic Periodic;
}

impl<const K: usize> Table<K> {
    /// The table for systems in single precision, its numbers rounded.
    ///
    /// # Errors
    ///
    /// [`TableError`]: numbers that are too large for `f32`, knots that it does not tell apart.
    pub const fn single(&self) -> Result<Table<K, f32>, TableError> {
        let (mut knots, mut pieces) = ([0.0; K], [[0.0; 4]; K]);
        match pieces::round((&self.knots, &self.pieces), (&mut knots, &mut pieces)) {
            Ok(()) => Ok(Table { knots, pieces, of: self.of, beyond: self.beyond }),
            Err(error) => Err(error),
        }
    }
}

impl TableSlice<'_> {
    /// The table for systems in single precision, its numbers rounded, in slices of its length.
    ///
    /// # Errors
    ///
    /// [`TableError`]: numbers that are too large for `f32`, knots that it does not tell apart; slices of
    /// another length.
    pub const fn single<'s>(
        &self,
        knots: &'s mut [f32],
        pieces: &'s mut [[f32; 4]],
    ) -> Result<TableSlice<'s, f32>, TableError> {
        match pieces::round((self.knots, self.pieces), (knots, pieces)) {
            Ok(()) => Ok(TableSlice { knots, pieces, beyond: self.beyond }),
            Err(error) => Err(error),
        }
    }
}

impl<const K: usize, T: Scalar> Table<K, T> {
    /// The table as one of slices.
    #[must_use]
    pub const fn as_slice(&self) -> TableSlice<'_, T> {
        TableSlice { knots: &self.knots, pieces: &self.pieces, beyond: self.beyond }
    }

    /// The table that goes on by the slope at its ends, as a spring does beyond what was measured.
    #[must_use]
    pub const fn straight_beyond(self) -> Self {
        Self { beyond: Beyond::Straight, ..self }
    }

    /// The x of the points, in order.
    #[must_use]
    pub const fn knots(&self) -> &[T; K] {
        &self.knots
    }

    /// The y of the points, in order.
    #[must_use]
    pub fn values(&self) -> [T; K] {
        self.pieces.map(|[value, ..]| value)
    }

    /// The interpolation between the points.
    #[must_use]
    pub const fn interpolation(&self) -> Interpolation {
        self.of
    }

    /// Whether the table goes on by the slope at its ends.
    #[must_use]
    pub const fn is_straight_beyond(&self) -> bool {
        matches!(self.beyond, Beyond::Straight)
    }

    /// f(x).
    #[inline]
    #[must_use]
    pub fn at(&self, x: T) -> T {
        Curve::at(self, x)
    }
}

impl<'t, T: Scalar> TableSlice<'t, T> {
    /// The table that goes on by the slope at its ends.
    #[must_use]
    pub const fn straight_beyond(self) -> Self {
        Self { beyond: Beyond::Straight, ..self }
    }

    /// The x of the points, in order.
    #[must_use]
    pub const fn knots(&self) -> &'t [T] {
        self.knots
    }

    /// f(x).
    #[inline]
    #[must_use]
    pub fn at(&self, x: T) -> T {
        Curve::at(self, x)
    }
}

impl<const K: usize, T: Scalar> Curve<T> for Table<K, T> {
    #[inline]
    fn derivatives(&self, x: T) -> [T; 4] {
        self.as_slice().derivatives(x)
    }
}

impl<T: Scalar> Curve<T> for TableSlice<'_, T> {
    fn derivatives(&self, x: T) -> [T; 4] {
        let (Some(&first), Some(&last)) = (self.knots.first(), self.knots.last()) else {
            return [T::constant(f64::NAN); 4];
        };
        let x = if self.beyond == Beyond::Repeated { within(x, first, last) } else { x };
        let passed = self.knots.partition_point(|knot| *knot <= x);
        let index = passed.saturating_sub(1);
        let (Some(&knot), Some(&[c0, c1, c2, c3])) = (self.knots.get(index), self.pieces.get(index)) else {
            return [T::constant(f64::NAN); 4];
        };
        let (s, zero) = (x - knot, T::zero());
        match self.beyond {
            Beyond::Held if x < first || x > last => [c0, zero, zero, zero],
            Beyond::Straight if x < first || x > last => [c0 + c1 * s, c1, zero, zero],
            _ => {
                let (twice, six) = (c2 + c2, T::constant(6.0) * c3);
                let thrice = T::constant(3.0) * c3;
                [c0 + s * (c1 + s * (c2 + s * c3)), c1 + s * (twice + s * thrice), twice + s * six, six]
            }
        }
    }
}

/// x less whole periods, from `first` to `last`.
fn within<T: Scalar>(x: T, first: T, last: T) -> T {
    let period = last - first;
    let turns = ((x - first) / period).widen();
    // Rounded down, without a function of the standard library.
    let whole = turns as i64 as f64;
    let whole = if whole > turns { whole - 1.0 } else { whole };
    x - T::constant(whole) * period
}
