//! Numbers side by side, one for each of several runs: what is computed of one is computed of all at once,
//! with the very roundings that it has alone.
//!
//! Unlike [`Lanes`](crate::generated::Lanes), which hold the stages of one step, these have neither vector
//! types nor functions of their own: arrays, loops over them, and functions of numbers. The compiler
//! turns the loops into the widest instructions of the function that they are inlined into, so that a caller
//! compiled for several instruction sets chooses when it runs. Nothing on the way may stay a call: hence
//! `inline(always)`, and no iterator or closure that might.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

mod functions;
mod operators;

use nalgebra::SVector;

use crate::numbers::{Mask, Scalar, product_plus};

/// The block for every coordinate, unrolled for the first 16: those that there are, as the conditions are
/// constants.
///
/// Where a loop over coordinates remains and that over members does not, LLVM makes vectors of a coordinate's
/// neighbours, gathered and scattered with AVX-512: 6 times as slow. The index of the others is kept from it.
macro_rules! each_coordinate {
    ($index:ident => $block:block) => {
        $crate::numbers::members::each_coordinate!(@unrolled [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15] $index $block);
        for index in 16..N {
            let $index = core::hint::black_box(index).min(N - 1);
            $block
        }
    };
    (@unrolled [$($known:literal)*] $index:ident $block:block) => {$(
        if const { $known < N } {
            let $index = $known;
            $block
        }
    )*};
}

/// The block for every coordinate, one after the other: of blocks that are long, or many in one function, and
/// would take as many times as long to compile if they were unrolled. LLVM does not see that the index
/// counts.
macro_rules! coordinate_by_coordinate {
    ($index:ident => $block:block) => {
        if const { N <= 2 } {
            $crate::numbers::members::each_coordinate!(@unrolled [0 1] $index $block);
        } else {
            let all = core::hint::black_box(const { $crate::numbers::members::counted::<N>() });
            $crate::numbers::members::coordinate_by_coordinate!($index of all => $block);
        }
    };
    // Of those in an array or a part of it.
    ($index:ident of $some:ident => $block:block) => {
        for index in &$some[..] {
            let $index = (*index).min(N - 1);
            $block
        }
    };
}

/// The block for every stage, S ≤ 8 of them, unrolled.
macro_rules! each_stage {
    ($index:ident => $block:block) => {
        $crate::numbers::members::each_stage!(@unrolled [0 1 2 3 4 5 6 7] $index $block);
    };
    (@unrolled [$($known:literal)*] $index:ident $block:block) => {$(
        if const { $known < S } {
            let $index = $known;
            $block
        }
    )*};
}

/// The block for every stage, one after the other: of blocks that are long. LLVM does not see that the index
/// counts, and makes no vectors of stages.
macro_rules! stage_by_stage {
    ($index:ident => $block:block) => {
        for index in 0..S {
            let $index = core::hint::black_box(index).min(S - 1);
            $block
        }
    };
}

/// The block for every member.
///
/// Tested at its end: LLVM would turn a loop over a range into this one, at a cost that grows with the
/// function that it has been inlined into.
macro_rules! each_member {
    ($index:ident => $block:block) => {
        if const { W > 0 } {
            let mut $index = 0;
            loop {
                $block
                $index += 1;
                if $index >= W {
                    break;
                }
            }
        }
    };
}

pub(crate) use {coordinate_by_coordinate, each_coordinate, each_member, each_stage, stage_by_stage};

/// 0, 1, …, N − 1.
pub(crate) const fn counted<const N: usize>() -> [usize; N] {
    let mut counted = [0; N];
    let mut i = 0;
    while i < N {
        counted[i] = i;
        i += 1;
    }
    counted
}

/// One number of each of W members. Operators and functions act on each of them as on a number alone, to the
/// last bit. Aligned to lines of the cache, so that no vector stands across two.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Members<T, const W: usize>(pub [T; W]);

/// Values that are there before anything is known of them.
pub trait Blank: Copy {
    /// 0 or false, or what nothing starts from.
    fn blank() -> Self;
}

impl Blank for () {
    fn blank() -> Self {}
}

impl<T: Scalar, const W: usize> Blank for Members<T, W> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn blank() -> Self {
        Self::splat(T::zero())
    }
}

impl<const W: usize> Blank for Mask<W> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn blank() -> Self {
        Self::splat(false)
    }
}

impl<A: Blank, const K: usize> Blank for [A; K] {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn blank() -> Self {
        [A::blank(); K]
    }
}

impl<A: Blank, B: Blank> Blank for (A, B) {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn blank() -> Self {
        (A::blank(), B::blank())
    }
}

