//! The friction forces that hold: which elements stick, and how the others slide.
//!
//! ```text
//! u = d − A s,   |sₖ| ≤ 1,   uₖ = λₖ sₖ with λₖ ≥ 0 and λₖ = 0 where |sₖ| < 1
//! ```
//!
//! for elements k of one component (s ∈ [−1, 1]) or several (a ball): a friction force is at its limit where
//! the element slides, below it where it sticks. Sweeps that solve for one element after another lower a
//! convex objective, so that they cannot cycle; from the sets that they find Newton's method gives s to
//! rounding. The work of both is bounded.

mod balls;
mod continuation;
mod newton;

use nalgebra::{SMatrix, SVector};

use super::element::{Element, elements};
use crate::numbers::{Factored, NewtonMatrix, Scalar};

/// Rounds of sweeps, of which each has twice as many as the one before.
const ROUNDS: u32 = 12;

/// Roundings of the terms of u below which it is 0.
const ROUNDINGS: f64 = 16.0;

/// ε beside a diagonal of 1, where elements that stick are redundant.
const SHARE: f64 = 64.0;

/// The problem.
pub(super) struct Elements<'p, S, const M: usize> {
    /// How many components each element has.
    pub(super) sizes: &'p [usize],
    /// A, the slip that each force takes away.
    pub(super) response: SMatrix<S, M, M>,
    /// d, the slip without friction.
    pub(super) free: SVector<S, M>,
    /// Sizes of the terms of d.
    pub(super) terms: SVector<S, M>,
}

/// The solution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held<S, const M: usize> {
    /// s, the force of each element over its limit.
    pub(super) forces: SVector<S, M>,
    /// Whether the element of a component sticks.
    pub(super) sticks: [bool; M],
}

