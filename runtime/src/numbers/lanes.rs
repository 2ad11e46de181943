//! Numbers side by side, one for each stage of a method: what is computed of one is computed of all at once.
//!
//! A method of s stages needs s lanes, in `f64` and in `f32`, with and without `std`: arrays, whose
//! arithmetic is that of the crate `wide`, and functions as loops of fixed length. Both become vector
//! instructions of the target that the compiler is told of (`RUSTFLAGS="-C target-cpu=native"`).

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

mod functions;
mod operators;

use core::array;
use core::ops::{BitAnd, BitOr, Not};

use nalgebra::SVector;

use crate::numbers::Scalar;

/// S numbers side by side. Operators and functions act on each of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Lanes<T, const S: usize>(pub [T; S]);

/// A truth value for each lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mask<const S: usize>(pub [bool; S]);

/// A vector of N coordinates in S lanes.
pub type LaneVector<T, const N: usize, const S: usize> = [Lanes<T, S>; N];

impl<T: Scalar, const S: usize> Lanes<T, S> {
    /// One number in every lane.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn splat(value: T) -> Self {
        Self([value; S])
    }

    /// The function of each lane.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn map(mut self, function: impl Fn(T) -> T) -> Self {
        for lane in &mut self.0 {
            *lane = function(*lane);
        }
        self
    }

    /// The function of each lane of two.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn zip(mut self, other: Self, function: impl Fn(T, T) -> T) -> Self {
        for (lane, other) in self.0.iter_mut().zip(other.0) {
            *lane = function(*lane, other);
        }
        self
    }

    /// self × factor + term, rounded once where that is asked for and where the target has an instruction for
    /// it.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn times_plus(self, is_fused: bool, factor: T, term: Self) -> Self {
        Self(T::products_plus(is_fused, self.0, [factor; S], term.0))
    }

    /// Constants of each lane.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn constants(values: &[f64; S]) -> Self {
        let mut constants = Self::splat(T::zero());
        for (constant, &value) in constants.0.iter_mut().zip(values) {
            *constant = T::constant(value);
        }
        constants
    }

    /// Lane by lane, the larger; where one is NaN, either.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn larger(self, other: Self) -> Self {
        Self(T::larger(self.0, other.0))
    }

    /// Of all lanes what `combine` makes of two, halves with halves: the logarithm of S such steps wait for
    /// each other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn folded(mut self, combine: impl Fn(T, T) -> T) -> T {
        let mut lanes = &mut self.0[..];
        while let Some((low, high)) = lanes.split_at_mut_checked(lanes.len().div_ceil(2))
            && !high.is_empty()
        {
            for (one, &mut other) in low.iter_mut().zip(high) {
                *one = combine(*one, other);
            }
            lanes = low;
        }
        self.0[0]
    }

    /// The largest of the lanes, or the sum over all of `terms` where that is no finite number: NaN and
    /// infinity stay in a sum.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn largest_unless(self, terms: Self) -> T {
        let sum = terms.folded(|a, b| a + b);
        if sum.is_finite() { self.folded(|a, b| if a > b { a } else { b }) } else { sum }
    }

    /// The largest of the lanes' absolute values; not finite if one is not.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn amax(self) -> T {
        let sizes = self.abs();
        sizes.largest_unless(sizes)
    }

    /// Lane by lane, self < other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn less(self, other: Self) -> Mask<S> {
        self.compared(other, |a, b| a < b)
    }

    /// Lane by lane, self ≤ other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn less_or_equal(self, other: Self) -> Mask<S> {
        self.compared(other, |a, b| a <= b)
    }

    /// Lane by lane, self = other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn equal(self, other: Self) -> Mask<S> {
        self.compared(other, |a, b| a == b)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn compared(self, other: Self, holds: impl Fn(T, T) -> bool) -> Mask<S> {
        Mask(array::from_fn(|i| holds(self.0[i], other.0[i])))
    }

    /// Which lanes are NaN.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_nan(self) -> Mask<S> {
        !self.equal(self)
    }

    /// Which lanes are finite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_finite(self) -> Mask<S> {
        Mask(self.0.map(|lane| lane.is_finite()))
    }

    /// Which lanes are infinite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_infinite(self) -> Mask<S> {
        !(self.is_finite() | self.is_nan())
    }

    /// Which lanes have the sign bit set.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_sign_negative(self) -> Mask<S> {
        Mask(self.0.map(|lane| lane.is_sign_negative()))
    }

    /// Which lanes do not have the sign bit set.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn is_sign_positive(self) -> Mask<S> {
        !self.is_sign_negative()
    }
}

