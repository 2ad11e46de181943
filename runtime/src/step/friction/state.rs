//! Friction at given slips, and how its forces turn with them.

use nalgebra::{SMatrix, SVector};

use super::element::elements;
use crate::numbers::Scalar;
use crate::step::StepError;

/// Roundings below which a slip is 0, beside those of its terms.
const ROUNDINGS: f64 = 64.0;

/// How near to its limit a friction force is at its edge.
const EDGE: f64 = 1e-9;

/// s and what sticks at the slips of a step, and Σ D ∂s/∂u where a length slides.
pub(super) struct State<S, const N: usize, const M: usize> {
    pub(super) forces: SVector<S, M>,
    pub(super) sticks: [bool; M],
    pub(super) turning: SMatrix<S, N, M>,
}

impl<S: Scalar, const N: usize, const M: usize> State<S, N, M> {
    pub(super) fn of(
        sizes: &[usize],
        slips: &SVector<S, M>,
        directions: &SMatrix<S, N, M>,
        terms: &SVector<S, M>,
    ) -> Self {
        let mut state = Self { forces: nalgebra::zero(), sticks: [false; M], turning: nalgebra::zero() };
        for element in elements(sizes) {
            let length = element.length(slips);
            if length <= element.length(terms) * (S::EPSILON * S::constant(ROUNDINGS)) {
                element.of_mut(&mut state.sticks).for_each(|stick| *stick = true);
                continue;
            }
            let s = element.part(slips) / length;
            state.forces += s;
            if element.size > 1 {
                let along = directions * s;
                let own = element.of(&directions.data.0).zip(element.of(s.as_slice()));
                for (column, (direction, s)) in element.of_mut(&mut state.turning.data.0).zip(own) {
                    let entries = column.iter_mut().zip(direction).zip(along.as_slice());
                    entries
                        .for_each(|((entry, direction), along)| *entry = (*direction - *along * *s) / length);
                }
            }
        }
        state
    }

    /// Fails where a friction force that holds is at its limit.
    pub(super) fn require_off_edge(&self, sizes: &[usize]) -> Result<(), StepError> {
        for element in elements(sizes) {
            let is_stuck = element.head(&self.sticks) == Some(true);
            if is_stuck && element.length(&self.forces) > S::one() - S::constant(EDGE) {
                return Err(StepError::AtLimitOfFriction { component: element.first });
            }
        }
        Ok(())
    }
}
