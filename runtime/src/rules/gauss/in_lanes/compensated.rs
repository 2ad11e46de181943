//! Sums of several members with what rounding has left of each.

use crate::numbers::members::{each_coordinate, member, write_member};
use crate::numbers::{Mask, MemberVector, Members, Scalar};
use crate::rules::gauss::problem::Compensated;

/// [`Compensated`] of each member.
#[derive(Clone, Copy, Debug)]
pub(super) struct CompensatedMembers<T, const N: usize, const W: usize> {
    pub(super) value: MemberVector<T, N, W>,
    pub(super) rest: MemberVector<T, N, W>,
}

impl<T: Scalar, const N: usize, const W: usize> CompensatedMembers<T, N, W> {
    pub(super) fn zero() -> Self {
        let zero = [Members::splat(T::zero()); N];
        Self { value: zero, rest: zero }
    }

    pub(super) fn member(&self, lane: usize) -> Compensated<T, N> {
        Compensated { value: member(&self.value, lane), rest: member(&self.rest, lane) }
    }

    pub(super) fn write(&mut self, lane: usize, of: &Compensated<T, N>) {
        write_member(&mut self.value, lane, &of.value);
        write_member(&mut self.rest, lane, &of.rest);
    }

    /// [`Compensated::plus`] of each.
    #[inline(always)]
    pub(super) fn plus(&self, change: &MemberVector<T, N, W>) -> Self {
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
    #[inline(always)]
    pub(super) fn replace(&mut self, only_some: bool, condition: Mask<W>, other: &Self) {
        each_coordinate!(a => {
            self.value[a].replace(only_some, condition, other.value[a]);
            self.rest[a].replace(only_some, condition, other.rest[a]);
        });
    }
}
