//! Tables as other languages give them: points, and the interpolation between them by a number.

use dalembert::system::{Interpolation, Scalar, Table, TableError};

use crate::fields::{FieldType, sealed};
use crate::number::Number;
use crate::wrong_points::{PointsError, interpolation_number};

/// The points of a [`Table`], laid out as C does: what other languages give in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Points<T, const K: usize> {
    /// The x, in increasing order.
    pub x: [T; K],
    /// The y.
    pub y: [T; K],
    /// The interpolation between the points: its [number](interpolation_number).
    pub interpolation: i32,
    /// Whether the table goes on by its slope beyond its ends: 0 where it keeps its value there.
    pub straight_beyond: i32,
}

/// 0, 1, …, and 0 at each of them, with straight lines between: the table that is 0.
macro_rules! flat {
    ($number:ident, $k:ident) => {{
        let mut x = [0 as $number; $k];
        let mut i = 0;
        while i < $k {
            x[i] = i as $number;
            i += 1;
        }
        (x, [0 as $number; $k])
    }};
}

macro_rules! tables {
    ($($number:ident, |$table:ident| $rounded:expr;)*) => { $(
        impl<const K: usize> sealed::Listed for Points<$number, K> {}
        impl<const K: usize> sealed::Listed for Table<K, $number> {}

        /// Of its numbers the x come first, then the y; then the interpolation and what is beyond.
        impl<const K: usize> FieldType for Points<$number, K> {
            type Given = Self;
            const BASE: &'static str = <$number as FieldType>::BASE;
            const DIMENSIONS: &'static [usize] = &[2, K];
            const IS_TABLE: bool = true;
            const ZERO: Self = {
                let (x, y) = flat!($number, K);
                let interpolation = interpolation_number(Interpolation::Linear);
                Self { x, y, interpolation, straight_beyond: 0 }
            };

            fn given(&self) -> Self {
                *self
            }

            fn of(given: &Self) -> Result<Self, PointsError> {
                Ok(*given)
            }

            /// Never: points that are NaN make no table, and are named there.
            fn has_nan(&self) -> bool {
                false
            }

            fn entry(&self, index: usize) -> Option<Number> {
                let after = index.checked_sub(2 * K);
                match after {
                    None => self.x.iter().chain(&self.y).nth(index)?.entry(0),
                    Some(0) => self.interpolation.entry(0),
                    Some(1) => self.straight_beyond.entry(0),
                    Some(_) => None,
                }
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                let after = index.checked_sub(2 * K);
                match after {
                    None => {
                        let number = self.x.iter_mut().chain(&mut self.y).nth(index);
                        number.is_some_and(|number| number.change_entry(0, value))
                    }
                    Some(0) => self.interpolation.change_entry(0, value),
                    Some(1) => self.straight_beyond.change_entry(0, value),
                    Some(_) => false,
                }
            }
        }

        /// Its numbers are those of its points, and do not change one by one.
        impl<const K: usize> FieldType for Table<K, $number> {
            type Given = Points<$number, K>;
            const BASE: &'static str = <$number as FieldType>::BASE;
            const DIMENSIONS: &'static [usize] = &[2, K];
            const IS_TABLE: bool = true;
            const ZERO: Self = {
                let (x, y) = flat!(f64, K);
                let Ok($table) = Table::linear(x, y) else { panic!("a table has two points or more") };
                let Ok(rounded) = $rounded else { panic!("a table has fewer points") };
                rounded
            };

            fn given(&self) -> Self::Given {
                Points {
                    x: *self.knots(),
                    y: self.values(),
                    interpolation: interpolation_number(self.interpolation()),
                    straight_beyond: self.is_straight_beyond().into(),
                }
            }

            fn of(given: &Self::Given) -> Result<Self, PointsError> {
                let number = given.interpolation;
                let of = Interpolation::ALL.into_iter().find(|of| interpolation_number(*of) == number);
                let of = of.ok_or(PointsError::NoInterpolation { number })?;
                let [x, y] = [given.x, given.y].map(|numbers| numbers.map(Scalar::widen));
                let $table = Table::through(of, x, y).map_err(PointsError::Points)?;
                let table = $rounded.map_err(PointsError::Points)?;
                Ok(if given.straight_beyond == 0 { table } else { table.straight_beyond() })
            }

            fn has_nan(&self) -> bool {
                false
            }

            fn entry(&self, index: usize) -> Option<Number> {
                self.given().entry(index)
            }

            fn change_entry(&mut self, _index: usize, _value: Number) -> bool {
                false
            }
        }
    )* };
}

tables! {
    f64, |table| Ok::<Self, TableError>(table);
    f32, |table| table.single();
}
