//! Whether an iterate of the damped method is the solution: the definition of `step/newton/rounding.rs`, with
//! the matrix at the iterate itself.

use super::equations::{Equations, Matrix, Root, Solved};
use super::rounding::{
    AT_FLOOR, add_finite_part, add_rounding, add_scatter, estimated_floor, held_against, is_sensible,
};
use super::vectors::{Room, add, copy, subtract};
use crate::numbers::Precision;

/// Adds the terms of the equation: |p| + |M||v|, with which the forces balance, and p0 at rest.
#[inline(never)]
fn add_terms<S: Precision>(of: &Equations<'_, S>, v: &[S], terms: &mut [S], mut room: Room<'_, S>) {
    let (found, rest) = (room.vector(), room.zeros());
    add_finite_part(terms, S::one(), of.p);
    of.evaluate.magnitudes(Matrix::Mass { q: of.q, v }, v, found);
    add_finite_part(terms, S::one(), found);
    of.p0(of.q, rest, found, room);
    add_finite_part(terms, S::one(), found);
}

/// Adds the size of forces that cancel at rest: what rounding takes of them, over ε.
#[inline(never)]
fn add_forces_at_rest<S: Precision>(of: &Equations<'_, S>, terms: &mut [S], mut room: Room<'_, S>) {
    let [rest, measured] = [room.zeros(), room.zeros()];
    add_rounding(of, rest, measured, room);
    add_finite_part(terms, S::one() / S::SPACING, measured);
}

/// How an iterate was reached.
#[derive(Clone, Copy)]
pub(super) struct Counts<S> {
    pub(super) iterations: u32,
    pub(super) damped: u32,
    pub(super) last_correction: S,
}