impl<const S: usize> Mask<S> {
    /// One truth value in every lane.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn splat(value: bool) -> Self {
        Self([value; S])
    }

    /// K truth values of each lane.
    #[inline]
    #[must_use]
    pub fn of_each<const K: usize>(truths: [[bool; K]; S]) -> [Self; K] {
        let mut all = [Self::splat(false); K];
        for (lane, truths) in truths.into_iter().enumerate() {
            for (all, truth) in all.iter_mut().zip(truths) {
                all.0[lane] = truth;
            }
        }
        all
    }

    /// Lane by lane, `a` where it holds and `b` where it does not.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn select<T: Scalar>(self, a: Lanes<T, S>, b: Lanes<T, S>) -> Lanes<T, S> {
        let mut selected = b;
        for i in 0..S {
            selected.0[i] = if self.0[i] { a.0[i] } else { b.0[i] };
        }
        selected
    }
}

impl<const S: usize> Not for Mask<S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn not(mut self) -> Self {
        for i in 0..S {
            self.0[i] = !self.0[i];
        }
        self
    }
}

impl<const S: usize> BitAnd for Mask<S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn bitand(mut self, other: Self) -> Self {
        for i in 0..S {
            self.0[i] &= other.0[i];
        }
        self
    }
}

impl<const S: usize> BitOr for Mask<S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn bitor(mut self, other: Self) -> Self {
        for i in 0..S {
            self.0[i] |= other.0[i];
        }
        self
    }
}

/// The vector of one lane.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn lane<T: Scalar, const N: usize, const S: usize>(
    lanes: &LaneVector<T, N, S>,
    index: usize,
) -> SVector<T, N> {
    SVector::from_fn(|a, _| lanes[a].0[index])
}

/// Writes the vector of one lane.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn write_lane<T: Scalar, const N: usize, const S: usize>(
    lanes: &mut LaneVector<T, N, S>,
    index: usize,
    vector: &SVector<T, N>,
) {
    for (lanes, entry) in lanes.iter_mut().zip(vector.iter()) {
        lanes.0[index] = *entry;
    }
}

/// The lanes in as many as vectors hold: those beyond the S are copies of the last.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn widened<T: Scalar, const N: usize, const S: usize, const W: usize>(
    lanes: LaneVector<T, N, S>,
) -> LaneVector<T, N, W> {
    let mut wide = [Lanes::splat(T::zero()); N];
    for a in 0..N {
        for i in 0..W {
            wide[a].0[i] = lanes[a].0[i.min(S - 1)];
        }
    }
    wide
}

/// The first S of the lanes.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn narrowed<T: Scalar, const N: usize, const S: usize, const W: usize>(
    lanes: LaneVector<T, N, W>,
) -> LaneVector<T, N, S> {
    let mut narrow = [Lanes::splat(T::zero()); N];
    for a in 0..N {
        for i in 0..S {
            narrow[a].0[i] = lanes[a].0[i];
        }
    }
    narrow
}

/// One vector in every lane.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn splat<T: Scalar, const N: usize, const S: usize>(
    vector: &SVector<T, N>,
) -> LaneVector<T, N, S> {
    array::from_fn(|a| Lanes::splat(vector[a]))
}
