//! The velocity at the end of a step, with friction in it.
//!
//! A coordinate without mass takes p1 = 0, and its line is a balance of forces. Where R_s or f holds its
//! velocity, that of the forces at the end; where the kinks alone do, in coordinates Y, that of the forces
//! which friction bears at the middle, were v1 the velocity there:
//!
//! ```text
//! (h/2) (∂L/∂q + f)(q, v̄) ∈ (h/2) ∂R_k(q̄, v1) in Y,        q = q̄, and q0 + (h/2) v1 in Y
//! ```
//!
//! At v1 = v̄ it is the first line, so that what slid slides on and what held holds. Its matrix is that of
//! the first line, which a spring makes regular.

use nalgebra::{SMatrix, SVector};

use super::root::{Line, root};
use super::set::Held;
use super::sticking::{sticking, sticking_in};
use crate::numbers::{CovectorDerivatives, NewtonMatrix, Scalar};
use crate::step::massless::{Balance, Massless};
use crate::step::{StepError, require_regular};
use crate::system::{DryFriction, derivatives_apart, force_of_rayleigh};

/// The velocity at the end of a step with the friction in it.
pub(super) struct End<S, const N: usize, const M: usize> {
    /// v1; in coordinates that the kinks alone hold, as their line has it.
    pub(super) v: SVector<S, N>,
    /// s, and what sticks.
    pub(super) held: Held<S, M>,
    /// p1 = ∂L/∂v(q1, v1).
    pub(super) p: SVector<S, N>,
    /// Coordinates without mass, and those of them that the kinks alone hold.
    pub(super) massless: Massless<N>,
    pub(super) light: Massless<N>,
}

/// The middle of a step of size h: the system there, q̄ and v̄.
pub(super) struct Middle<'a, L, S, const N: usize> {
    pub(super) system: &'a L,
    pub(super) h: S,
    pub(super) q: SVector<S, N>,
    pub(super) v: SVector<S, N>,
}

/// v1 of w ∈ ∂L/∂v(q1, v1) + (h/2) ∂R_k(q̄, v1): the system at the end of the step with q1.
///
/// # Errors
/// [`StepError::DegenerateLagrangian`], [`StepError::NotConverged`]; those of friction.
pub(super) fn velocity<L, S, const N: usize, const M: usize>(
    at_end: &L,
    q1: &SVector<S, N>,
    middle: &Middle<'_, L, S, N>,
    w: &SVector<S, N>,
) -> Result<End<S, N, M>, StepError>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let (mut massless, mut light, mut w) = (Massless::none(), Massless::none(), *w);
    let found = root(L::ELEMENTS, &middle.v, middle.h, |v| {
        let mut line = balance(at_end, (&massless, &light), q1, v, middle);
        let mut factored = line.by_v.factored();
        if factored.is_none() && !massless.are_any() {
            massless = Massless::of(at_end, q1);
            w = massless.without(&w);
            line = balance(at_end, (&massless, &light), q1, v, middle);
            factored = line.by_v.factored();
            if factored.is_none() && massless.are_any() {
                light = light_among(&massless, at_end, q1);
                line = balance(at_end, (&massless, &light), q1, v, middle);
                factored = line.by_v.factored();
            }
        }
        let Some(factored) = factored else {
            require_regular(&line.by_v)?;
            return Ok(None);
        };
        let is_linear = L::STRUCTURE.constant_mass_matrix && !massless.are_any();
        let slips = middle.system.slips(&middle.q, v);
        let mut beside = w;
        if light.are_any() {
            let at = at_middle(&light, v, middle);
            beside += light.rows(&terms(&at, &middle.q)) * (middle.h * S::constant(0.5));
        }
        Ok(Some(Line { left: line.value - w, factored, slips, beside, is_linear }))
    })?;
    let (v, held) = (found.x, found.held);
    if !held.sticks.contains(&true) {
        return Ok(End { v, held, p: massless.without(&(w - found.impulse)), massless, light });
    }
    let slips = middle.system.slips(&middle.q, &nalgebra::zero());
    let v = match light.are_any() {
        true => sticking_in(&light, &slips, &v, &held),
        false => sticking(&slips, &v, &held),
    };
    Ok(End { v, held, p: at_end.lagrangian_gradient(q1, &v).d2, massless, light })
}

