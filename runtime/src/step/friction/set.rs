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

use nalgebra::{SMatrix, SVector};

use super::element::{Element, elements};
use crate::numbers::{Factored, NewtonMatrix, Scalar};

/// Rounds of sweeps, of which each has twice as many as the one before.
const ROUNDS: u32 = 12;

/// Newton iterations from the sets of a sweep, each of which may change them.
const CORRECTIONS: u32 = 64;

/// Iterations after which they change one element at a time, the first that is wrong: all at once may cycle,
/// and one at a time cannot where elements have one component each (K. G. Murty, 1974).
const AT_ONCE: u32 = 8;

/// Iterations for the unknowns λ of several balls.
const OF_LENGTHS: u32 = 16;

/// Iterations for the one unknown λ of a ball.
const OF_BALL: u32 = 32;

/// The least part of ρ that is left from one problem to the next.
const CONTINUATION: f64 = 0.25;

/// The most problems on the way to ρ = 0.
const PROBLEMS: u32 = 256;

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

    /// From elements that give way to each force by itself, ρ s beside A s, to none that do: at first each
    /// stands alone, and the forces change little from ρ to ρ. Where they change too much, ρ falls by less.
    fn by_continuation(&self) -> Option<Held<S, M>> {
        let most = self.diagonal().amax();
        let (mut forces, mut rho, mut factor) = (nalgebra::zero(), most, S::constant(CONTINUATION));
        for _ in 0..PROBLEMS {
            if rho <= most * S::EPSILON {
                break;
            }
            let next = rho * factor;
            let near = Elements { response: with_diagonal(&self.response, |_| next), ..*self };
            let by_lengths = || near.corrected(near.by_lengths(&forces)?);
            match near.corrected(forces).or_else(by_lengths) {
                Some(held) => {
                    (forces, rho) = (held.forces, next);
                    factor = at_least(factor * factor, S::constant(CONTINUATION));
                }
                None => factor = factor.sqrt(),
            }
        }
        self.corrected(forces)
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

    /// A on the components of an element, and those of the unit matrix elsewhere.
    fn own_response(&self, element: Element) -> SMatrix<S, M, M> {
        let mut matrix: SMatrix<S, M, M> = SMatrix::identity();
        let columns = element.of_mut(&mut matrix.data.0).zip(element.of(&self.response.data.0));
        columns
            .for_each(|(own, column)| element.of_mut(own).zip(element.of(column)).for_each(|(a, b)| *a = *b));
        matrix
    }

    /// (A + λ) s = r on the components of a ball, with λ = 0 if |s| ≤ 1 and |s| = 1 otherwise.
    #[inline(never)]
    fn solve_ball(&self, forces: &mut SVector<S, M>, element: Element) {
        let own = element.part(forces);
        let right = element.part(&self.slip(&(*forces - own)));
        let matrix = self.own_response(element);
        let (mut found, mut lambda): (SVector<S, M>, S) = (nalgebra::zero(), S::zero());
        for _ in 0..OF_BALL {
            // Without strength no force has an effect.
            let Some(factored) = NewtonMatrix::factored(&with_diagonal(&matrix, |_| lambda)) else { break };
            let s = factored.solve(&right);
            let length = element.length(&s);
            let is_inside = length <= S::one() && lambda == S::zero();
            found = if is_inside { s } else { s / length };
            // 1/|s| is nearly linear in λ: Newton's method is soon at the last place.
            let slope = element.dot(&s, &factored.solve(&s));
            let next = at_least(lambda + length * length * (length - S::one()) / slope, S::zero());
            if is_inside || !next.is_finite() || next == lambda {
                break;
            }
            lambda = next;
        }
        *forces += found - own;
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

    /// The solution by Newton's method on the sets of `forces`, which follow it: an element that would have
    /// to be held by more than its limit slides, one that would slide against its force sticks.
    #[inline(never)]
    fn corrected(&self, mut forces: SVector<S, M>) -> Option<Held<S, M>> {
        let mut sticks = [false; M];
        let inside = S::one() - S::EPSILON * S::constant(ROUNDINGS);
        let mut share = S::EPSILON * S::constant(SHARE);
        for element in self.elements() {
            let is_inside = element.dot(&forces, &forces) < inside;
            element.of_mut(&mut sticks).for_each(|stick| *stick = is_inside);
        }
        for iteration in 0..CORRECTIONS {
            let (matrix, residual) = self.linearized(&mut forces, &sticks, share);
            let Some(factored) = NewtonMatrix::factored(&matrix) else {
                // What is left is corrected again: a larger share makes that slower, and no root another.
                share *= S::constant(SHARE);
                if share * share > S::EPSILON {
                    return None;
                }
                continue;
            };
            forces += factored.solve(&residual);
            let slides = |element: &Element, sticks: &[bool; M]| element.head(sticks) == Some(false);
            for element in self.elements().filter(|element| slides(element, &sticks)) {
                let length = element.length(&forces);
                if length > S::zero() {
                    element.divide(&mut forces, length);
                }
            }
            if let Some(held) = self.verified(&forces) {
                return Some(held);
            }
            let slip = self.slip(&forces);
            for element in self.elements() {
                let (length, along) = (element.length(&forces), element.dot(&forces, &slip));
                if !slides(&element, &sticks) && length > S::one() {
                    element.divide(&mut forces, length);
                    element.of_mut(&mut sticks).for_each(|stick| *stick = false);
                } else if slides(&element, &sticks) && along < S::zero() {
                    element.of_mut(&mut sticks).for_each(|stick| *stick = true);
                } else {
                    continue;
                }
                if iteration >= AT_ONCE {
                    break;
                }
            }
            // At their limits they may hold as well.
            if let Some(held) = self.verified(&forces) {
                return Some(held);
            }
        }
        None
    }

    /// Minus the derivative by s of the equations on these sets, and the equations: u = 0 of what sticks, and
    /// of a ball that slides u − (u·s)s − ½|u|(|s|² − 1)s = 0. Forces without effect, or at a limit of one
    /// component, are written.
    fn linearized(
        &self,
        forces: &mut SVector<S, M>,
        sticks: &[bool; M],
        share: S,
    ) -> (SMatrix<S, M, M>, SVector<S, M>) {
        let slip = self.slip(forces);
        // Row by row.
        let mut rows: SMatrix<S, M, M> = SMatrix::identity();
        let mut residual: SVector<S, M> = nalgebra::zero();
        let transposed = self.response.transpose();
        for element in self.elements() {
            let of_rows = element.of_mut(&mut rows.data.0).zip(element.of(&transposed.data.0));
            let of_rows = of_rows.zip(element.of_mut(residual.as_mut_slice())).enumerate();
            if self.has_no_effect(element) {
                element.of_mut(forces.as_mut_slice()).for_each(|force| *force = S::zero());
            } else if element.head(sticks) == Some(true) {
                for (k, ((row, response), residual)) in of_rows {
                    *row = *response;
                    if let Some(own) = row.get_mut(element.first + k) {
                        *own += *own * share;
                    }
                    *residual = slip.get(element.first + k).copied().unwrap_or(S::zero());
                }
            } else if element.size == 1 {
                let is_back = element.head(forces.as_slice()).is_some_and(|force| force < S::zero());
                element.write_head(forces.as_mut_slice(), if is_back { -S::one() } else { S::one() });
            } else {
                let (along, scale) = (element.dot(forces, &slip), element.length(&slip));
                let excess = S::constant(0.5) * scale * (element.dot(forces, forces) - S::one());
                // s·A, and by what s moves u·s and the excess.
                let mut by_length = -(transposed * element.part(forces));
                let own = element.of(slip.as_slice()).zip(element.of(forces.as_slice()));
                element
                    .of_mut(by_length.as_mut_slice())
                    .zip(own)
                    .for_each(|(entry, (slip, force))| *entry += *slip + scale * *force);
                for (k, ((row, response), residual)) in of_rows {
                    let force = forces.get(element.first + k).copied().unwrap_or(S::zero());
                    let entries = row.iter_mut().zip(response).zip(by_length.as_slice());
                    entries
                        .for_each(|((entry, response), by_length)| *entry = *response + force * *by_length);
                    if let Some(own) = row.get_mut(element.first + k) {
                        *own += along + excess;
                    }
                    let slip = slip.get(element.first + k).copied().unwrap_or(S::zero());
                    *residual = slip - (along + excess) * force;
                }
            }
        }
        (rows.transpose(), residual)
    }

    /// The forces near the solution by Newton's method for λ from that of `forces`: (A + λ) s = d, where sₖ
    /// of elements that slide is to have the length 1. λ of no element falls below 0, where it sticks.
    #[inline(never)]
    fn by_lengths(&self, forces: &SVector<S, M>) -> Option<SVector<S, M>> {
        let (slip, diagonal) = (self.slip(forces), self.diagonal());
        let mut limited = *forces;
        // Of each element at its first component.
        let mut lambda: SVector<S, M> = nalgebra::zero();
        for element in self.elements() {
            element.write_head(lambda.as_mut_slice(), at_least(element.dot(forces, &slip), S::zero()));
        }
        for _ in 0..OF_LENGTHS {
            let mut beside: SVector<S, M> = nalgebra::zero();
            for element in self.elements() {
                let shift = element.head(lambda.as_slice()).unwrap_or(S::zero());
                let own = element.of_mut(beside.as_mut_slice()).zip(element.of(diagonal.as_slice()));
                own.for_each(|(beside, own)| {
                    // Without strength no force has an effect.
                    let least = *own * (S::EPSILON * S::constant(SHARE));
                    *beside = if *own > S::zero() { shift + least } else { S::one() };
                });
            }
            let shifted = with_diagonal(&self.response, |i| beside.get(i).copied().unwrap_or(S::zero()));
            let factored = NewtonMatrix::factored(&shifted)?;
            let forces = factored.solve(&self.free);
            let slides = |element: &Element| {
                element.head(lambda.as_slice()) > Some(S::zero()) || element.length(&forces) > S::one()
            };
            limited = forces;
            for element in self.elements().filter(slides) {
                element.divide(&mut limited, element.length(&forces));
            }
            // d(1/|sₖ|)/dλₗ = sₖᵀ (A + λ)⁻¹ₖₗ sₗ/|sₖ|³: 1/|s| is nearly linear in λ.
            let (mut slopes, mut right): (SMatrix<S, M, M>, SVector<S, M>) =
                (SMatrix::identity(), nalgebra::zero());
            for other in self.elements().filter(slides) {
                other.write_head(right.as_mut_slice(), S::one() - S::one() / other.length(&forces));
                let answer = factored.solve(&other.part(&forces));
                for element in self.elements().filter(slides) {
                    let length = element.length(&forces);
                    let slope = element.dot(&forces, &answer) / (length * length * length);
                    if let Some(column) = slopes.data.0.get_mut(other.first) {
                        element.write_head(column, slope);
                    }
                }
            }
            lambda += NewtonMatrix::factored(&slopes)?.solve(&right);
            lambda.as_mut_slice().iter_mut().for_each(|lambda| *lambda = at_least(*lambda, S::zero()));
        }
        Some(limited)
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
