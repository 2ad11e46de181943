//! Slips with what a Newton matrix makes of friction forces.

use nalgebra::{SMatrix, SVector};

use super::set::{Elements, Held};
use crate::numbers::{Factored, Scalar};
use crate::step::StepError;
use crate::system::Slips;

/// Slips on a segment with what a Newton matrix W makes of friction forces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sliding<S, const N: usize, const M: usize> {
    /// u.
    values: SVector<S, M>,
    /// Sizes of its terms.
    terms: SVector<S, M>,
    /// ∂u/∂v̄ at fixed q0.
    rows: SMatrix<S, M, N>,
    /// (h/2) Fₖ ∂uₖ/∂v, column by column: what s adds to p0.
    directions: SMatrix<S, N, M>,
    /// The rows times W⁻¹ times the directions.
    response: SMatrix<S, M, M>,
}

impl<S: Scalar, const N: usize, const M: usize> Sliding<S, N, M> {
    /// Of these slips at `v` over a step of size `h`, where q is q0 + `share` v̄, with W `factored`.
    ///
    /// # Errors
    /// [`StepError::NegativeFriction`], [`StepError::NotConvex`].
    pub(super) fn of(
        slips: &Slips<S, N, M>,
        v: &SVector<S, N>,
        (share, h): (S, S),
        factored: &impl Factored<S, N>,
    ) -> Result<Self, StepError> {
        let directions = direction_of(slips, h)?;
        let rows = slips.by_velocity + slips.by_configuration * share;
        let response = rows * factored.solve_columns(&directions);
        let mut own = response.data.0.iter().enumerate().map(|(k, column)| column.get(k));
        if let Some(component) = own.position(|entry| entry.is_some_and(|entry| *entry < S::zero())) {
            return Err(StepError::NotConvex { component, h: h.widen(), enough: 0.0 });
        }
        let terms = slips.values.abs() + slips.by_velocity.abs() * v.abs();
        Ok(Self { values: slips.values, terms, rows, directions, response })
    }

    /// s, and what sticks, of what is `left` of the equation without friction.
    pub(super) fn held(
        &self,
        sizes: &[usize],
        factored: &impl Factored<S, N>,
        left: &SVector<S, N>,
        start: &SVector<S, M>,
    ) -> Option<Held<S, M>> {
        let correction = factored.solve(left);
        let free = self.values - self.rows * correction;
        let terms = self.terms + self.rows.abs() * correction.abs();
        let elements = Elements { sizes, response: self.response, free, terms };
        let mut held = elements.held(start)?;
        if M > 1 && held.sticks.contains(&true) {
            let remains = left + self.impulse(&held.forces);
            let slip = self.values - self.rows * factored.solve(&remains);
            // Of what sticks redundantly no more is known.
            if let Some(rest) = elements.rest(&held.sticks, &slip)
                && rest.dot(&rest) <= S::EPSILON
            {
                held.forces += rest;
            }
        }
        Some(held)
    }

    /// No number as what is left, where the slips or limits are none: no smaller step would help.
    #[cold]
    pub(super) fn unknown(&self) -> Option<SVector<S, N>> {
        let is_finite = self.response.iter().chain(&self.values).all(|entry| entry.is_finite());
        (!is_finite).then(|| SVector::repeat(S::constant(f64::NAN)))
    }

    /// The share of the friction forces s in p0.
    pub(super) fn impulse(&self, forces: &SVector<S, M>) -> SVector<S, N> {
        self.directions * forces
    }
}

/// (h/2) Fₖ ∂uₖ/∂v, column by column.
///
/// # Errors
/// [`StepError::NegativeFriction`].
pub(super) fn direction_of<S: Scalar, const N: usize, const M: usize>(
    slips: &Slips<S, N, M>,
    h: S,
) -> Result<SMatrix<S, N, M>, StepError> {
    let impulse = h * S::constant(0.5);
    let mut directions = slips.by_velocity.transpose();
    let limits = slips.limits.as_slice().iter();
    for (component, (column, limit)) in directions.data.0.iter_mut().zip(limits).enumerate() {
        if *limit < S::zero() {
            return Err(StepError::NegativeFriction { component, limit: limit.widen() });
        }
        column.iter_mut().for_each(|entry| *entry *= *limit * impulse);
    }
    Ok(directions)
}