/// The equations for v1 without the kinks: in coordinates without mass the impulses of half a step.
#[inline]
pub(super) fn balance<L, S, const N: usize, const M: usize>(
    at_end: &L,
    (massless, light): (&Massless<N>, &Massless<N>),
    q1: &SVector<S, N>,
    v: &SVector<S, N>,
    middle: &Middle<'_, L, S, N>,
) -> Balance<S, N>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let l = at_end.lagrangian_derivatives(q1, v);
    let half = middle.h * S::constant(0.5);
    let mut balance = massless.balance(&l, || smooth_force(at_end, q1, v), half);
    if light.are_any() {
        let forces = at_middle(light, v, middle);
        balance.value = light.without(&balance.value) - light.rows(&forces.value) * half;
        let springs = light.rows(&light.columns(&forces.d1)) * (half * half * S::EPSILON.sqrt());
        balance.by_v = light.without(&balance.by_v) - springs;
        balance.by_q = light.without(&balance.by_q);
    }
    balance
}

/// The forces at the middle, at q̄ + (h/2)(v1 − v̄) in the coordinates that the kinks alone hold.
#[cold]
#[inline(never)]
pub(super) fn at_middle<L, S, const N: usize, const M: usize>(
    light: &Massless<N>,
    v: &SVector<S, N>,
    middle: &Middle<'_, L, S, N>,
) -> CovectorDerivatives<S, N>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let moved = light.rows(&(v - middle.v)) * (middle.h * S::constant(0.5) * S::EPSILON.sqrt());
    forces(middle.system, &(middle.q + moved), &middle.v)
}

/// The derivatives by q0 and q1 of the line for v1 in coordinates that the kinks alone hold.
#[cold]
#[inline(never)]
pub(super) fn by_ends<L, S, const N: usize, const M: usize>(
    light: &Massless<N>,
    v: &SVector<S, N>,
    middle: &Middle<'_, L, S, N>,
) -> [SMatrix<S, N, N>; 2]
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let half = S::constant(0.5);
    let forces = at_middle(light, v, middle);
    let (own, of_middle) = (light.columns(&forces.d1) * S::EPSILON.sqrt(), forces.d1);
    let of_velocity = forces.d2 / middle.h;
    let line = |by: SMatrix<S, N, N>| -light.rows(&by) * (middle.h * half);
    [line((of_middle + own) * half - of_velocity), line((of_middle - own) * half + of_velocity)]
}

/// Sizes of the terms of forces at q, as far as these and q tell.
pub(super) fn terms<S: Scalar, const N: usize>(
    forces: &CovectorDerivatives<S, N>,
    q: &SVector<S, N>,
) -> SVector<S, N> {
    forces.value.abs() + forces.d1.abs() * q.abs()
}

/// Coordinates without mass that the kinks alone hold.
pub(super) fn light_among<L, S, const N: usize, const M: usize>(
    massless: &Massless<N>,
    system: &L,
    q: &SVector<S, N>,
) -> Massless<N>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    massless.held_by_kinks(q, |q, v| smooth_force(system, q, v))
}

/// −∂R_s/∂v + f.
fn smooth_force<L, S, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<S, N>,
    v: &SVector<S, N>,
) -> CovectorDerivatives<S, N>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let smooth = force_of_rayleigh(&system.smooth_rayleigh_derivatives(q, v));
    if L::HAS_FORCE { smooth + system.general_force_derivatives(q, v) } else { smooth }
}

/// ∂L/∂q − ∂R_s/∂v + f.
#[cold]
#[inline(never)]
pub(super) fn forces<L, S, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<S, N>,
    v: &SVector<S, N>,
) -> CovectorDerivatives<S, N>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let l = derivatives_apart(system, q, v);
    smooth_force(system, q, v) + CovectorDerivatives { value: l.d1, d1: l.d11, d2: l.d12 }
}
