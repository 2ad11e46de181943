//! The sets that hold by continuation: where sweeps and Newton's method leave them open.

use super::{Elements, Held, at_least, with_diagonal};
use crate::numbers::Scalar;

/// The least part of ρ that is left from one problem to the next.
const CONTINUATION: f64 = 0.25;

/// The most problems on the way to ρ = 0.
const PROBLEMS: u32 = 256;

impl<S: Scalar, const M: usize> Elements<'_, S, M> {
    /// From elements that give way to each force by itself, ρ s beside A s, to none that do: at first each
    /// stands alone, and the forces change little from ρ to ρ. Where they change too much, ρ falls by less.
    pub(super) fn by_continuation(&self) -> Option<Held<S, M>> {
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
}
