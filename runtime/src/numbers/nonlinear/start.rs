//! Where Newton's method starts where rest is a singular point.
//!
//! At v̄ = 0 a drag such as c|v|³ has a Hessian of 0·∞, and a kinetic energy such as |v|⁴ none to solve with.
//! Each coordinate is then moved alone to where its own residual changes sign, to a factor of 2. Powers of 2
//! from the smallest to the largest number: no unit of length, time or mass is preferred.
//!
//! A coordinate whose residual vanishes with its velocity rests in the solution too. Where its derivatives do
//! not exist at rest, it is taken out of the equation, and the solution of the others is held against its
//! residual next to rest.

use super::careful::careful;
use super::equations::{Equations, Root, Solved, Unsolved};
use super::vectors::{Room, copy, subtract};
use crate::numbers::Precision;

/// A residual that grows by this factor where the velocity doubles vanishes at rest: one that is constant
/// next to rest does not grow, drag through a root does by a root of 2.
const VANISHING: f64 = 1.0625;

/// A residual as a function of v, written to the second slice.
type Residual<'f, S> = dyn FnMut(&[S], &mut [S]) + 'f;

/// The root that is reached from rest or, where rest is a singular point, from away from it. From `tried`
/// there was `error`.
///
/// # Errors
/// That of Newton's method from rest; `error` where it has been there or cannot start there.
#[inline(never)]
pub(super) fn from_rest<S: Precision>(
    of: &mut Equations<'_, S>,
    tried: &[S],
    error: Unsolved<S>,
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Result<Solved<S>, Unsolved<S>> {
    let [near, resting] = room.vectors();
    let start = room.zeros();
    {
        let mut room = room.inner();
        let [at_rest, unused, p1] = room.vectors();
        let rest = room.zeros();
        of.residual(rest, at_rest, p1);
        if at_rest.iter().any(|entry| *entry != S::zero()) {
            of.evaluate(rest, unused);
            if of.evaluate.solve(at_rest, unused).is_ok() {
                if tried.iter().all(|entry| *entry == S::zero()) {
                    return Err(error);
                }
                root.v.fill(S::zero());
                return careful(of, 0, root, room);
            }
        }
        let residual = &mut |v: &[S], residual: &mut [S]| of.residual(v, residual, p1);
        near_rest(residual, near, unused);
        vanishing(residual, of.p, rest, near, resting, room.inner());
        if is_all(resting) {
            return Ok(rest_itself(of, near, root, room));
        }
        away_from_rest(residual, near, resting, start, room);
    }
    if *start != *tried {
        copy(root.v, start);
        if let Ok(solution) = careful(of, 0, root, room.inner()) {
            return Ok(solution);
        }
    }
    if resting.iter().all(|rests| *rests == S::zero()) {
        return Err(error);
    }
    copy(root.v, start);
    without(of, near, resting, root, room).ok_or(error)
}

/// Whether the `residual` vanishes with the velocity in every coordinate, so that rest is its root.
pub(super) fn is_rest<S: Precision>(residual: &mut Residual<'_, S>, p: &[S], mut room: Room<'_, S>) -> bool {
    let [near, resting, unused] = room.vectors();
    let rest = room.zeros();
    near_rest(residual, near, unused);
    vanishing(residual, p, rest, near, resting, room);
    is_all(resting)
}

/// Whether every coordinate rests.
fn is_all<S: Precision>(resting: &[S]) -> bool {
    resting.iter().all(|rests| *rests != S::zero())
}

/// A velocity so small that only what is constant is left of the residual, but at which it is a number in
/// every coordinate. No two entries are alike.
#[inline(never)]
fn near_rest<S: Precision>(residual: &mut Residual<'_, S>, near: &mut [S], found: &mut [S]) {
    let mut size = S::LEAST_NORMAL;
    let count = S::nearest(near.len() as f64);
    while size < S::SPACING {
        for (i, near) in near.iter_mut().enumerate() {
            *near = size * (S::one() + S::nearest(i as f64) / count);
        }
        residual(near, found);
        if found.iter().all(|entry| entry.is_finite()) {
            break;
        }
        size *= S::nearest(256.0);
    }
}

/// The coordinates whose residual vanishes as they come to rest, the others as in `v`: theirs of `near`,
/// which is next to rest, and 0 for the others. Where derivatives do not exist at rest, p has to be 0: one
/// that is small beside that of `near` could not be told from it.
#[inline(never)]
fn vanishing<S: Precision>(
    residual: &mut Residual<'_, S>,
    p: &[S],
    v: &[S],
    near: &[S],
    resting: &mut [S],
    mut room: Room<'_, S>,
) {
    let [exact, once, twice, moved] = room.vectors();
    residual(v, exact);
    for (factor, found) in [(1.0, &mut *once), (2.0, &mut *twice)] {
        for ((moved, v), near) in moved.iter_mut().zip(v).zip(near) {
            *moved = if *v == S::zero() { *near * S::nearest(factor) } else { *v };
        }
        residual(moved, found);
    }
    let found = exact.iter().zip(once.iter()).zip(twice.iter());
    for ((((resting, v), near), p), ((exact, once), twice)) in
        resting.iter_mut().zip(v).zip(near).zip(p).zip(found)
    {
        let rests = *v == S::zero()
            && (*exact == S::zero()
                || *p == S::zero()
                    && !exact.is_finite()
                    && twice.abs() >= once.abs() * S::nearest(VANISHING));
        *resting = if rests { *near } else { S::zero() };
    }
}

/// Rest, with the momenta that it has in the limit.
#[inline(never)]
fn rest_itself<S: Precision>(
    of: &Equations<'_, S>,
    near: &[S],
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Solved<S> {
    let [change, moved] = room.vectors();
    root.v.fill(S::zero());
    of.momenta(of.q, root.v, root.p0, root.p1, room.inner());
    if *root.p0 == *of.p {
        copy(change, root.p1);
        subtract(change, root.p0);
    } else {
        of.change_at_rest(root.v, near, moved, change, room);
    }
    copy(root.p0, of.p);
    for ((p1, p), change) in root.p1.iter_mut().zip(of.p).zip(change.iter()) {
        *p1 = *p + *change;
    }
    let (residual, floor) = (S::zero(), S::LEAST_NORMAL);
    Solved { iterations: 0, damped: 0, residual, floor, last_correction: S::zero() }
}

/// The solution in which the coordinates `resting` rest: they are held, the equations of the others are
/// solved from the root's velocity.
#[inline(never)]
fn without<S: Precision>(
    of: &mut Equations<'_, S>,
    near: &[S],
    resting: &[S],
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Solved<S>> {
    let h = of.h;
    let solution = careful(&mut of.with(h, resting), 0, root, room.inner()).ok()?;
    still_rest(of, near, resting, root.v, room).then_some(solution)
}

/// Whether the coordinates `resting` still rest in the solution `v`.
#[inline(never)]
fn still_rest<S: Precision>(
    of: &Equations<'_, S>,
    near: &[S],
    resting: &[S],
    v: &[S],
    mut room: Room<'_, S>,
) -> bool {
    let [p1, found] = room.vectors();
    let residual = &mut |v: &[S], residual: &mut [S]| of.residual(v, residual, p1);
    vanishing(residual, of.p, v, near, found, room);
    let mut pairs = resting.iter().zip(found);
    pairs.all(|(rests, found)| *rests == S::zero() || *found != S::zero())
}

/// A velocity of the order of the root's, with the directions in which the `residual` at rest falls; those
/// `resting` stay.
#[inline(never)]
fn away_from_rest<S: Precision>(
    residual: &mut Residual<'_, S>,
    near: &[S],
    resting: &[S],
    start: &mut [S],
    mut room: Room<'_, S>,
) {
    // 2, 2², 2⁴, …, 2⁵¹²; infinite where the type has no such numbers.
    let mut factors = [S::one() + S::one(); 10];
    let mut power = S::one() + S::one();
    for factor in &mut factors {
        *factor = power;
        power *= power;
    }
    let [at_rest, v, found] = room.vectors();
    residual(near, at_rest);
    for (i, ((start, rests), first)) in start.iter_mut().zip(resting).zip(at_rest.iter()).enumerate() {
        if *rests != S::zero() || !first.is_finite() || *first == S::zero() {
            continue;
        }
        let falls = *first > S::zero();
        let signed = |size: S| if falls { -size } else { size };
        let mut is_before = |size: S| {
            v.fill(S::zero());
            if let Some(entry) = v.get_mut(i) {
                *entry = signed(size);
            }
            residual(v, found);
            let value = found.get(i).copied().unwrap_or_else(S::zero);
            value.is_finite() && value != S::zero() && (value > S::zero()) == falls
        };
        let mut size = S::LEAST_NORMAL;
        // The factors thrice each lead from the smallest number to the largest.
        for &factor in factors.iter().rev().flat_map(|factor| [factor; 3]) {
            let larger = size * factor;
            if larger.is_finite() && is_before(larger) {
                size = larger;
            }
        }
        // Where no sign changes another coordinate has to move, or there is no root.
        if (size * S::nearest(4.0)).is_finite() {
            *start = signed(size);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Room for vectors of three entries.
    macro_rules! room {
        ($buffer:ident of $length:expr) => {{
            $buffer.fill(Default::default());
            Room::new(&mut $buffer, $length)
        }};
    }

    #[test]
    fn each_coordinate_is_moved_to_the_order_of_its_root() {
        let mut buffer = [0.0; 60];
        for scale in [1e-90, 1e-3, 1.0, 1e90] {
            let residual = &mut |v: &[f64], r: &mut [f64]| {
                r.copy_from_slice(&[v[0].powi(3) * scale - 8.0, v[1] + 1e-200, (v[2] * v[2]).sqrt() * v[2]]);
            };
            let [mut near, mut resting, mut found] = [[0.0; 3]; 3];
            near_rest(residual, &mut near, &mut found);
            vanishing(residual, &[0.0; 3], &[0.0; 3], &near, &mut resting, room!(buffer of 3));
            assert_eq!(resting, [0.0, 0.0, near[2]]);
            found = [0.0; 3];
            away_from_rest(residual, &near, &resting, &mut found, room!(buffer of 3));
            let root = 2.0 / scale.cbrt();
            assert!(found[0] <= root && found[0] > 0.49 * root, "{found:?}");
            assert!(found[1] < 0.0 && found[1] >= -1e-200 && found[1] < -0.49e-200, "{found:?}");
            assert_eq!(found[2], 0.0);
        }
    }

    #[test]
    fn what_has_no_root_stays_at_rest() {
        let mut found = [0.0];
        let mut buffer = [0.0; 8];
        let constant = &mut |_: &[f64], r: &mut [f64]| r[0] = -1.0;
        away_from_rest(constant, &[1e-300], &[0.0], &mut found, room!(buffer of 1));
        assert_eq!(found, [0.0]);
        // In single precision as well.
        let mut found = [0.0];
        let mut buffer = [0.0; 8];
        let cubic = &mut |v: &[f32], r: &mut [f32]| r[0] = v[0].powi(3) - 8e-9;
        away_from_rest(cubic, &[1e-30], &[0.0], &mut found, room!(buffer of 1));
        assert!(found[0] > 0.9e-3 && found[0] <= 2e-3, "{found:?}");
    }

    /// v/|v| is no number at rest; |v|v vanishes there, 1 + |v|v does not.
    #[test]
    fn a_residual_vanishes_with_the_velocity_or_does_not() {
        let residual = &mut |v: &[f64], r: &mut [f64]| {
            let signed = |v: f64| v * (v / (v * v).sqrt()).powi(2);
            r.copy_from_slice(&[signed(v[0]), 1.0 + signed(v[1])]);
        };
        let mut buffer = [0.0; 16];
        let [mut near, mut found] = [[0.0; 2]; 2];
        near_rest(residual, &mut near, &mut found);
        residual(&[0.0; 2], &mut found);
        assert!(near[0].max(near[1]) < 1e-100 && found[0].is_nan());
        let rests = |p: [f64; 2], buffer: &mut [f64; 16], residual: &mut Residual<'_, f64>| {
            let mut resting = [0.0; 2];
            vanishing(residual, &p, &[0.0; 2], &near, &mut resting, Room::new(buffer, 2));
            resting.map(|rests| rests != 0.0)
        };
        assert_eq!(rests([0.0; 2], &mut buffer, residual), [true, false]);
        // A momentum below that of `near` is not taken for 0.
        assert_eq!(rests([-1e-200, 0.0], &mut buffer, residual), [false, false]);
    }
}
