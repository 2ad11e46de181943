//! The velocity at the end of a step, with friction in it, and velocities that stick exactly.

use nalgebra::SVector;

use super::equation::Sliding;
use super::set::Held;
use crate::numbers::{Factored, NewtonMatrix, Scalar};
use crate::step::massless::{Balance, Massless};
use crate::step::{StepError, require_regular};
use crate::system::{DryFriction, force_of_rayleigh};

/// Newton iterations for the velocity at the end: one where ∂L/∂v is linear in v.
const ITERATIONS: u32 = 32;

/// Roundings of the velocity below which a correction is the last.
const ROUNDINGS: f64 = 8.0;

/// The velocity at the end of a step with the friction in it.
pub(super) struct End<S, const N: usize, const M: usize> {
    /// v1.
    pub(super) v: SVector<S, N>,
    /// s, and what sticks.
    pub(super) forces: SVector<S, M>,
    pub(super) sticks: [bool; M],
    /// p1 = ∂L/∂v(q1, v1).
    pub(super) p: SVector<S, N>,
    /// Coordinates without mass, in which the other forces at the end balance friction there.
    pub(super) massless: Massless<N>,
}

/// v1 of w ∈ ∂L/∂v(q1, v1) + (h/2) ∂R_k(q̄, v1), from the velocity `start`: the system at the end of the step
/// with q1, and at its middle with q̄ and h.
///
/// # Errors
/// [`StepError::DegenerateLagrangian`], [`StepError::NotConverged`]; those of friction.
pub(super) fn velocity<L, S, const N: usize, const M: usize>(
    at_end: &L,
    q1: &SVector<S, N>,
    (at_middle, middle, h): (&L, &SVector<S, N>, S),
    w: &SVector<S, N>,
    start: &SVector<S, N>,
) -> Result<End<S, N, M>, StepError>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let (mut v, mut w, mut massless) = (*start, *w, Massless::none());
    let mut forces = nalgebra::zero();
    let mut left = w;
    for iteration in 0..ITERATIONS {
        let mut balance = balance(at_end, &massless, q1, &v, h);
        let mut factored = balance.by_v.factored();
        if factored.is_none() && !massless.are_any() {
            massless = Massless::of(at_end, q1);
            w = massless.without(&w);
            balance = self::balance(at_end, &massless, q1, &v, h);
            factored = balance.by_v.factored();
        }
        let Some(factored) = factored else {
            require_regular(&balance.by_v)?;
            break;
        };
        let slips = at_middle.slips(middle, &v);
        let sliding = Sliding::of(&slips, &v, (S::zero(), h), &factored)?;
        left = balance.value - w;
        let Some(held) = sliding.held(L::ELEMENTS, &factored, &left, &forces) else { break };
        forces = held.forces;
        let impulse = sliding.impulse(&forces);
        left += impulse;
        let correction = factored.solve(&left);
        v -= correction;
        // Beside what friction takes away of it.
        let is_near = || {
            let size = v.amax() + factored.solve(&w).amax();
            correction.amax() <= size * (S::EPSILON * S::constant(ROUNDINGS))
        };
        let is_linear = L::STRUCTURE.constant_mass_matrix && !massless.are_any();
        if is_linear || iteration > 0 && is_near() {
            let sticks = held.sticks;
            if sticks.contains(&true) {
                v = sticking(at_middle, middle, &v, &held);
                return Ok(End { v, forces, sticks, p: at_end.lagrangian_gradient(q1, &v).d2, massless });
            }
            return Ok(End { v, forces, sticks, p: massless.without(&(w - impulse)), massless });
        }
    }
    Err(StepError::NotConverged { iterations: ITERATIONS, residual: left.amax().widen(), floor: 0.0 })
}

/// The equations for v1 without the kinks: in coordinates without mass the impulses of half a step.
#[inline]
pub(super) fn balance<L, S, const N: usize, const M: usize>(
    at_end: &L,
    massless: &Massless<N>,
    q1: &SVector<S, N>,
    v: &SVector<S, N>,
    h: S,
) -> Balance<S, N>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    let l = at_end.lagrangian_derivatives(q1, v);
    massless.balance(
        &l,
        || {
            let smooth = force_of_rayleigh(&at_end.smooth_rayleigh_derivatives(q1, v));
            if L::HAS_FORCE { smooth + at_end.general_force_derivatives(q1, v) } else { smooth }
        },
        h * S::constant(0.5),
    )
}

/// The velocity nearby at which elements that stick have no slip to the last bit: the slips that stick are
/// solved for as many velocities, those with the largest coefficients.
#[cold]
#[inline(never)]
pub(super) fn sticking<L, S, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<S, N>,
    v: &SVector<S, N>,
    held: &Held<S, M>,
) -> SVector<S, N>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    // The slips are linear in v: at rest they are those of what moves by itself, a belt.
    let slips = system.slips(q, &nalgebra::zero());
    // Rows of ∂u/∂v beside −u, each over its largest coefficient.
    let mut rows = [([S::zero(); N], S::zero()); M];
    for (i, (row, right)) in rows.iter_mut().enumerate() {
        if held.sticks.get(i) != Some(&true) {
            continue;
        }
        let scale = largest_of(slips.by_velocity.data.0.iter().filter_map(|column| column.get(i)));
        if scale > S::zero() {
            for (entry, column) in row.iter_mut().zip(&slips.by_velocity.data.0) {
                *entry = column.get(i).copied().unwrap_or(S::zero()) / scale;
            }
            *right = (S::zero() - slips.values.get(i).copied().unwrap_or(S::zero())) / scale;
        }
    }
    let mut pivots = [None; M];
    for _ in 0..M {
        let mut best = None;
        // Redundant rows are left with rounding alone.
        let mut most = S::EPSILON.sqrt();
        for (i, (row, _)) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                let is_taken = pivots.iter().flatten().any(|pivot| *pivot == j);
                if pivots.get(i) == Some(&None) && !is_taken && entry.abs() > most {
                    (best, most) = (Some((i, j)), entry.abs());
                }
            }
        }
        let Some((i, j)) = best else { break };
        if let Some(pivot) = pivots.get_mut(i) {
            *pivot = Some(j);
        }
        let Some((row, right)) = rows.get_mut(i) else { break };
        let pivot = row.get(j).copied().unwrap_or(S::one());
        row.iter_mut().for_each(|entry| *entry /= pivot);
        *right /= pivot;
        let (row, right) = (*row, *right);
        for (_, (other, of_other)) in rows.iter_mut().enumerate().filter(|(other, _)| *other != i) {
            let factor = other.get(j).copied().unwrap_or(S::zero());
            other.iter_mut().zip(row).for_each(|(other, entry)| *other -= factor * entry);
            *of_other -= factor * right;
        }
    }
    let mut exact = *v;
    for ((row, right), pivot) in rows.iter().zip(pivots) {
        let Some(pivot) = pivot else { continue };
        // The columns of other pivots are 0.
        let others = row.iter().zip(v.as_slice()).enumerate().filter(|(j, _)| *j != pivot);
        let found = others.fold(*right, |sum, (_, (entry, v))| sum - *entry * *v);
        if let Some(entry) = exact.get_mut(pivot) {
            *entry = found;
        }
    }
    exact
}

fn largest_of<'a, S: Scalar>(entries: impl Iterator<Item = &'a S>) -> S {
    entries.fold(S::zero(), |most, entry| if entry.abs() > most { entry.abs() } else { most })
}
