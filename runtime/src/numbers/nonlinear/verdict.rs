//! Whether an iterate of the damped method is the solution: the definition of `step/newton/rounding.rs`, with
//! the matrix at the iterate itself.

use super::equations::{Equations, Matrix, Root, Solved};
use super::noise::{Left, WITHIN_NOISE, add_noise, is_same_around};
use super::rounding::{
    AT_FLOOR, SLOW, add_finite_part, add_rounding, add_scatter, estimated_floor, held_against, is_sensible,
};
use super::twice::{Twice, is_rounded_twice, move_alike};
use super::vectors::{MEASURES_NOISE, Room, add, copy, subtract, sum};
use crate::numbers::Precision;

/// Adds the terms of the equation: |p| + |M||v|, with which the forces balance, p0 at rest, and what holds.
#[inline(never)]
fn add_terms<S: Precision>(of: &Equations<'_, S>, v: &[S], terms: &mut [S], mut room: Room<'_, S>) {
    let (found, rest) = (room.vector(), room.zeros());
    add_finite_part(terms, S::one(), of.p);
    of.evaluate.magnitudes(Matrix::Mass { q: of.q, v }, v, found);
    add_finite_part(terms, S::one(), found);
    of.p0(of.q, rest, found, room);
    add_finite_part(terms, S::one(), found);
    of.evaluate.add_holding(of.q, v, of.h, terms);
}

/// Adds the size of forces that cancel at rest: what rounding takes of them, over ε.
#[inline(never)]
fn add_forces_at_rest<S: Precision>(of: &Equations<'_, S>, terms: &mut [S], mut room: Room<'_, S>) {
    let [rest, measured] = [room.zeros(), room.zeros()];
    add_rounding(of, rest, measured, room);
    add_finite_part(terms, S::one() / S::SPACING, measured);
}

/// Newton steps by the momenta at most, of which one nearly always does.
const MOST_POLISHING: u32 = 3;

/// How an iterate was reached.
#[derive(Clone, Copy)]
pub(super) struct Counts<S> {
    pub(super) iterations: u32,
    pub(super) damped: u32,
    pub(super) last_correction: S,
}

/// Roundings that may explain a residual.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Rounding {
    /// The floor alone.
    Floor,
    /// Terms that cancel as well.
    Terms,
    /// Any: of a residual that has stopped falling.
    Any,
}

