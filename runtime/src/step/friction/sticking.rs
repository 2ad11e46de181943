//! Velocities at which elements that stick have no slip, to the last bit.

use nalgebra::SVector;

use super::set::Held;
use crate::numbers::Scalar;
use crate::step::massless::Massless;
use crate::system::Slips;

/// By how much larger coefficients count as the largest ones: a power of two, which rounds nothing.
const LARGER: f64 = 1024.0;

/// The velocity nearby at which elements that stick have no slip to the last bit: the slips that stick are
/// solved for as many velocities, those with the largest coefficients. The `slips` are those at rest, of what
/// moves by itself, a belt.
#[cold]
#[inline(never)]
pub(super) fn sticking<S: Scalar, const N: usize, const M: usize>(
    slips: &Slips<S, N, M>,
    v: &SVector<S, N>,
    held: &Held<S, M>,
) -> SVector<S, N> {
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

/// [`sticking`] by velocities of these coordinates, as far as they can: those of others are known to more
/// digits.
#[cold]
#[inline(never)]
pub(super) fn sticking_in<S: Scalar, const N: usize, const M: usize>(
    light: &Massless<N>,
    slips: &Slips<S, N, M>,
    v: &SVector<S, N>,
    held: &Held<S, M>,
) -> SVector<S, N> {
    let scaled = |v: &SVector<S, N>, by: f64| light.without(v) + light.rows(v) * S::constant(by);
    let by_velocity = &slips.by_velocity;
    let by_velocity = by_velocity + light.columns(by_velocity) * S::constant(LARGER - 1.0);
    let found = sticking(&Slips { by_velocity, ..*slips }, &scaled(v, 1.0 / LARGER), held);
    scaled(&found, LARGER)
}

fn largest_of<'a, S: Scalar>(entries: impl Iterator<Item = &'a S>) -> S {
    entries.fold(S::zero(), |most, entry| if entry.abs() > most { entry.abs() } else { most })
}
