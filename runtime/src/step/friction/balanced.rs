//! Places of coordinates that neither mass nor smooth friction holds: where friction bears the forces.
//!
//! ```text
//! F(q1) ∈ ∂R_k(q1, v) in Y,        q1 = q̄ + (h/2) v in Y,   v = v̄ elsewhere,   F = ∂L/∂q + f
//! ```
//!
//! **Derivation.** In the coordinates Y, whose velocity the kinks of R alone hold, friction bears all other
//! forces at every time: |F| ≤ μ for one coordinate with μ|v|. A step has this balance at its middle, and q1
//! beyond it would be off by what forces change in half a step, to one side and the other in turn for ever.
//! So the second half of the step has a line of its own in Y, with the balance at its end: the least of
//! V + R_k over the places that Y can move to, as the return to the yield surface of plasticity (J. C. Simo,
//! T. J. R. Hughes, Computational Inelasticity, 1998, ch. 1). A spring and a slider in series follow
//! their law to rounding as long as the stretch goes one way in each half step, also where a start or
//! an input has the force beyond its limit. p is 0 there before and after, and forces of the middle push what
//! has mass.

use nalgebra::{SMatrix, SVector};

use super::end::{End, forces, terms};
use super::root::{Line, root};
use super::set::Held;
use super::sticking::sticking_in;
use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::massless::Massless;
use crate::step::{Segment, StepError, require_regular};
use crate::system::{DryFriction, Slips};

/// By which h the impulse (h/2) F is the force F.
pub(super) const OF_FORCES: f64 = 2.0;

/// Places at which friction bears the forces.
pub(super) struct Balanced<S, const N: usize, const M: usize> {
    pub(super) q: SVector<S, N>,
    /// v.
    pub(super) v: SVector<S, N>,
    /// s, and what sticks.
    pub(super) held: Held<S, M>,
}

/// The places at the end of the step on a segment.
///
/// # Errors
/// Those of [`balanced`].
pub(super) fn at_end<L, S, const N: usize, const M: usize>(
    system: &L,
    segment: &Segment<S, N>,
    end: &End<S, N, M>,
) -> Result<Balanced<S, N, M>, StepError>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let (light, half) = (&end.light, segment.h * S::constant(0.5));
    let (middle, q1) = (segment.q0 + segment.v * half, segment.q0 + segment.v * segment.h);
    let from = light.without(&q1) + light.rows(&middle);
    let at = |system: &L| {
        let slips = |q: &SVector<S, N>, v: &SVector<S, N>| system.slips(q, v);
        balanced(system, light, (&from, half), (&segment.v, &end.v), slips)
    };
    system.later(segment.h, at)
}

/// The places q + `over` v in the coordinates `light`, from q and the velocities of others; forces of these
/// at the velocities v of others. The `slips` are those at (q, v).
///
/// # Errors
/// [`StepError::DegenerateLagrangian`] where no spring holds such a coordinate, [`StepError::NotConverged`];
/// those of friction.
#[cold]
#[inline(never)]
pub(super) fn balanced<L, S, const N: usize, const M: usize>(
    system: &L,
    light: &Massless<N>,
    (from, over): (&SVector<S, N>, S),
    (others, of_forces): (&SVector<S, N>, &SVector<S, N>),
    slips: impl Fn(&SVector<S, N>, &SVector<S, N>) -> Slips<S, N, M>,
) -> Result<Balanced<S, N, M>, StepError>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let (others, of_forces) = (light.without(others), light.without(of_forces));
    let place = |v: &SVector<S, N>| from + light.rows(v) * over;
    let in_light = |q: &SVector<S, N>, v: &SVector<S, N>| {
        let slips = slips(q, v);
        Slips { by_velocity: light.columns(&slips.by_velocity), ..slips }
    };
    let found = root(L::ELEMENTS, &others, S::constant(OF_FORCES), |v| {
        let q = place(v);
        let forces = forces(system, &q, &of_forces);
        let matrix = stiffness(light, &(forces.d1 * over));
        let Some(factored) = matrix.factored() else {
            require_regular(&matrix)?;
            return Ok(None);
        };
        let (left, beside) = (-light.rows(&forces.value), light.rows(&terms(&forces, &q)));
        Ok(Some(Line { left, factored, slips: in_light(&q, v), beside, is_linear: false }))
    })?;
    let (mut v, held) = (found.x, found.held);
    if held.sticks.contains(&true) {
        v = sticking_in(light, &in_light(&place(&v), &others), &v, &held);
    }
    Ok(Balanced { q: place(&v), v, held })
}

/// −∂F/∂q of the coordinates `light`, and 1 elsewhere.
pub(super) fn stiffness<S: Scalar, const N: usize>(
    light: &Massless<N>,
    by_q: &SMatrix<S, N, N>,
) -> SMatrix<S, N, N> {
    light.block(&-by_q)
}
