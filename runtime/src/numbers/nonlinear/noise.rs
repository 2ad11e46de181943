//! Noise of a function near a root: how far it scatters about a smooth one, whatever it is that rounds.
//!
//! At rest forces cancel, and their rounding may stand above all that a state, its momenta and their last
//! places tell: (q − 1) + (q + 1) rounds at ε where q = 0 has no places. Of a function that only can be asked
//! for values, its scatter over nearby points says how it rounds (J. J. Moré and S. M. Wild, Estimating
//! computational noise, SIAM J. Sci. Comput. 33, 2011).
//!
//! A residual r = F(v) that is left at v, with c for the Newton correction by it, is noise, and v a root but
//! for that, where
//!
//! 1. the Newton matrix is nearly the same at points up to 10⁶ c apart: |F(v − c)| ≤ max |J − J(v)||c| where
//!    F is smooth, but F(v − c) is no lower than r: there is a root within some c, or a jump, and that or
//!    rounding keeps F from it;
//! 2. F scatters about smooth functions by r/64 at least over moves of many c, and not much more over moves
//!    32 times as long: what is smooth scatters 32³ times as much then, a kink 32 times;
//! 3. it does so in every direction from v, so that no jump is taken for noise.

use super::equations::{Equations, Matrix};
use super::rounding::{AT_FLOOR, held_against};
use super::vectors::{Room, add, copy};
use crate::numbers::Precision;

/// The shortest moves, in corrections, and how they grow. Noise shows where a move changes what rounds by its
/// last place, 1/(hω)² corrections.
const SHORTEST: f64 = 1024.0;
const LONGER: f64 = 32.0;

/// Lengths of moves that are tried.
const LENGTHS: usize = 7;

/// Directions, two on either side of each coordinate.
const DIRECTIONS: usize = 4;

/// Weights of two third differences of five points. What is uniform noise has some 4.5 times its size there.
static THIRD_DIFFERENCES: [[f64; 2]; 5] = [[-1.0, 0.0], [3.0, -1.0], [-3.0, 3.0], [1.0, -3.0], [0.0, 1.0]];

/// Vectors in use at once.
pub(crate) const WITHIN_NOISE: usize = 7;

/// The part of a correction by which those of matrices around may differ from it.
const SAME: f64 = 1.0 / 8.0;

/// Corrections that points are away at which the matrix is still to be the same: noise is far below what a
/// function varies over, and none of it may vary by chance as often as between the points.
pub(crate) static AROUND: [f64; 4] = [1.0, 93.0, 8641.0, (1 << 20) as f64];

/// How much larger noise is at some points than it scatters at most: sums of numbers that have one last place
/// in common round rarely, and then all at once.
const RARELY: f64 = 16.0;

/// How many times what is left may be below the noise by chance.
const BY_CHANCE: f64 = 1024.0;

/// The share of a change by which a line may be missed.
const STRAIGHT: f64 = 1.0 / 64.0;

/// By how much noise may be larger over longer moves.
const ALIKE: f64 = 16.0;

/// The residual that is left at a point, and the Newton correction there.
pub struct Left<'a, S> {
    pub(crate) at: &'a [S],
    pub(crate) residual: &'a [S],
    pub(crate) correction: &'a [S],
    /// By how much a correction changes the residual at most, and the floor that does not explain what is
    /// left of it.
    pub(crate) change: &'a [S],
    pub(crate) floor: &'a [S],
}

impl<S: Precision> Left<'_, S> {
    /// Whether a residual is to be explained.
    fn is_open(&self, i: usize) -> bool {
        match (self.residual.get(i), self.floor.get(i)) {
            (Some(residual), Some(floor)) => residual.abs() > *floor * S::nearest(AT_FLOOR),
            _ => false,
        }
    }
}

