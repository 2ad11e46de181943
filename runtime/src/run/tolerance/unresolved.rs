//! The unresolved part of a Gauss method's steps: the local errors of those that are not looked at.
//!
//! A Gauss method's local error is of twice the order of the last coefficients of its velocity's polynomial:
//! it is what the motion leaves unresolved, times what its derivative does. Where that changes with the
//! motion alone, local errors go as the squares; where it changes with time, those of calmer steps go as the
//! coefficients. Of one step that was looked at both are known.

use nalgebra::SVector;

use super::scale::Scale;
use crate::numbers::Scalar;
use crate::step::State;

/// Sums over steps of the squares of either coefficient, and of the roots of both as one.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Sums {
    squares: [f64; 2],
    roots: f64,
}

/// The squares along a run, of either coefficient.
///
/// One of the two is even about the middle of a step, the other odd: of an oscillation they are a quarter of
/// a turn apart. Weighed by the largest that they have been, the two together do not depend on its phase.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Unresolved<S: Scalar, const N: usize> {
    /// The largest.
    largest: [f64; 2],
    /// Since the last look and since the error was carried last: the sums of the squares, and of their roots.
    unseen: [Sums; 2],
    /// The largest of those looked at, with the local error there and a quarter of a turn later: the larger,
    /// the surer.
    graded: ([f64; 2], [State<S, N>; 2]),
}

impl<S: Scalar, const N: usize> Unresolved<S, N> {
    pub(super) fn new() -> Self {
        let none = State { q: SVector::zeros(), p: SVector::zeros() };
        Self { largest: [0.0; 2], unseen: [Sums::default(); 2], graded: ([0.0; 2], [none; 2]) }
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
        let root = nalgebra::ComplexField::sqrt(self.weigh(squares));
        for sums in &mut self.unseen {
            sums.squares = [sums.squares[0] + squares[0], sums.squares[1] + squares[1]];
            sums.roots += root;
        }
    }

    /// How often the local error of the largest step that was looked at local errors are, added up.
    fn multiple(&self, sums: &Sums, is_driven: bool) -> f64 {
        let graded = self.weigh(self.graded.0);
        if graded == 0.0 {
            return 0.0;
        }
        let by_roots = if is_driven { sums.roots / nalgebra::ComplexField::sqrt(graded) } else { 0.0 };
        (self.weigh(sums.squares) / graded).max(by_roots)
    }

    /// The local errors of steps that were not looked at, since this was asked for last: one, and how often
    /// it may have been made.
    pub(super) fn passed(&mut self, is_driven: bool) -> (State<S, N>, f64) {
        let sums = core::mem::take(&mut self.unseen[1]);
        (self.graded.1[0], self.multiple(&sums, is_driven))
    }

    /// The sizes of the local errors since the last look, added up, but for that of the step now looked at:
    /// it errs by the first of `local`, which a quarter of a turn makes the second.
    pub(super) fn look(
        &mut self,
        coefficients: [f64; 2],
        local: [State<S, N>; 2],
        scale: &Scale<S, N>,
        is_driven: bool,
    ) -> f64 {
        let squares = self.squares(coefficients);
        if self.weigh(squares) >= self.weigh(self.graded.0) {
            self.graded = (squares, local);
        }
        let sums = core::mem::take(&mut self.unseen[0]);
        self.multiple(&sums, is_driven) * scale.largest(&self.graded.1)
    }
}
