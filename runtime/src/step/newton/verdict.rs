//! Whether an iterate of the damped method is the solution: the definition of `rounding.rs`, with the matrix
//! at the iterate itself.

use nalgebra::{SMatrix, SVector};

use super::Solution;
use super::rounding::{AT_FLOOR, estimated_floor, finite_part, held_against, is_sensible, rounding, scatter};
use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::{Momenta, Report, State, StepKernel};

/// The step's equation as a function of (q, v); behind a pointer where it is called seldom.
type Evaluate<'f, S, M, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>) -> StepKernel<S, N, M> + 'f;

/// Both momenta as a function of (q, v).
type Finish<'f, S, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>) -> Momenta<S, N> + 'f;

/// The mass matrix as a function of (q, v).
pub(super) type Inertia<'f, S, const N: usize> =
    dyn Fn(&SVector<S, N>, &SVector<S, N>) -> SMatrix<S, N, N> + 'f;

/// Sizes of terms that cancel in p0 as a function of (q, v).
type Cancelling<'f, S, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>) -> SVector<S, N> + 'f;

/// The equations that are solved, and the state and h that they are solved for.
pub(crate) struct Equations<'f, S, M, const N: usize> {
    pub(crate) evaluate: &'f Evaluate<'f, S, M, N>,
    pub(crate) finish: &'f Finish<'f, S, N>,
    pub(crate) inertia: &'f Inertia<'f, S, N>,
    pub(crate) cancelling: &'f Cancelling<'f, S, N>,
    pub(crate) state: &'f State<S, N>,
    /// v times this and a share leads from q to the configurations on the way.
    pub(crate) h: S,
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Equations<'_, S, M, N> {
    /// The terms of the equation: |p| + |M||v|, with which the forces balance, and p0 at rest.
    fn terms(&self, v: &SVector<S, N>) -> SVector<S, N> {
        let State { q, p } = self.state;
        let at_rest = (self.finish)(q, &nalgebra::zero()).p0;
        finite_part(p) + finite_part(&(self.inertia)(q, v).magnitudes(v)) + finite_part(&at_rest)
    }

    /// The size of forces that cancel at rest: what rounding takes of them, over ε.
    fn forces_at_rest(&self) -> SVector<S, N> {
        let measured = rounding(|q, v| (self.finish)(q, v).p0, &self.state.q, &nalgebra::zero());
        finite_part(&(measured * (S::one() / S::EPSILON)))
    }
}

/// An iterate, the Newton step from it, and the measure of its residual.
pub(super) struct Iterate<S, M, const N: usize> {
    pub(super) v: SVector<S, N>,
    pub(super) residual: SVector<S, N>,
    pub(super) matrix: M,
    /// The full Newton step leads to v − correction.
    pub(super) correction: SVector<S, N>,
    pub(super) floor: SVector<S, N>,
    /// max |residualᵢ|/floorᵢ.
    pub(super) size: S,
}

/// The solution at `v`, where the Newton matrix is `matrix`; nothing if it is none. With `may_round`, the
/// rounding of q and v may explain a residual that has stopped falling.
#[cold]
#[inline(never)]
pub(super) fn verified<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    of: &Equations<'_, S, M, N>,
    v: &SVector<S, N>,
    matrix: &M,
    last_correction: S,
    [iterations, damped]: [u32; 2],
    may_round: bool,
) -> Option<Solution<S, N>> {
    let State { q, p } = of.state;
    let momenta = (of.finish)(q, v);
    let remaining = momenta.p0 - p;
    let mut floor = estimated_floor(p, matrix, v);
    let mut held = held_against(&remaining, &floor);
    if !held.2 && !may_round || !last_correction.is_finite() {
        return None;
    }
    let mut terms = of.terms(v);
    let mut has_forces = false;
    if !held.2 {
        let cancelling = finite_part(&(of.cancelling)(q, v));
        floor += cancelling * S::EPSILON;
        terms += cancelling;
        held = held_against(&remaining, &floor);
    }
    if !held.2 {
        // Far above what any sensible floor explains, none is measured: of a step that fails, that would be
        // most of the cost.
        if !may_be_explained(&remaining, &terms) {
            terms += of.forces_at_rest();
            has_forces = true;
            if !may_be_explained(&remaining, &terms) {
                return None;
            }
        }
        // In J the momentum and the forces may cancel: both are rounded.
        let momentum = (of.inertia)(q, v).magnitudes(v) * (S::EPSILON * S::constant(8.0));
        floor += rounding(|q, v| (of.finish)(q, v).p0, q, v) + momentum;
        held = held_against(&remaining, &floor);
        if !held.2 {
            floor += scatter(|v| (of.finish)(q, v).p0, q, v, of.h);
            held = held_against(&remaining, &floor);
        }
        if !held.2 {
            return None;
        }
    }
    if !is_sensible(&floor, &terms) && (has_forces || !is_sensible(&floor, &(terms + of.forces_at_rest()))) {
        return None;
    }
    let (residual, floor, _) = held;
    let report = Report { iterations, damped, residual, floor, last_correction };
    Some(Solution { unknown: *v, momenta, report })
}

/// The root at an iterate whose residual has stopped falling, if rounding holds the residual up there.
/// `trial` is where the Newton step led, with the matrix there, and whether that still lowered it.
#[cold]
pub(super) fn stagnated<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    of: &Equations<'_, S, M, N>,
    last: &Iterate<S, M, N>,
    (trial, matrix, lower): (&SVector<S, N>, &M, bool),
    counts: [u32; 2],
) -> Option<Solution<S, N>> {
    let last_correction = last.correction.amax();
    // One component that rounding holds up can hide that the step has brought the others down.
    match verified(of, trial, matrix, last_correction, counts, true) {
        None if !lower => verified(of, &last.v, &last.matrix, last_correction, counts, true),
        found => found,
    }
}

/// Whether a floor that [`is_sensible`] beside `terms` can be that of the residual.
#[cold]
fn may_be_explained<S: Scalar, const N: usize>(residual: &SVector<S, N>, terms: &SVector<S, N>) -> bool {
    is_sensible(&(residual * (S::one() / S::constant(AT_FLOOR))), terms)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{matrix, vector};

    /// A residual of `off` floors at v = 1, for p = 1 and a mass of 1 that `stiffness` is added to.
    fn is_solved(off: f64, stiffness: f64, correction: f64) -> bool {
        let one = vector![1.0];
        let state = State { q: one, p: one };
        let unit = 8.0 * f64::EPSILON;
        let momenta = |_: &SVector<f64, 1>, v: &SVector<f64, 1>| Momenta {
            p0: v.map(|v| if v == 1.0 { 1.0 + off * unit } else { v }),
            p1: SVector::zeros(),
        };
        let matrix = matrix![1.0 + stiffness];
        let of = Equations {
            evaluate: &|q, v| StepKernel { p0: momenta(q, v).p0, matrix },
            finish: &momenta,
            inertia: &|_, _| matrix![1.0],
            cancelling: &|_, _| vector![0.0],
            state: &state,
            h: 1.0,
        };
        verified(&of, &one, &matrix, correction, [1, 0], false).is_some()
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
}