/// Whether matrices at points around `at` correct the `residual` as that did which gave the `correction`, and
/// constraints there leave the same of it: of these the matrix alone, often one everywhere, does not tell.
/// The present matrix is another one then.
#[cold]
#[inline(never)]
pub(super) fn is_same_around<S: Precision>(
    of: &mut Equations<'_, S>,
    at: &[S],
    residual: &[S],
    correction: &[S],
    mut room: Room<'_, S>,
) -> bool {
    let [inertia, point, unused, own, along] = room.vectors();
    of.evaluate.diagonal(Matrix::Mass { q: of.q, v: at }, inertia);
    let is_constrained = of.evaluate.along_constraints(of.q, at, of.h, correction, along);
    let here: &[S] = if is_constrained { along } else { correction };
    for direction in 0..DIRECTIONS {
        for away in &AROUND {
            for (i, ((point, at), correction)) in point.iter_mut().zip(at).zip(correction).enumerate() {
                *point = *at + *correction * S::nearest(*away * shift(direction, i));
            }
            of.evaluate(point, unused);
            if of.evaluate.solve(residual, own).is_err() {
                return false;
            }
            if is_constrained {
                copy(unused, own);
                of.evaluate.along_constraints(of.q, point, of.h, unused, own);
            }
            // Σ |Mᵢᵢ| vᵢ² for the square of a length: neither unit nor neighbour changes it.
            let (mut apart, mut all) = (S::zero(), S::zero());
            for ((own, correction), mass) in own.iter().zip(here).zip(inertia.iter()) {
                let difference = *own - *correction;
                apart += difference * difference * *mass;
                all += *correction * *correction * *mass;
            }
            let is_same = apart <= all * S::nearest(SAME * SAME) && all > S::LEAST_NORMAL && all.is_finite();
            if !is_same {
                return false;
            }
        }
    }
    true
}

/// The floor with the noise of the residual, a `function` that writes to the second slice; whether that
/// explains what is left of it.
#[cold]
#[inline(never)]
pub(crate) fn add_noise<S: Precision>(
    function: &mut dyn FnMut(&[S], &mut [S]),
    left: &Left<'_, S>,
    measured: &mut [S],
    mut room: Room<'_, S>,
) -> bool {
    let [last, noise] = [room.zeros(), room.zeros()];
    let now = room.vector();
    let mut length = S::nearest(SHORTEST);
    for _ in 0..LENGTHS {
        let is_line = scatters(function, left, length, now, room.inner());
        length *= S::nearest(LONGER);
        if !is_line {
            last.fill(S::zero());
            continue;
        }
        for (((noise, last), now), residual) in
            noise.iter_mut().zip(last.iter_mut()).zip(now.iter()).zip(left.residual)
        {
            let most = residual.abs() * S::nearest(BY_CHANCE);
            if *now <= *last * S::nearest(ALIKE) && *last > *noise && *last <= most {
                *noise = *last;
            }
            *last = *now;
        }
        copy(measured, left.floor);
        add(measured, S::nearest(RARELY), noise);
        if held_against(left.residual, measured).2 {
            return true;
        }
    }
    false
}

/// How the function `scatter`s about a line over moves of so many corrections, by its third differences: the
/// least of all directions. Whether it is a line but for that.
fn scatters<S: Precision>(
    function: &mut dyn FnMut(&[S], &mut [S]),
    left: &Left<'_, S>,
    length: S,
    scatter: &mut [S],
    mut room: Room<'_, S>,
) -> bool {
    let [moved, value] = room.vectors();
    let mut differences: [&mut [S]; 2] = room.vectors();
    scatter.fill(S::max_value().unwrap_or_else(S::one));
    for direction in 0..DIRECTIONS {
        differences.iter_mut().for_each(|difference| difference.fill(S::zero()));
        for (point, weights) in THIRD_DIFFERENCES.iter().enumerate() {
            let share = length * S::nearest(0.2 * (point + 1) as f64);
            for (i, ((moved, at), correction)) in
                moved.iter_mut().zip(left.at).zip(left.correction).enumerate()
            {
                *moved = *at + *correction * (share * S::nearest(shift(direction, i)));
            }
            function(moved, value);
            for (i, ((value, residual), change)) in
                value.iter().zip(left.residual).zip(left.change).enumerate()
            {
                // What is no number fails the comparison.
                let is_near =
                    (*value - *residual).abs() <= *change * share * S::nearest(8.0) + residual.abs();
                if left.is_open(i) && !is_near || !value.is_finite() {
                    return false;
                }
            }
            for (difference, weight) in differences.iter_mut().zip(weights) {
                add(difference, S::nearest(*weight), value);
            }
        }
        let [first, second] = &differences;
        for (i, (first, second)) in first.iter().zip(second.iter()).enumerate() {
            let (first, second) = (first.abs(), second.abs());
            let own = if first > second { first } else { second } * S::nearest(1.0 / 4.5);
            if let Some(scatter) = scatter.get_mut(i)
                && own < *scatter
            {
                *scatter = own;
            }
        }
    }
    let mut pairs = scatter.iter().zip(left.change).enumerate();
    pairs
        .all(|(i, (scatter, change))| !left.is_open(i) || *scatter <= *change * length * S::nearest(STRAIGHT))
}

