//! The unresolved part of a Gauss method's steps: the local errors of those that are not looked at.
//!
//! A Gauss method's local error is of twice the order of the last coefficients of its velocity's polynomial,
//! so local errors go as their squares: of one step that was looked at both are known.

use nalgebra::SVector;

use super::scale::Scale;
use crate::numbers::Scalar;
use crate::step::State;

/// The squares along a run, of either coefficient.
///
/// One of the two is even about the middle of a step, the other odd: of an oscillation they are a quarter of
/// a turn apart. Weighed by the largest that they have been, the two together do not depend on its phase.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "S: Scalar + serde::Serialize",
        deserialize = "S: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(super) struct Unresolved<S, const N: usize> {
    /// The largest.
    largest: [f64; 2],
    /// The sums of the squares since the last look.
    unseen: [f64; 2],
    /// The largest of those looked at, with the local error there and a quarter of a turn later: the larger,
    /// the surer.
    graded: ([f64; 2], [State<S, N>; 2]),
}

impl<S: Scalar, const N: usize> Unresolved<S, N> {
    pub(super) fn new() -> Self {
        let none = State { q: SVector::zeros(), p: SVector::zeros() };
        Self { largest: [0.0; 2], unseen: [0.0; 2], graded: ([0.0; 2], [none; 2]) }
    }

    /// Both squares as one.
    fn weigh(&self, [before, last]: [f64; 2]) -> f64 {
        let ratio = if self.largest[0] > 0.0 { self.largest[1] / self.largest[0] } else { 0.0 };
        last + before * ratio
    }

    /// The squares of a step with these coefficients.
    fn squares(&mut self, coefficients: [f64; 2]) -> [f64; 2] {
        let squares = coefficients.map(|x| x * x);
        self.largest = [self.largest[0].max(squares[0]), self.largest[1].max(squares[1])];
        squares
    }

    /// Takes in a step that is not looked at.
    pub(super) fn pass(&mut self, coefficients: [f64; 2]) {
        let squares = self.squares(coefficients);
        self.unseen = [self.unseen[0] + squares[0], self.unseen[1] + squares[1]];
    }

    /// The sizes of the local errors since the last look, added up, but for that of the step now looked at:
    /// it errs by the first of `local`, which a quarter of a turn makes the second.
    pub(super) fn look(
        &mut self,
        coefficients: [f64; 2],
        local: [State<S, N>; 2],
        scale: &Scale<S, N>,
    ) -> f64 {
        let squares = self.squares(coefficients);
        if self.weigh(squares) >= self.weigh(self.graded.0) {
            self.graded = (squares, local);
        }
        let (unseen, graded) = (self.weigh(self.unseen), self.weigh(self.graded.0));
        self.unseen = [0.0; 2];
        if graded > 0.0 { unseen * scale.largest(&self.graded.1) / graded } else { 0.0 }
    }
}