impl<S: Scalar, const M: usize> Elements<'_, S, M> {
    /// Solves from the forces `start`; nothing where the sets stay open.
    pub(super) fn held(&self, start: &SVector<S, M>) -> Option<Held<S, M>> {
        let mut forces = *start;
        self.sweep(&mut forces);
        self.verified(&forces).or_else(|| self.at_length(forces))
    }

    /// Further sweeps, and Newton's method from the sets that they find.
    #[cold]
    #[inline(never)]
    fn at_length(&self, mut forces: SVector<S, M>) -> Option<Held<S, M>> {
        if !self.is_finite() {
            return None;
        }
        for round in 0..ROUNDS {
            if let Some(held) = self.corrected(forces) {
                return Some(held);
            }
            if self.sizes.iter().any(|&size| size > 1)
                && let Some(held) = self.by_lengths(&forces).and_then(|forces| self.corrected(forces))
            {
                return Some(held);
            }
            for _ in 0..2_u32 << round {
                self.sweep(&mut forces);
            }
            if let Some(held) = self.verified(&forces) {
                return Some(held);
            }
        }
        self.by_continuation()
    }

    /// A correction of the forces that hold, which takes away `slip` from what sticks. Of what their impulses
    /// leave the slip is small, and elements far apart in strength no longer round each other.
    pub(super) fn rest(&self, sticks: &[bool; M], slip: &SVector<S, M>) -> Option<SVector<S, M>> {
        let mut rows: SMatrix<S, M, M> = SMatrix::identity();
        let mut left: SVector<S, M> = nalgebra::zero();
        let transposed = self.response.transpose();
        let of_rows = rows.data.0.iter_mut().zip(&transposed.data.0).zip(sticks);
        let entries = left.as_mut_slice().iter_mut().zip(slip.as_slice());
        for (k, (((row, response), sticks), (left, slip))) in of_rows.zip(entries).enumerate() {
            if *sticks {
                *row = *response;
                if let Some(own) = row.get_mut(k) {
                    *own += *own * (S::EPSILON * S::constant(SHARE));
                }
                *left = *slip;
            }
        }
        Some(NewtonMatrix::factored(&rows.transpose())?.solve(&left))
    }

    /// Whether all that stands in it is a number: else no sweep ends.
    fn is_finite(&self) -> bool {
        self.response.iter().chain(&self.free).all(|entry| entry.is_finite())
    }

    fn elements(&self) -> impl Iterator<Item = Element> + Clone {
        elements(self.sizes)
    }

    /// The diagonal of A.
    fn diagonal(&self) -> SVector<S, M> {
        let mut diagonal: SVector<S, M> = nalgebra::zero();
        for (i, (entry, column)) in diagonal.as_mut_slice().iter_mut().zip(&self.response.data.0).enumerate()
        {
            *entry = column.get(i).copied().unwrap_or(S::zero());
        }
        diagonal
    }

    /// Whether the forces of an element move nothing: it has no strength.
    fn has_no_effect(&self, element: Element) -> bool {
        element.of(&self.response.data.0).all(|column| column.iter().all(|entry| *entry == S::zero()))
    }

    /// u.
    fn slip(&self, forces: &SVector<S, M>) -> SVector<S, M> {
        self.free - self.response * forces
    }

    /// Sizes of the terms of u.
    fn terms(&self, forces: &SVector<S, M>) -> SVector<S, M> {
        let mut terms = self.terms;
        for (column, force) in self.response.data.0.iter().zip(forces.as_slice()) {
            for (term, entry) in terms.as_mut_slice().iter_mut().zip(column) {
                *term += (*entry * *force).abs();
            }
        }
        terms
    }

    /// Solves for each element in turn.
    fn sweep(&self, forces: &mut SVector<S, M>) {
        let diagonal = self.diagonal();
        for element in self.elements() {
            if element.size > 1 {
                self.solve_ball(forces, element);
                continue;
            }
            let slip = self.slip(forces);
            let heads = element.head(diagonal.as_slice()).zip(element.head(slip.as_slice()));
            let (Some((own, slip)), Some(force)) = (heads, element.head(forces.as_slice())) else { continue };
            // Without strength no force has an effect.
            let next = if own > S::zero() { within_one(force + slip / own) } else { S::zero() };
            element.write_head(forces.as_mut_slice(), next);
        }
    }

    /// The forces with what sticks, if they solve the problem to rounding.
    fn verified(&self, forces: &SVector<S, M>) -> Option<Held<S, M>> {
        let (slip, terms) = (self.slip(forces), self.terms(forces));
        let rounding = S::EPSILON * S::constant(ROUNDINGS);
        let mut sticks = [false; M];
        for element in self.elements() {
            let most = |entries: &SVector<S, M>| {
                element.of(entries.as_slice()).fold(S::zero(), |most, entry| at_least(most, entry.abs()))
            };
            let tolerance = most(&terms) * rounding;
            let (excess, along) = (element.dot(forces, forces) - S::one(), element.dot(forces, &slip));
            let is_slack = self.has_no_effect(element);
            let is_at_rest = most(&slip) <= tolerance;
            let is_sliding = || {
                let mut entries = element.of(slip.as_slice()).zip(element.of(forces.as_slice()));
                let is_along = entries.all(|(slip, force)| (*slip - along * *force).abs() <= tolerance);
                excess.abs() <= rounding && is_along && along >= S::zero()
            };
            if !(excess <= rounding && (is_slack || is_at_rest || is_sliding())) {
                return None;
            }
            element.of_mut(&mut sticks).for_each(|stick| *stick = is_at_rest && !is_slack);
        }
        Some(Held { forces: *forces, sticks })
    }
}

/// The matrix with `beside` added to its diagonal.
fn with_diagonal<S: Scalar, const M: usize>(
    matrix: &SMatrix<S, M, M>,
    beside: impl Fn(usize) -> S,
) -> SMatrix<S, M, M> {
    let mut shifted = *matrix;
    for (i, column) in shifted.data.0.iter_mut().enumerate() {
        if let Some(entry) = column.get_mut(i) {
            *entry += beside(i);
        }
    }
    shifted
}

fn within_one<S: Scalar>(value: S) -> S {
    if value > S::one() { S::one() } else { at_least(value, -S::one()) }
}

fn at_least<S: Scalar>(value: S, least: S) -> S {
    if value < least { least } else { value }
}
