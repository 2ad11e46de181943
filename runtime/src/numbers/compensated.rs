//! Sums that keep what rounding takes: of one run, and of several members.

use nalgebra::SVector;

use super::members::{each_coordinate, member, write_member};
use super::{Mask, MemberVector, Members, Scalar};

/// A vector as an unevaluated sum, so that adding many small steps loses nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compensated<T, const N: usize> {
    pub(crate) value: SVector<T, N>,
    /// The rounding error of `value`: the sum is `value` + `rest`.
    pub(crate) rest: SVector<T, N>,
}

impl<T: Scalar, const N: usize> Compensated<T, N> {
    pub(crate) fn new(value: SVector<T, N>) -> Self {
        Self { value, rest: nalgebra::zero() }
    }

    /// The sum with `change`, by the two-sum of Knuth.
    #[inline]
    pub(crate) fn plus(&self, change: &SVector<T, N>) -> Self {
        let mut sum = *self;
        for a in 0..N {
            let (value, change) = (self.value[a], change[a] + self.rest[a]);
            let total = value + change;
            let share = total - value;
            sum.value[a] = total;
            sum.rest[a] = (value - (total - share)) + (change - share);
        }
        sum
    }
}

/// [`Compensated`] of each member.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CompensatedMembers<T, const N: usize, const W: usize> {
    pub(crate) value: MemberVector<T, N, W>,
    pub(crate) rest: MemberVector<T, N, W>,
}

impl<T: Scalar, const N: usize, const W: usize> CompensatedMembers<T, N, W> {
    pub(crate) fn zero() -> Self {
        Self::new([Members::splat(T::zero()); N])
    }

    /// [`Compensated::new`] of each.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn new(value: MemberVector<T, N, W>) -> Self {
        Self { value, rest: [Members::splat(T::zero()); N] }
    }

    pub(crate) fn member(&self, lane: usize) -> Compensated<T, N> {
        Compensated { value: member(&self.value, lane), rest: member(&self.rest, lane) }
    }

    pub(crate) fn write(&mut self, lane: usize, of: &Compensated<T, N>) {
        write_member(&mut self.value, lane, &of.value);
        write_member(&mut self.rest, lane, &of.rest);
    }

    /// [`Compensated::plus`] of each.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn plus(&self, change: &MemberVector<T, N, W>) -> Self {
        let mut sum = *self;
        each_coordinate!(a => {
            let (value, change) = (self.value[a], change[a] + self.rest[a]);
            let total = value + change;
            let share = total - value;
            sum.value[a] = total;
            sum.rest[a] = (value - (total - share)) + (change - share);
        });
        sum
    }

    /// [`Members::replace`] of each number.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn replace(&mut self, only_some: bool, condition: Mask<W>, other: &Self) {
        each_coordinate!(a => {
            self.value[a].replace(only_some, condition, other.value[a]);
            self.rest[a].replace(only_some, condition, other.rest[a]);
        });
    }
}
