//! The norm of the promise.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::State;

/// How an error of p counts beside one of q: the norm of a [`Choice`](super::Choice)'s promise.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Scale<S: Scalar, const N: usize> {
    start: SVector<S, N>,
    /// The largest distance of a coordinate from its start, and the largest momentum.
    reached: [S; 2],
    /// The largest change of a coordinate and of a momentum over a step.
    change: [S; 2],
    /// The largest coordinate.
    pub(super) furthest: S,
    /// The factor of an error of p beside one of q.
    weight: f64,
}

impl<S: Scalar, const N: usize> Scale<S, N> {
    pub(super) fn new(start: &State<S, N>) -> Self {
        let zero = S::zero();
        let reached = [zero, start.p.amax()];
        let mut scale =
            Self { start: start.q, reached, change: [zero; 2], furthest: start.q.amax(), weight: 0.0 };
        scale.weigh();
        scale
    }

    #[inline]
    pub(super) fn follow(&mut self, from: &State<S, N>, to: &State<S, N>) {
        let (reached, change) = (self.reached, self.change);
        self.reached = [reached[0].max((to.q - self.start).amax()), reached[1].max(to.p.amax())];
        self.change = [change[0].max((to.q - from.q).amax()), change[1].max((to.p - from.p).amax())];
        self.furthest = self.furthest.max(to.q.amax());
        if self.reached != reached || self.change != change {
            self.weigh();
        }
    }

    fn weigh(&mut self) {
        let ratio = |[q, p]: [S; 2]| if p > S::zero() { (q / p).widen() } else { f64::INFINITY };
        let weight = ratio(self.reached).min(ratio(self.change));
        self.weight = if weight.is_finite() { weight } else { 0.0 };
    }

    /// The factor of an error of p beside one of q.
    pub(super) fn weight(&self) -> f64 {
        self.weight
    }

    /// An error of so much in every coordinate and momentum.
    pub(super) fn of_size(&self, size: f64) -> State<S, N> {
        let weight = self.weight();
        let of_p = if weight > 0.0 { size / weight } else { 0.0 };
        State { q: SVector::repeat(S::constant(size)), p: SVector::repeat(S::constant(of_p)) }
    }

    /// The size of the largest of some errors: infinite where one is no number.
    pub(super) fn largest(&self, errors: &[State<S, N>]) -> f64 {
        errors.iter().fold(0.0, |largest, error| self.norm(error).max(largest))
    }

    /// The size of an error: infinite where it is no number.
    pub(super) fn norm(&self, error: &State<S, N>) -> f64 {
        let entries = error.q.iter().chain(&error.p);
        if entries.copied().any(|x| x.widen().is_nan()) {
            return f64::INFINITY;
        }
        error.q.amax().widen().max(error.p.amax().widen() * self.weight())
    }
}
