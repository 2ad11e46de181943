//! The change of a vector field's momentum map over a segment, split into its causes at the stages.

use super::segment::SolvedSegment;
use crate::numbers::{Scalar, lanes::lane};
use crate::step::{Defect, DiscreteObjects, Pairing, StepError};
use crate::system::{ForcedLagrangian, VectorField};

/// h Σ bᵢ ξ(L), h Σ bᵢ f_L·ξ, and what J⁺ − J⁻ has besides; with the sizes of their terms.
pub(super) fn at_the_stages<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    segment: &SolvedSegment<'_, L, N, S>,
    xi: &dyn VectorField<N, Scalar = T>,
) -> Result<(Defect<T>, Defect<T>), StepError> {
    let variations = segment.variations()?;
    let (xi0, xi1) = (xi.vector(&segment.segment().q0), xi.vector(&segment.segment().end()));
    let force = segment.force(&variations);
    let ends = Pairing::zero()
        .and(&segment.slope(&variations.minus), &xi0)
        .and(&segment.slope(&variations.plus), &xi1)
        .and(&force.minus, &xi0)
        .and(&force.plus, &xi1);
    let q = segment.problem.configurations(&segment.v);
    let (mut of_lagrangian, mut of_force) = (Pairing::zero(), Pairing::zero());
    for i in 0..S {
        let (q, v) = (lane(&q, i), lane(&segment.v, i));
        let (local, weight) = (&segment.locals[i], segment.problem.steps[i]);
        let (along, change) = (xi.vector(&q), xi.jacobian(&q) * v);
        let of = Pairing::zero().and(&local.slope, &along).and(&local.momentum, &change);
        of_lagrangian = of_lagrangian.plus(of, weight);
        of_force = of_force.plus(Pairing::zero().and(&local.force, &along), weight);
    }
    let interior = ends.value - (of_lagrangian.value + of_force.value);
    Ok((
        Defect { lagrangian: of_lagrangian.value, force: of_force.value, interior },
        Defect { lagrangian: of_lagrangian.size, force: of_force.size, interior: ends.size },
    ))
}

/// ι_ξ df_L with the lift (ξ, Dξ V) at every stage:
///
/// ```text
/// Σⱼ (∂fᵢ/∂qⱼ − ∂fⱼ/∂qᵢ) ξⱼ + Σⱼ ∂fᵢ/∂vⱼ (Dξ V)ⱼ        −Σⱼ ∂fⱼ/∂vᵢ ξⱼ
/// ```
pub(super) fn force_contraction<
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
    const N: usize,
    const S: usize,
>(
    segment: &SolvedSegment<'_, L, N, S>,
    xi: &dyn VectorField<N, Scalar = T>,
    component: &mut dyn FnMut(T, T),
) {
    let q = segment.problem.configurations(&segment.v);
    for i in 0..S {
        let (q, v) = (lane(&q, i), lane(&segment.v, i));
        let elapsed = segment.problem.elapsed(i);
        let f = segment.problem.system.later(elapsed, |system| system.acting_force_derivatives(&q, &v));
        let (along, change) = (xi.vector(&q), xi.jacobian(&q) * v);
        for a in 0..N {
            let mut by_q = (T::zero(), T::zero());
            let mut by_v = (T::zero(), T::zero());
            for b in 0..N {
                let (turned, bent) = (f.d1[(a, b)] - f.d1[(b, a)], f.d2[(a, b)]);
                by_q.0 += turned * along[b] + bent * change[b];
                by_q.1 +=
                    (f.d1[(a, b)].abs() + f.d1[(b, a)].abs()) * along[b].abs() + bent.abs() * change[b].abs();
                by_v.0 -= f.d2[(b, a)] * along[b];
                by_v.1 += (f.d2[(b, a)] * along[b]).abs();
            }
            component(by_q.0, by_q.1);
            component(by_v.0, by_v.1);
        }
    }
}
