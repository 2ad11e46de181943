//! Places where functions are compared, and directions there.

use crate::numbers::Precision;

/// The unit that an entry of a point is moved by.
#[derive(Clone, Copy)]
pub enum Unit {
    /// 1.
    One,
    /// The size of the entry, but 1 where it is small: what a function of terms such as √(v² + ε²) − ε loses
    /// to rounding there, its differences do not show.
    Size,
    /// The entry.
    Own,
}

impl Unit {
    pub(super) fn of<S: Precision>(self, entry: S) -> S {
        match self {
            Self::One => S::nearest(1.0),
            Self::Size => {
                let small = if S::SPACING.widened() > 1e-10 { 0.1 } else { 1e-3 };
                let size = entry.widened().abs();
                S::nearest(if size >= small { size } else { 1.0 })
            }
            Self::Own => entry,
        }
    }
}

pub(super) fn beside<S: Precision>(x: &[S], distance: f64, unit: Unit, beside: &mut [S]) {
    for (i, (beside, x)) in beside.iter_mut().zip(x).enumerate() {
        *beside = *x + S::nearest(distance * (1.0 + 0.125 * i as f64)) * unit.of(*x);
    }
}

/// Entries whose fourth powers carry their digits, far below 1.
pub(super) fn has_tiny<S: Precision>(point: &[S]) -> bool {
    let least = if S::SPACING.widened() > 1e-10 { 1e-7 } else { 1e-70 };
    point.iter().any(|entry| (least..1e-4).contains(&entry.widened().abs()))
}

/// A direction with a part in every entry: a third to two thirds of its size.
pub(super) fn direction<S: Precision>(point: &[S], phase: usize, unit: Unit, direction: &mut [S]) {
    for (i, (direction, entry)) in direction.iter_mut().zip(point).enumerate() {
        *direction = unit.of(*entry) * S::nearest(share(i + phase));
    }
}

/// A share of either sign, from a third to two thirds, without a pattern that functions have.
pub(super) fn share(place: usize) -> f64 {
    let share = 1.0 / 3.0 + (place * 7 % 11) as f64 / 33.0;
    let sign = if place % 3 == 1 { -1.0 } else { 1.0 };
    sign * share
}

pub(super) fn is_solved_by_diagonal<S: Precision>(matrix: &[S], right: &[S], x: &mut [S]) -> bool {
    let (zero, size) = (S::nearest(0.0), right.len());
    let mut entries = matrix.iter().enumerate();
    let is_diagonal = entries.all(|(entry, value)| (*value != zero) == (entry % (size + 1) == 0));
    if is_diagonal {
        for ((x, right), diagonal) in x.iter_mut().zip(right).zip(matrix.iter().step_by(size + 1)) {
            *x = *right / *diagonal;
        }
    }
    is_diagonal
}
