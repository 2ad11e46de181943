//! Elements of several components, whose forces lie in a ball: by the unknowns λ of their lengths.

use nalgebra::{SMatrix, SVector};

use super::super::element::Element;
use super::{Elements, SHARE, at_least, with_diagonal};
use crate::numbers::{Factored, NewtonMatrix, Scalar};

/// Iterations for the unknowns λ of several balls.
const OF_LENGTHS: u32 = 16;

/// Iterations for the one unknown λ of a ball.
const OF_BALL: u32 = 32;

impl<S: Scalar, const M: usize> Elements<'_, S, M> {
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
    pub(super) fn solve_ball(&self, forces: &mut SVector<S, M>, element: Element) {
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

    /// The forces near the solution by Newton's method for λ from that of `forces`: (A + λ) s = d, where sₖ
    /// of elements that slide is to have the length 1. λ of no element falls below 0, where it sticks.
    #[inline(never)]
    pub(super) fn by_lengths(&self, forces: &SVector<S, M>) -> Option<SVector<S, M>> {
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
