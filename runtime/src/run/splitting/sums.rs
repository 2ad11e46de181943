//! How a splitting adds up what moves q and p.

use core::fmt::Debug;

/// The sums of a [`Splitting`](crate::Splitting): [`PlainSums`], or [`CompensatedSums`] after
/// [`compensated`](crate::Splitting::compensated).
pub trait Sums: Copy + Debug + Eq + Send + Sync + 'static {
    /// Whether what a step's sums lose is added in the next step.
    const ARE_COMPENSATED: bool;
}

/// Sums of q and p that are rounded at each drift and kick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlainSums;

/// Sums with compensation: what they lose in one step is added in the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompensatedSums;

impl Sums for PlainSums {
    const ARE_COMPENSATED: bool = false;
}

impl Sums for CompensatedSums {
    const ARE_COMPENSATED: bool = true;
}
