//! Vectors of any length, as slices of one buffer.

use crate::numbers::Precision;

/// Whether noise is measured. On core it is not: a step is to take little code and room there, and
/// derivatives that are written out come with the terms that cancel.
pub(crate) const MEASURES_NOISE: bool = cfg!(feature = "std");

/// Vectors in use at once where calls are deepest: 4 from rest, 7 of the damped method, 10 for a verdict, 7
/// for noise, 5 for a momentum where others are held. The damped method from rest itself runs beside 4 more
/// of those from rest, and takes 1 of the last 5.
///
/// Where no noise is measured, 4 for a verdict, 2 for forces at rest and 5 for rounding.
pub(crate) const VECTORS: usize = if MEASURES_NOISE { 33 } else { 27 };

/// Room for vectors of one length, in a buffer of the caller's.
///
/// A vector that is taken is given back when the `Room` that it was taken from ends: an
/// [`inner`](Room::inner) one for each function that is called.
pub struct Room<'r, S> {
    left: &'r mut [S],
    length: usize,
}

impl<'r, S: Precision> Room<'r, S> {
    /// Room in `buffer` for vectors of this `length`.
    pub(crate) fn new(buffer: &'r mut [S], length: usize) -> Self {
        Self { left: buffer, length }
    }

    /// The room that is left, for as long as it is borrowed.
    pub(in crate::numbers) fn inner(&mut self) -> Room<'_, S> {
        Room { left: self.left, length: self.length }
    }

    /// Room for so many vectors, and what is left.
    pub(super) fn split(self, vectors: usize) -> (Room<'r, S>, Room<'r, S>) {
        let length = self.length;
        let (left, rest) = self.left.split_at_mut_checked(vectors * length).unwrap_or_default();
        (Room { left, length }, Room { left: rest, length })
    }

    /// A vector, of whatever is there.
    pub(super) fn vector(&mut self) -> &'r mut [S] {
        let left = core::mem::take(&mut self.left);
        let Some((vector, left)) = left.split_at_mut_checked(self.length) else {
            debug_assert!(false, "no room for another vector: there are {VECTORS}");
            return &mut [];
        };
        self.left = left;
        vector
    }

    /// Several vectors, of whatever is there.
    pub(in crate::numbers) fn vectors<const K: usize>(&mut self) -> [&'r mut [S]; K] {
        core::array::from_fn(|_| self.vector())
    }

    /// A vector of zeros.
    pub(super) fn zeros(&mut self) -> &'r mut [S] {
        let vector = self.vector();
        vector.fill(S::zero());
        vector
    }
}

/// `to` = `from`.
pub(in crate::numbers) fn copy<S: Copy>(to: &mut [S], from: &[S]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = *from;
    }
}

/// `x` += `factor` `y`.
pub(super) fn add<S: Precision>(x: &mut [S], factor: S, y: &[S]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x += *y * factor;
    }
}

/// `to` = `x` + `factor` `y`.
pub(super) fn sum<S: Precision>(to: &mut [S], x: &[S], factor: S, y: &[S]) {
    for ((to, x), y) in to.iter_mut().zip(x).zip(y) {
        *to = *x + *y * factor;
    }
}

/// `x` −= `y`.
pub(super) fn subtract<S: Precision>(x: &mut [S], y: &[S]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x -= *y;
    }
}

/// max |xᵢ|; a loop of its own, which optimisation for size leaves one.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn largest<S: Precision>(x: &[S]) -> S {
    let mut largest = S::zero();
    for entry in x {
        let size = entry.abs();
        largest = if size > largest { size } else { largest };
    }
    largest
}
