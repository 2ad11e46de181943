//! The sizes that a sweep over the stages of several members shows.

use crate::numbers::members::coordinate_by_coordinate;
use crate::numbers::{MemberVector, Members, Scalar};

/// The sizes of the residuals and corrections of one sweep.
#[derive(Clone, Copy)]
pub(super) struct Seen<T, const N: usize, const W: usize> {
    /// The largest residual of each coordinate.
    pub(super) residual: MemberVector<T, N, W>,
    /// The largest correction.
    pub(super) correction: Members<T, W>,
    /// The sum of all, in which NaN and infinity stay.
    pub(super) sum: Members<T, W>,
}

impl<T: Scalar, const N: usize, const W: usize> Seen<T, N, W> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn nothing() -> Self {
        let none = Members::splat(T::zero());
        Self { residual: [none; N], correction: none, sum: none }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn of_both([a, b]: &[Self; 2]) -> Self {
        let mut residual = a.residual;
        coordinate_by_coordinate!(i => {
            residual[i] = a.residual[i].larger(b.residual[i]);
        });
        Self { residual, correction: a.correction.larger(b.correction), sum: a.sum + b.sum }
    }
}
