//! Why points that other languages give make no table.

use core::fmt;

use dalembert::system::{Interpolation, TableError};

/// The number that other languages call an interpolation by: from 1 on, so that 0 is none that was forgotten.
#[must_use]
pub const fn interpolation_number(of: Interpolation) -> i32 {
    of as i32 + 1
}

/// Why points that were given make no table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointsError {
    /// The number is that of no interpolation.
    NoInterpolation {
        /// The number.
        number: i32,
    },
    /// The points are wrong.
    Points(TableError),
}

impl PointsError {
    /// The place of the point that is wrong, of those that are wrong by themselves.
    #[must_use]
    pub const fn point(&self) -> Option<usize> {
        match *self {
            Self::Points(
                TableError::KnotNotFinite { index, .. }
                | TableError::ValueNotFinite { index, .. }
                | TableError::NotIncreasing { index, .. }
                | TableError::TooSteep { index, .. }
                | TableError::SinglePrecision { index },
            ) => Some(index),
            _ => None,
        }
    }
}

impl fmt::Display for PointsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoInterpolation { number } => {
                write!(f, "{number} is no interpolation; give ")?;
                Interpolation::ALL.iter().enumerate().try_for_each(|(i, &of)| {
                    let between = ["", ", ", ", ", " or "];
                    write!(f, "{}{} ({of})", between[i], interpolation_number(of))
                })
            }
            Self::Points(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for PointsError {}

/// A field whose points make no table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrongPoints {
    /// The number of the field.
    pub field: usize,
    /// Its name.
    pub name: &'static str,
    /// Why the points make no table.
    pub error: PointsError,
}

impl fmt::Display for WrongPoints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`: {}", self.name, self.error)
    }
}

impl core::error::Error for WrongPoints {}