/// The share of a move in a direction for coordinate i: between a half and three halves, no two alike, and of
/// either sign in half of the directions.
pub(crate) fn shift(direction: usize, i: usize) -> f64 {
    let share = 0.5 + ((370 * direction + 618 * i) % 1000) as f64 * 1e-3;
    let is_back = if i.is_multiple_of(2) { direction % 2 == 1 } else { direction == 1 || direction == 2 };
    if is_back { -share } else { share }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether noise explains the residual `r` of the function at `at`, of slope 1 or so in each entry.
    fn is_noise<const N: usize>(function: impl Fn(&[f64; N]) -> [f64; N], at: [f64; N]) -> bool {
        let residual = function(&at);
        let left = Left {
            at: &at,
            residual: &residual,
            correction: &residual,
            change: &residual.map(f64::abs),
            floor: &[f64::MIN_POSITIVE; N],
        };
        let mut of = |x: &[f64], into: &mut [f64]| {
            into.copy_from_slice(&function(x.try_into().expect("N entries")));
        };
        add_noise(&mut of, &left, &mut [f64::MIN_POSITIVE; N], Room::new(&mut [0.0; 100], N))
    }

    /// A function of slope 1 whose terms are `a` times as large as its digits at x = 0 are: it rounds at ε a.
    fn rounded(x: f64, a: f64) -> f64 {
        0.5 * ((x - a) + (x + a)) + 1e-2 * ((0.3 * x - a / 3.0) + a / 3.0)
    }

    #[test]
    fn rounding_of_terms_that_cancel_is_noise() {
        for a in [1e-9, 1.0, 3.3, 1e4, 7e9] {
            let states = (1..=200).map(|k| 0.005 * f64::from(k) * f64::EPSILON * a);
            let missed = states.filter(|&x| !is_noise(|[x]| [rounded(*x, a)], [x])).count();
            // Where all moves of one direction are rounded alike nothing shows; a step has several iterates.
            assert!(missed < 50, "{a}: {missed}");
        }
    }

    /// The controls: a residual far above the rounding, with a root that nobody went to, without one at a
    /// jump, on a fold, and at a kink.
    #[test]
    fn what_is_smooth_or_jumps_is_not() {
        for a in [1.0, 1e4] {
            for x in [1e-3, 1e-6, 1e-9, 1e3 * f64::EPSILON * a] {
                assert!(!is_noise(|[x]| [rounded(*x, a)], [x]), "{a} {x:e}");
                assert!(!is_noise(|[y]| [rounded(*y, 1e-9) + x.copysign(*y)], [0.0]), "jump, {x:e}");
                assert!(!is_noise(|[y]| [y * y + x], [1e-3 * x]), "fold, {x:e}");
                assert!(!is_noise(|[y]| [y.abs() + x], [0.1 * x]), "kink, {x:e}");
                let pair =
                    |[y, z]: &[f64; 2]| [rounded(*y + 0.3 * z, 1e-9) + x.copysign(*y), rounded(*z, 1.0)];
                assert!(!is_noise(pair, [0.0, 2.0 * f64::EPSILON]), "a jump beside noise, {x:e}");
            }
        }
    }

    #[test]
    fn directions_are_on_either_side_of_each_coordinate() {
        for i in 0..60 {
            let back = (0..DIRECTIONS).filter(|&direction| shift(direction, i) < 0.0).count();
            assert_eq!(back, DIRECTIONS / 2);
        }
    }
}
