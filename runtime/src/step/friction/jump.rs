//! Jumps of coordinates that neither mass nor smooth friction holds.
//!
//! ```text
//! (∂L/∂q + f)(q + δ, v) ∈ ∂R_k(q + δ, δ)        in the coordinates Y whose velocity the kinks of R alone hold, δ in Y
//! ```
//!
//! **Derivation.** In Y friction bears all other forces at every time: |F| ≤ μ for one coordinate with
//! μ|v|. Between steps they may come to be more: an input jumps, a start is far off, and a step, which has
//! the balance at its middle, goes beyond by what they change in half of it. With a little smooth friction
//! ε ∂R/∂v the coordinates would move there within a time of order ε, along which all others stand still:
//! for ε → 0 at once, to where friction bears the forces. That is the least of V(q + δ) + R_k(q, δ), the
//! return to the yield surface of plasticity (J. C. Simo, T. J. R. Hughes, Computational Inelasticity, 1998,
//! ch. 1). Where friction bears the forces δ is 0, to the last bit.
//!
//! A step jumps at its end, and at its start where that is not one's end. A spring and a slider in series so
//! follow their law to rounding as long as the stretch goes one way.

use nalgebra::{SMatrix, SVector};

use super::end::{forces, terms};
use super::root::{Line, root};
use super::set::Held;
use super::sticking::sticking;
use crate::numbers::{Factored, NewtonMatrix, Scalar};
use crate::step::massless::Massless;
use crate::step::{StepError, require_regular};
use crate::system::{DryFriction, Slips};

/// Roundings of a place below which a jump at the start of a step is none.
const ROUNDINGS: f64 = 64.0;

/// By which h the impulse (h/2) F is the force F.
pub(super) const OF_FORCES: f64 = 2.0;

/// A jump.
pub(super) struct Jump<S, const N: usize, const M: usize> {
    /// The place after it.
    pub(super) q: SVector<S, N>,
    /// δ.
    pub(super) by: SVector<S, N>,
    /// s, and what sticks, of elements that touch Y.
    pub(super) held: Held<S, M>,
}

impl<S: Scalar, const N: usize, const M: usize> Jump<S, N, M> {
    /// From (q, v) in the coordinates `light`.
    ///
    /// # Errors
    /// [`StepError::DegenerateLagrangian`] where no spring holds such a coordinate,
    /// [`StepError::NotConverged`]; those of friction.
    #[cold]
    #[inline(never)]
    pub(super) fn of<L>(
        system: &L,
        light: &Massless<N>,
        q: &SVector<S, N>,
        v: &SVector<S, N>,
    ) -> Result<Self, StepError>
    where
        L: DryFriction<N, M, Scalar = S>,
    {
        let found = root(L::ELEMENTS, &nalgebra::zero(), S::constant(OF_FORCES), |by| {
            let forces = forces(system, &(q + by), v);
            let matrix = stiffness(light, &forces.d1);
            let Some(factored) = matrix.factored() else {
                require_regular(&matrix)?;
                return Ok(None);
            };
            let left = -light.rows(&forces.value);
            let slips = slips_of(system, light, &(q + by), by);
            let beside = light.rows(&terms(&forces, q));
            Ok(Some(Line { left, factored, slips, beside, is_linear: false }))
        })?;
        let mut by = found.x;
        if found.held.sticks.contains(&true) {
            let at_rest = slips_of(system, light, &(q + by), &nalgebra::zero());
            by = sticking(&at_rest, &by, &found.held);
        }
        Ok(Self { q: q + by, by, held: found.held })
    }

    /// Whether it is by more than roundings of places and forces explain.
    pub(super) fn is_one<L>(&self, system: &L, light: &Massless<N>, v: &SVector<S, N>) -> bool
    where
        L: DryFriction<N, M, Scalar = S>,
    {
        let forces = forces(system, &self.q, v);
        let sizes = light.rows(&terms(&forces, &self.q));
        let size = stiffness(light, &forces.d1).factored().map(|factored| factored.solve(&sizes).amax());
        let size = self.q.amax() + size.unwrap_or(S::zero());
        self.by.amax() > size * (S::EPSILON * S::constant(ROUNDINGS))
    }
}

/// −∂F/∂q of the coordinates `light`, and 1 elsewhere.
pub(super) fn stiffness<S: Scalar, const N: usize>(
    light: &Massless<N>,
    by_q: &SMatrix<S, N, N>,
) -> SMatrix<S, N, N> {
    light.block(&-by_q)
}

/// The slips of a motion in the coordinates `light` alone, at once: belts move by nothing meanwhile.
pub(super) fn slips_of<L, S, const N: usize, const M: usize>(
    system: &L,
    light: &Massless<N>,
    q: &SVector<S, N>,
    by: &SVector<S, N>,
) -> Slips<S, N, M>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let slips = system.slips(q, by);
    let by_velocity = light.columns(&slips.by_velocity);
    Slips { values: by_velocity * by, by_velocity, ..slips }
}