/// The solution at `v`, where the Newton matrix is `matrix`; nothing if it is none. With `may_round`, the
/// rounding of q and v may explain a residual that has stopped falling.
#[inline(never)]
pub(super) fn verified<S: Precision>(
    of: &Equations<'_, S>,
    (v, matrix): (&[S], Matrix<'_, S>),
    Counts { iterations, damped, last_correction }: Counts<S>,
    may_round: bool,
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Solved<S>> {
    let [remaining, floor, found] = room.vectors();
    let terms = room.zeros();
    of.momenta(of.q, v, root.p0, root.p1, room.inner());
    copy(remaining, root.p0);
    subtract(remaining, of.p);
    estimated_floor(of, matrix, v, floor, room.inner());
    let mut held = held_against(remaining, floor);
    if !held.2 && !may_round || !last_correction.is_finite() {
        return None;
    }
    add_terms(of, v, terms, room.inner());
    let mut has_forces = false;
    if !held.2 {
        of.evaluate.cancelling(of.q, v, of.h, found);
        add_finite_part(floor, S::SPACING, found);
        add_finite_part(terms, S::one(), found);
        held = held_against(remaining, floor);
    }
    if !held.2 {
        // Far above what any sensible floor explains, none is measured: of a step that fails, that would be
        // most of the cost.
        let least = &mut *found;
        for (least, remaining) in least.iter_mut().zip(remaining.iter()) {
            *least = *remaining * (S::one() / S::nearest(AT_FLOOR));
        }
        if !is_sensible(least, terms) {
            add_forces_at_rest(of, terms, room.inner());
            has_forces = true;
            if !is_sensible(least, terms) {
                return None;
            }
        }
        // In J the momentum and the forces may cancel: both are rounded.
        of.evaluate.magnitudes(Matrix::Mass { q: of.q, v }, v, found);
        add_rounding(of, v, floor, room.inner());
        add(floor, S::SPACING * S::nearest(8.0), found);
        held = held_against(remaining, floor);
        if !held.2 {
            add_scatter(of, v, floor, room.inner());
            held = held_against(remaining, floor);
        }
        if !held.2 {
            return None;
        }
    }
    if !is_sensible(floor, terms) {
        if !has_forces {
            add_forces_at_rest(of, terms, room);
        }
        if has_forces || !is_sensible(floor, terms) {
            return None;
        }
    }
    copy(root.v, v);
    let (residual, floor, _) = held;
    Some(Solved { iterations, damped, residual, floor, last_correction })
}

/// The root at an iterate whose residual has stopped falling, if rounding holds the residual up there: at
/// `trial`, where the Newton step led, or, unless that still lowered it, at `last`.
#[inline(never)]
pub(super) fn stagnated<S: Precision>(
    of: &Equations<'_, S>,
    last: &[S],
    (trial, lower): (&[S], bool),
    counts: Counts<S>,
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Solved<S>> {
    // One component that rounding holds up can hide that the step has brought the others down.
    match verified(of, (trial, Matrix::Present), counts, true, root, room.inner()) {
        None if !lower => verified(of, (last, Matrix::Before), counts, true, root, room),
        found => found,
    }
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
            p0[0] = if v[0] == 1.0 { 1.0 + self.off } else { v[0] };
        }
        fn magnitudes(&self, of: Matrix<'_, f64>, v: &[f64], sums: &mut [f64]) {
            let matrix = if matches!(of, Matrix::Mass { .. }) { 1.0 } else { self.matrix };
            sums[0] = (matrix * v[0]).abs();
        }
        fn kernel(&mut self, _: &[f64], _: &[f64], _: f64, _: &[f64], _: &mut [f64]) {}
        fn keep(&mut self) {}
        fn solve(&self, _: &[f64], _: &mut [f64]) -> Result<(), Singular> {
            Err(Singular { column: 0 })
        }
        fn diagonal(&self, _: Matrix<'_, f64>, _: &mut [f64]) {}
        fn row_is_finite(&self, _: usize) -> bool {
            true
        }
        fn cancelling(&self, _: &[f64], _: &[f64], _: f64, _: &mut [f64]) {}
    }

    /// Whether a residual of `off` floors at v = 1 is that of a root, with a mass of 1 that `stiffness` is
    /// added to.
    fn is_solved(off: f64, stiffness: f64, last_correction: f64) -> bool {
        let mut evaluate = One { off: off * 8.0 * f64::EPSILON, matrix: 1.0 + stiffness };
        let of = Equations { evaluate: &mut evaluate, q: &[1.0], p: &[1.0], h: 1.0, held: &[0.0] };
        let counts = Counts { iterations: 1, damped: 0, last_correction };
        let mut root = Root { v: &mut [0.0], p0: &mut [0.0], p1: &mut [0.0] };
        let buffer = &mut [0.0; VECTORS];
        verified(&of, (&[1.0], Matrix::Present), counts, false, &mut root, Room::new(buffer, 1)).is_some()
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
    /// measured of an equation in which another coordinate rests; or of the whole equation, with 4 vectors more
    /// held from rest. Room for one vector less does not do.
    #[test]
    fn there_is_room_for_the_deepest_calls() {
        let is_enough = |vectors: usize, from_rest: usize, held: [f64; 2]| {
            std::panic::catch_unwind(|| {
                let mut evaluate = One { off: 1.0, matrix: 1.0 };
                let of =
                    Equations { evaluate: &mut evaluate, q: &[1.0; 2], p: &[1.0; 2], h: 1.0, held: &held };
                let counts = Counts { iterations: 1, damped: 0, last_correction: 1e-14 };
                let mut root = Root { v: &mut [0.0; 2], p0: &mut [0.0; 2], p1: &mut [0.0; 2] };
                let mut buffer = vec![0.0; 2 * vectors];
                let mut room = Room::new(&mut buffer, 2);
                for _ in 0..from_rest + 7 {
                    room.vector();
                }
                verified(&of, (&[1.0; 2], Matrix::Present), counts, true, &mut root, room);
            })
            .is_ok()
        };
        for (from_rest, held) in [(4, [0.0, 1e-300]), (8, [0.0; 2])] {
            assert!(is_enough(VECTORS, from_rest, held));
            assert!(!cfg!(debug_assertions) || !is_enough(VECTORS - 1, from_rest, held));
        }
    }
}
