//! Partial derivatives as generated against differences, along directions with a part in every coordinate
//! and velocity.

use super::places::{Unit, beside, direction, has_tiny, share};
use super::slope;
use crate::numbers::Precision;
use crate::numbers::nonlinear::{Room, copy};

/// Partial derivatives by q and by v at (q, v), written to the slices that come last.
type Partials<'f, S> = dyn Fn(&[S], &[S], &mut [S], &mut [S]) + 'f;

/// A function of (q, v) by its two sides.
#[derive(Clone, Copy)]
pub struct Sides<'f, S> {
    /// The function as written.
    pub(crate) written: &'f dyn Fn(&[S], &[S]) -> S,
    /// Its partial derivatives as generated.
    pub(crate) partials: &'f Partials<'f, S>,
}

/// A point in (q, v), and the size of directions there: beside tiny entries all have their own, and none
/// where they are 0.
#[derive(Clone, Copy)]
struct At<'a, S> {
    q: &'a [S],
    v: &'a [S],
    unit: Unit,
}

impl<'a, S: Precision> At<'a, S> {
    fn new(q: &'a [S], v: &'a [S]) -> Self {
        Self { q, v, unit: if has_tiny(q) || has_tiny(v) { Unit::Own } else { Unit::Size } }
    }

    fn direction(self, phases: [usize; 2], a: &mut [S], b: &mut [S]) {
        direction(self.q, phases[0], self.unit, a);
        direction(self.v, phases[1], self.unit, b);
    }

    /// Size of the terms of a function, which may cancel here: no less than its value at 1.
    fn terms(self, of: &Sides<'_, S>, mut room: Room<'_, S>) -> f64 {
        if matches!(self.unit, Unit::Size) {
            return 0.0;
        }
        let [q, v] = room.vectors();
        beside(self.q, 0.75, Unit::One, q);
        beside(self.v, -1.25, Unit::One, v);
        (of.written)(q, v).widened().abs()
    }
}

/// A line through a point.
struct Line<'a, S> {
    at: At<'a, S>,
    direction: [&'a [S]; 2],
}

impl<S: Precision> Line<'_, S> {
    /// The point at `s`.
    fn point(&self, s: f64, q: &mut [S], v: &mut [S]) {
        for ((to, from), along) in [q, v].into_iter().zip([self.at.q, self.at.v]).zip(self.direction) {
            for ((to, from), along) in to.iter_mut().zip(from).zip(along) {
                *to = *from + *along * S::nearest(s);
            }
        }
    }

    fn slope(&self, d1: &[S], d2: &[S]) -> f64 {
        let [a, b] = self.direction;
        let mut slope = 0.0;
        for ((d1, d2), (a, b)) in d1.iter().zip(d2).zip(a.iter().zip(b)) {
            slope += d1.widened() * a.widened() + d2.widened() * b.widened();
        }
        slope
    }

    /// The slope from the partial derivatives, and by differences, where those leave no doubt that it is
    /// another.
    fn refuted(&self, of: &Sides<'_, S>, mut room: Room<'_, S>) -> Option<[f64; 2]> {
        let (at, epsilon) = (self.at, S::SPACING.widened());
        let mut size = at.terms(of, room.inner());
        let [q, v, d1, d2] = room.vectors();
        (of.partials)(at.q, at.v, d1, d2);
        let slope = self.slope(d1, d2);
        for ((d1, d2), (q, v)) in d1.iter().zip(d2.iter()).zip(at.q.iter().zip(at.v)) {
            size += (d1.widened() * q.widened()).abs() + (d2.widened() * v.widened()).abs();
        }
        let by_differences = slope::refuted(slope, epsilon, size, &mut |s| {
            self.point(s, q, v);
            (of.written)(q, v).widened()
        })?;
        let is_steady = slope::is_steady(slope, by_differences, epsilon, &mut |s| {
            self.point(s, q, v);
            (of.partials)(q, v, d1, d2);
            self.slope(d1, d2)
        });
        is_steady.then_some([slope, by_differences])
    }
}

/// Whether a partial derivative is refuted by itself, here and where its coordinate or velocity is larger:
/// what rounding takes of terms that cancel, as in √(1 + v²) − 1, is not missing there.
fn one_is_refuted<S: Precision>(at: At<'_, S>, of: &Sides<'_, S>, mut room: Room<'_, S>) -> bool {
    let [q, v, a, b] = room.vectors();
    let length = at.q.len();
    let mut is_refuted = |k: usize, factor: f64| {
        copy(q, at.q);
        copy(v, at.v);
        if let Some(entry) = q.iter_mut().chain(v.iter_mut()).nth(k) {
            *entry *= S::nearest(factor);
        }
        let at = At { q, v, unit: at.unit };
        at.direction([0, 5], a, b);
        for (i, along) in a.iter_mut().chain(b.iter_mut()).enumerate() {
            if i != k {
                *along = S::nearest(0.0);
            }
        }
        Line { at, direction: [a, b] }.refuted(of, room.inner()).is_some()
    };
    let factors = slope::factors(S::SPACING.widened());
    (0..2 * length).any(|k| factors.into_iter().all(|factor| is_refuted(k, factor)))
}

pub(super) fn apart<S: Precision>(
    q: &[S],
    v: &[S],
    of: &Sides<'_, S>,
    mut room: Room<'_, S>,
) -> Option<[f64; 2]> {
    let largest = slope::largest(S::SPACING.widened());
    if !q.iter().chain(v).all(|x| x.widened().abs() <= largest) {
        return None;
    }
    let at = At::new(q, v);
    let [a, b] = room.vectors();
    at.direction([0, 5], a, b);
    let found = Line { at, direction: [a, b] }.refuted(of, room.inner())?;
    one_is_refuted(at, of, room).then_some(found)
}

pub(super) fn other_direction<S: Precision>(q: &[S], v: &[S], a: &mut [S], b: &mut [S]) {
    At::new(q, v).direction([3, 1], a, b);
}

pub(super) fn shares<S: Precision>(of: &mut [S]) {
    for (i, of) in of.iter_mut().enumerate() {
        *of = S::nearest(share(i + 2));
    }
}