/// The solution at `v`, where the Newton matrix is `matrix`; nothing if it is none. With [`Rounding::Any`]
/// the present matrix may be another one then.
#[inline(never)]
pub(super) fn verified<S: Precision>(
    of: &mut Equations<'_, S>,
    (v, matrix): (&[S], Matrix<'_, S>),
    Counts { iterations, damped, last_correction }: Counts<S>,
    rounding: Rounding,
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Solved<S>> {
    let [remaining, floor] = room.vectors();
    let estimated = if MEASURES_NOISE { room.vector() } else { &mut [] };
    of.momenta(of.q, v, root.p0, root.p1, room.inner());
    copy(remaining, root.p0);
    subtract(remaining, of.p);
    estimated_floor(of, matrix, v, floor, room.inner());
    copy(estimated, floor);
    let held = held_against(remaining, floor);
    if !held.2 && rounding == Rounding::Floor || !last_correction.is_finite() {
        return None;
    }
    copy(root.v, v);
    let is_root = if held.2 {
        let terms = room.zeros();
        add_terms(of, v, terms, room.inner());
        is_sensible_at_rest(of, floor, terms, room.inner())
    } else {
        is_explained(of, v, remaining, floor, rounding, room.inner())
            || MEASURES_NOISE && rounding == Rounding::Any && {
                is_polished(of, root.v, remaining, estimated, room.inner()) && {
                    of.momenta(of.q, root.v, root.p0, root.p1, room.inner());
                    // Not that of an iterate on the way.
                    of.evaluate(root.v, estimated);
                    estimated_floor(of, Matrix::Present, root.v, floor, room.inner());
                    is_explained(of, root.v, remaining, floor, rounding, room.inner())
                }
            }
    };
    if !is_root {
        return None;
    }
    let (residual, floor, _) = held_against(remaining, floor);
    Some(Solved { iterations, damped, residual, floor, last_correction })
}

/// The Newton step from `v` to `next`, and what is `left` there by the momenta.
fn step_by<S: Precision>(
    of: &Equations<'_, S>,
    v: &[S],
    correction: &[S],
    (next, left): (&mut [S], &mut [S]),
    room: Room<'_, S>,
) {
    sum(next, v, -S::one(), correction);
    of.p0(of.q, next, left, room);
    subtract(left, of.p);
}

/// Whether Newton's method is seen to take down each residual that the floor does not explain.
fn is_lower<S: Precision>(now: &[S], before: &[S], floor: &[S]) -> bool {
    let mut entries = now.iter().zip(before).zip(floor);
    entries.all(|((now, before), floor)| {
        before.abs() <= *floor * S::nearest(AT_FLOOR) || now.abs() <= before.abs() * S::nearest(SLOW)
    })
}

/// Goes on from `v` as long as Newton steps take off what is `remaining` by the momenta, which may round
/// otherwise than the kernel, whose residual has led here; whether they have.
#[inline(never)]
fn is_polished<S: Precision>(
    of: &mut Equations<'_, S>,
    v: &mut [S],
    remaining: &mut [S],
    floor: &[S],
    mut room: Room<'_, S>,
) -> bool {
    let [correction, next, left] = room.vectors();
    for step in 0..MOST_POLISHING {
        of.evaluate(v, left);
        if of.evaluate.solve(remaining, correction).is_err() {
            return step > 0;
        }
        step_by(of, v, correction, (next, left), room.inner());
        if !is_lower(left, remaining, floor) || !is_same_around(of, v, remaining, correction, room.inner()) {
            return step > 0;
        }
        copy(v, next);
        copy(remaining, left);
    }
    true
}

/// Whether the `floor` is small beside the `terms`, with the forces that cancel at rest where it is not
/// beside the others.
#[inline(never)]
fn is_sensible_at_rest<S: Precision>(
    of: &Equations<'_, S>,
    floor: &[S],
    terms: &mut [S],
    room: Room<'_, S>,
) -> bool {
    if is_sensible(floor, terms) {
        return true;
    }
    add_forces_at_rest(of, terms, room);
    is_sensible(floor, terms)
}

/// Whether what rounds explains what is `remaining`, and is added to the `floor`: terms that cancel, noise,
/// last places.
#[inline(never)]
fn is_explained<S: Precision>(
    of: &mut Equations<'_, S>,
    v: &[S],
    remaining: &[S],
    floor: &mut [S],
    rounding: Rounding,
    mut room: Room<'_, S>,
) -> bool {
    let found = room.vector();
    let terms = room.zeros();
    add_terms(of, v, terms, room.inner());
    of.evaluate.cancelling(of.q, v, of.h, found);
    add_finite_part(floor, S::SPACING, found);
    add_finite_part(terms, S::one(), found);
    if held_against(remaining, floor).2 {
        return is_sensible_at_rest(of, floor, terms, room);
    }
    if rounding == Rounding::Terms {
        return false;
    }
    // Far above what any sensible floor explains, no last places are moved: of a step that fails, that would
    // be most of the cost.
    for (least, remaining) in found.iter_mut().zip(remaining.iter()) {
        *least = *remaining * (S::one() / S::nearest(AT_FLOOR));
    }
    let may_be_places = is_sensible_at_rest(of, found, terms, room.inner());
    // More than half of the digits are no noise but a jump: so far around it a smooth function scatters, too.
    let may_be_noise = may_be_places && {
        add_forces_at_rest(of, terms, room.inner());
        remaining.iter().zip(terms.iter()).all(|(left, term)| *left * *left <= *term * *term * S::SPACING)
    };
    if MEASURES_NOISE && may_be_noise && is_noise(of, v, remaining, floor, room.inner()) {
        return true;
    }
    if !may_be_places {
        return false;
    }
    // In J the momentum and the forces may cancel: both are rounded.
    of.evaluate.magnitudes(Matrix::Mass { q: of.q, v }, v, found);
    add_rounding(of, v, floor, room.inner());
    add(floor, S::SPACING * S::nearest(8.0), found);
    if !held_against(remaining, floor).2 {
        add_scatter(of, v, floor, room.inner());
        if !held_against(remaining, floor).2 {
            return false;
        }
    }
    is_sensible_at_rest(of, floor, terms, room)
}

/// Whether what is `remaining` at `at` is the noise of the equation, which is added to the `floor`.
#[inline(never)]
fn is_noise<S: Precision>(
    of: &mut Equations<'_, S>,
    at: &[S],
    remaining: &[S],
    floor: &mut [S],
    mut room: Room<'_, S>,
) -> bool {
    let [correction, kernel, moved] = room.vectors();
    let [change, before] = room.vectors();
    of.evaluate(at, kernel);
    if of.evaluate.solve(remaining, correction).is_err() {
        return false;
    }
    // Where a product of step sizes underflows, the matrix is not that of the equation.
    let is_matrix = of.h * of.h > S::LEAST_NORMAL;
    if !is_matrix || !is_same_around(of, at, remaining, correction, room.inner()) {
        return false;
    }
    if held_against(kernel, floor).2 {
        let found = Twice { momenta: remaining, kernel };
        if is_rounded_twice(of, (at, correction), &found, floor, room.inner()) {
            for ((floor, momenta), kernel) in floor.iter_mut().zip(remaining).zip(kernel.iter()) {
                *floor += (*momenta - *kernel).abs();
            }
            return true;
        }
    }
    // By a matrix that is the same around, the next step takes off nearly all of what is no noise.
    let next = &mut *change;
    step_by(of, at, correction, (moved, next), room.inner());
    if is_lower(next, remaining, floor) {
        return false;
    }
    of.evaluate(at, change);
    of.evaluate.magnitudes(Matrix::Present, correction, change);
    copy(before, floor);
    let (own, mut room) = room.split(WITHIN_NOISE);
    let mut function = |v: &[S], residual: &mut [S]| {
        move_alike(moved, of.q, of.h, v, at);
        of.p0(moved, v, residual, room.inner());
        subtract(residual, of.p);
    };
    let left = Left { at, residual: remaining, correction, change, floor: before };
    add_noise(&mut function, &left, floor, own)
}

/// The root at an iterate whose residual has stopped falling, if rounding holds the residual up there: at
/// `trial`, where the Newton step led, or, unless that still lowered it, at `last`.
#[inline(never)]
pub(super) fn stagnated<S: Precision>(
    of: &mut Equations<'_, S>,
    last: &[S],
    (trial, lower): (&[S], bool),
    counts: Counts<S>,
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Solved<S>> {
    // One component that rounding holds up can hide that the step has brought the others down.
    let mut found = verified(of, (trial, Matrix::Present), counts, Rounding::Any, root, room.inner());
    if found.is_none() && !lower {
        found = verified(of, (last, Matrix::Before), counts, Rounding::Any, root, room.inner());
    }
    // Where noise is measured, the matrix is evaluated elsewhere.
    if MEASURES_NOISE && found.is_none() {
        of.evaluate(trial, room.vector());
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::{VECTORS, equations::Evaluate};
    use super::*;
    use crate::numbers::Singular;

    /// p0 = 1 + `off` at v = 1, where p = 1, and v elsewhere; a mass of 1, and a matrix.
    struct One {
        off: f64,
        matrix: f64,
    }

    impl Evaluate<f64> for One {
        fn momenta(&self, _: &[f64], v: &[f64], _: f64, p0: &mut [f64], _: &mut [f64]) {
            for (p0, v) in p0.iter_mut().zip(v) {
                *p0 = if *v == 1.0 { 1.0 + self.off } else { *v };
            }
        }
        fn magnitudes(&self, of: Matrix<'_, f64>, v: &[f64], sums: &mut [f64]) {
            let matrix = if matches!(of, Matrix::Mass { .. }) { 1.0 } else { self.matrix };
            for (sum, v) in sums.iter_mut().zip(v) {
                *sum = (matrix * v).abs();
            }
        }
        fn kernel(&mut self, q: &[f64], v: &[f64], h: f64, _: &[f64], p0: &mut [f64]) {
            self.momenta(q, v, h, p0, &mut []);
        }
        fn keep(&mut self) {}
        fn solve(&self, right: &[f64], x: &mut [f64]) -> Result<(), Singular> {
            x.copy_from_slice(right);
            Ok(())
        }
        fn diagonal(&self, _: Matrix<'_, f64>, entries: &mut [f64]) {
            entries.fill(1.0);
        }
        fn row_is_finite(&self, _: usize) -> bool {
            true
        }
        fn cancelling(&self, _: &[f64], _: &[f64], _: f64, _: &mut [f64]) {}
    }

    /// Whether a residual of `off` floors at v = 1 is that of a root, with a mass of 1 that `stiffness` is
    /// added to.
    fn is_solved(off: f64, stiffness: f64, last_correction: f64) -> bool {
        let mut evaluate = One { off: off * 8.0 * f64::EPSILON, matrix: 1.0 + stiffness };
        let mut of = Equations { evaluate: &mut evaluate, q: &[1.0], p: &[1.0], h: 1.0, held: &[0.0] };
        let counts = Counts { iterations: 1, damped: 0, last_correction };
        let mut root = Root { v: &mut [0.0], p0: &mut [0.0], p1: &mut [0.0] };
        let buffer = &mut [0.0; VECTORS];
        verified(&mut of, (&[1.0], Matrix::Present), counts, Rounding::Floor, &mut root, Room::new(buffer, 1))
            .is_some()
    }

    #[test]
    fn a_residual_of_four_floors_is_solved_and_of_more_is_not() {
        assert!(is_solved(0.0, 0.0, 1e-14) && is_solved(3.5, 0.0, 1e-14));
        for off in [5.0, 100.0, 4096.0] {
            assert!(!is_solved(off, 0.0, 1e-14));
        }
    }

    /// Found by fuzzing: a chain of springs with energies of 1e210 took a step that way.
    #[test]
    fn a_correction_that_overflows_leads_to_no_solution() {
        assert!(!is_solved(0.0, 0.0, f64::INFINITY));
    }

    /// A matrix so large that a step of one last place moves p0 by more than all that it is made of.
    #[test]
    fn a_floor_above_the_terms_explains_nothing() {
        assert!(is_solved(100.0, 1e3, 1e-14));
        for stiffness in [1e13, 1e200, 1e308] {
            assert!(!is_solved(100.0, stiffness, 1e-14));
        }
    }

    /// The deepest calls, behind those that hold 4 vectors from rest and 7 of the damped method: rounding is
    /// measured of an equation in which another coordinate rests; or of the whole equation, with 4 vectors
    /// more held from rest. Room for one vector less does not do.
    #[test]
    fn there_is_room_for_the_deepest_calls() {
        let is_enough = |vectors: usize, from_rest: usize, held: [f64; 2]| {
            std::panic::catch_unwind(|| {
                let mut evaluate = One { off: 1e-9, matrix: 1.0 };
                let mut of =
                    Equations { evaluate: &mut evaluate, q: &[1.0; 2], p: &[1.0; 2], h: 1.0, held: &held };
                let counts = Counts { iterations: 1, damped: 0, last_correction: 1e-14 };
                let mut root = Root { v: &mut [0.0; 2], p0: &mut [0.0; 2], p1: &mut [0.0; 2] };
                let mut buffer = vec![0.0; 2 * vectors];
                let mut room = Room::new(&mut buffer, 2);
                for _ in 0..from_rest + 7 {
                    room.vector();
                }
                verified(&mut of, (&[1.0; 2], Matrix::Present), counts, Rounding::Any, &mut root, room);
            })
            .is_ok()
        };
        for (from_rest, held) in [(4, [0.0, 1e-300]), (8, [0.0; 2])] {
            assert!(is_enough(VECTORS, from_rest, held));
            assert!(!cfg!(debug_assertions) || !is_enough(VECTORS - 1, from_rest, held));
        }
    }
}