/// A vector of N coordinates of each of W members.
pub type MemberVector<T, const N: usize, const W: usize> = [Members<T, W>; N];

impl<T: Scalar, const W: usize> Members<T, W> {
    /// One number for every member.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn splat(value: T) -> Self {
        Self([value; W])
    }

    /// K numbers of each member.
    #[inline]
    #[must_use]
    pub fn of_each<const K: usize>(numbers: [[T; K]; W]) -> [Self; K] {
        let mut all = [Self::splat(T::zero()); K];
        for (member, numbers) in numbers.into_iter().enumerate() {
            for (all, number) in all.iter_mut().zip(numbers) {
                all.0[member] = number;
            }
        }
        all
    }

    /// self × factor + term, rounded once where that is asked for or the target of the build has an
    /// instruction for it, as that of [`Lanes`](crate::generated::Lanes): not where a function is compiled
    /// for more than the build is.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn times_plus(self, is_fused: bool, factor: T, term: Self) -> Self {
        let mut result = term;
        each_member!(i => {
            result.0[i] = product_plus(is_fused, self.0[i], factor, term.0[i]);
        });
        result
    }

    /// Member by member, the larger; where one is NaN, either.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn larger(self, other: Self) -> Self {
        let mut larger = other;
        each_member!(i => {
            larger.0[i] = if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] };
        });
        larger
    }

    /// Member by member, `a` where the condition holds and `b` where it does not.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn select(condition: Mask<W>, a: Self, b: Self) -> Self {
        let mut selected = b;
        each_member!(i => {
            selected.0[i] = if condition.0[i] { a.0[i] } else { b.0[i] };
        });
        selected
    }

    /// The numbers of `other`; with `only_some` those alone that the condition holds for, otherwise all,
    /// without looking at it.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn replace(&mut self, only_some: bool, condition: Mask<W>, other: Self) {
        *self = if only_some { Self::select(condition, other, *self) } else { other };
    }

    /// self < other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn less(self, other: Self) -> Mask<W> {
        let mut mask = Mask([false; W]);
        each_member!(i => {
            mask.0[i] = self.0[i] < other.0[i];
        });
        mask
    }

    /// self ≤ other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn less_or_equal(self, other: Self) -> Mask<W> {
        let mut mask = Mask([false; W]);
        each_member!(i => {
            mask.0[i] = self.0[i] <= other.0[i];
        });
        mask
    }

    /// self = other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn equal(self, other: Self) -> Mask<W> {
        let mut mask = Mask([false; W]);
        each_member!(i => {
            mask.0[i] = self.0[i] == other.0[i];
        });
        mask
    }

    /// Which members are NaN.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_nan(self) -> Mask<W> {
        !self.equal(self)
    }

    /// Which members are finite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_finite(self) -> Mask<W> {
        let mut mask = Mask([false; W]);
        each_member!(i => {
            mask.0[i] = self.0[i].is_finite();
        });
        mask
    }

    /// Which members are infinite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_infinite(self) -> Mask<W> {
        !(self.is_finite() | self.is_nan())
    }

    /// Which members have the sign bit set.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_sign_negative(self) -> Mask<W> {
        let mut mask = Mask([false; W]);
        each_member!(i => {
            mask.0[i] = self.0[i].is_sign_negative();
        });
        mask
    }

    /// Which members do not have the sign bit set.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_sign_positive(self) -> Mask<W> {
        !self.is_sign_negative()
    }
}

/// a − b.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn difference<T: Scalar, const N: usize, const W: usize>(
    a: &MemberVector<T, N, W>,
    b: &MemberVector<T, N, W>,
) -> MemberVector<T, N, W> {
    let mut difference = *a;
    each_coordinate!(i => {
        difference[i] = a[i] - b[i];
    });
    difference
}

/// The vector of one member; 0 where there is no such member.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn member<T: Scalar, const N: usize, const W: usize>(
    members: &MemberVector<T, N, W>,
    index: usize,
) -> SVector<T, N> {
    SVector::from_fn(|a, _| members.get(a).and_then(|of| of.0.get(index)).copied().unwrap_or_else(T::zero))
}

/// Writes the vector of one member, if there is such a member.
pub(crate) fn write_member<T: Scalar, const N: usize, const W: usize>(
    members: &mut MemberVector<T, N, W>,
    index: usize,
    vector: &SVector<T, N>,
) {
    for (members, entry) in members.iter_mut().zip(vector.iter()) {
        if let Some(member) = members.0.get_mut(index) {
            *member = *entry;
        }
    }
}
