//! The failure to solve a linear system.

/// A matrix that has no solution to working precision: the column whose pivot is lost to rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// The column.
    pub column: usize,
}
