//! Whether rounding explains what is left of the stages' residuals: for every solver of their equations.

use core::array;

use nalgebra::SVector;

use super::linearised::locals;
use super::problem::{Problem, in_units_of};
use crate::numbers::{
    CancellingTerms, LaneVector, Lanes, Scalar,
    lanes::{lane, splat},
};
use crate::step::newton::{AT_FLOOR, PLACES, add_finite_part, is_sensible};
use crate::system::ForcedLagrangian;

/// The residual that is largest in units of its floor, and this floor.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn worst<T: Scalar, const N: usize, const S: usize>(
    residual: &LaneVector<T, N, S>,
    floor: &SVector<T, N>,
) -> (T, T) {
    let mut worst = (residual[0].amax(), floor[0]);
    for a in 1..N {
        let other = (residual[a].amax(), floor[a]);
        if other.0 * worst.1 > worst.0 * other.1 {
            worst = other;
        }
    }
    worst
}

/// The floor with the rounding of cancelling forces, if that explains a residual that no longer falls.
#[cold]
#[inline(never)]
pub(super) fn at_rounding<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &LaneVector<T, N, S>,
    residual: &LaneVector<T, N, S>,
    floor: SVector<T, N>,
) -> Option<SVector<T, N>> {
    // Far above what any sensible floor explains, none is measured.
    let least = SVector::from_fn(|a, _| residual[a].amax() * T::constant(1.0 / AT_FLOOR));
    if !is_decided(problem, v, &least) {
        return None;
    }
    let measured = floor + rounding(problem, v) + cancelling(problem, v);
    let is_explained = in_units_of(residual, &measured) <= T::constant(AT_FLOOR);
    (is_explained && is_decided(problem, v, &measured)).then_some(measured)
}

/// The rounding of terms that cancel in ∂L/∂v and G at the stages, as far as they are written out.
#[cold]
#[inline(never)]
fn cancelling<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &LaneVector<T, N, S>,
) -> SVector<T, N> {
    let q = problem.configurations(v);
    let at_stages: [CancellingTerms<T, N>; S] = array::from_fn(|i| {
        let (q, v) = (lane(&q, i), lane(v, i));
        problem.system.later(problem.elapsed(i), |system| system.cancelling_terms(&q, &v))
    });
    let mut largest = SVector::<T, N>::zeros();
    for CancellingTerms { momentum, rate } in &at_stages {
        for a in 0..N {
            let size = (momentum[a] + rate[a] * problem.h.abs()) * T::EPSILON;
            // What is no number says nothing.
            if size > largest[a] && size.is_finite() {
                largest[a] = size;
            }
        }
    }
    largest
}

/// Whether the `floor` at the stages is small beside what their equations are made of: |p0| + |h| max |G|
/// there and at rest, terms that cancel, forces at rest that do, and friction in coordinates without mass.
#[cold]
#[inline(never)]
pub(super) fn is_decided<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &LaneVector<T, N, S>,
    floor: &SVector<T, N>,
) -> bool {
    let mut terms = SVector::<T, N>::zeros();
    let is_decided = |terms: &SVector<T, N>| is_sensible(floor.as_slice(), terms.as_slice());
    let mut add = |of: &[T], factor: T| {
        add_finite_part(terms.as_mut_slice(), factor, of);
        is_decided(&terms)
    };
    if add(problem.p0.value.as_slice(), T::one()) {
        return true;
    }
    let rest = splat(&SVector::zeros());
    let size = |v: &LaneVector<T, N, S>| -> [T; N] {
        let stages = problem.stages(v);
        problem.momenta(&stages.rate).map(|stages| stages.amax())
    };
    add(&size(&rest), T::one());
    add(&size(v), T::one())
        || add(cancelling(problem, v).as_slice(), T::one() / T::EPSILON)
        || add(rounding(problem, &rest).as_slice(), T::one() / T::EPSILON)
        || add(friction(problem, v).as_slice(), T::one())
}

/// |h| Σ |∂G/∂v||V| at the stages in coordinates without mass, whose G is 0: what its terms are, of which no
/// momentum tells.
#[cold]
#[inline(never)]
fn friction<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &LaneVector<T, N, S>,
) -> SVector<T, N> {
    let mut largest = SVector::<T, N>::zeros();
    for (i, local) in locals(problem, v).iter().enumerate() {
        let terms = local.rate_by_v.abs() * (lane(v, i).abs() * problem.h.abs());
        for a in 0..N {
            if local.mass.row(a).iter().all(|entry| *entry == T::zero()) && terms[a] > largest[a] {
                largest[a] = terms[a];
            }
        }
    }
    largest
}

/// The rounding of the residuals at the stages, measured: each coordinate of Q is moved by [`PLACES`] last
/// places of its terms, each of V by as many of its own, and the changes are added up. One place may vanish
/// inside a function. Near an equilibrium, where large forces cancel, the sum exceeds [`Problem::floor`].
#[cold]
#[inline(never)]
fn rounding<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &LaneVector<T, N, S>,
) -> SVector<T, N> {
    let q = problem.configurations(v);
    let residual = |q: &LaneVector<T, N, S>, v: &LaneVector<T, N, S>| problem.stages_at(q, v).residual;
    let value = residual(&q, v);
    let mut largest: SVector<T, N> = nalgebra::zero();
    let places = T::constant(PLACES);
    let unit = T::EPSILON * places;
    // All stages alike, then the halves of the step apart: a force that changes sign within it must not
    // cancel. The larger counts.
    for opposed in [unit, -unit] {
        let mut sum: SVector<T, N> = nalgebra::zero();
        let mut add = |q: &LaneVector<T, N, S>, v: &LaneVector<T, N, S>| {
            let moved = residual(q, v);
            for a in 0..N {
                sum[a] += (moved[a] - value[a]).amax();
            }
        };
        let unit = Lanes::<T, S>(array::from_fn(|i| if 2 * i < S { unit } else { opposed }));
        for a in 0..N {
            let speed = v[a].amax();
            // Q is a sum: its rounding is that of its terms, however small it is itself.
            let size = problem.q0.value[a].abs() + (problem.h * speed).abs();
            let mut moved = q;
            moved[a] = moved[a] + unit * size;
            add(&moved, v);
            let mut moved = *v;
            moved[a] = moved[a] + unit * v[a].abs();
            add(&q, &moved);
        }
        largest = largest.sup(&sum);
    }
    largest / places
}
