//! Newton's method from the sets that sweeps find.

use nalgebra::{SMatrix, SVector};

use super::super::element::Element;
use super::{Elements, Held, ROUNDINGS, SHARE};
use crate::numbers::{Factored, NewtonMatrix, Scalar};

/// Newton iterations from the sets of a sweep, each of which may change them.
const CORRECTIONS: u32 = 64;

/// Iterations after which they change one element at a time, the first that is wrong: all at once may cycle,
/// and one at a time cannot where elements have one component each (K. G. Murty, 1974).
const AT_ONCE: u32 = 8;

impl<S: Scalar, const M: usize> Elements<'_, S, M> {
    /// The solution by Newton's method on the sets of `forces`, which follow it: an element that would have
    /// to be held by more than its limit slides, one that would slide against its force sticks.
    #[inline(never)]
    pub(super) fn corrected(&self, mut forces: SVector<S, M>) -> Option<Held<S, M>> {
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
}
