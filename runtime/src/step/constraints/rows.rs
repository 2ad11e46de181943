//! The constraints of a step: g(q1) = 0, and ψ(q̄, v̄) = 0 at the middle for constraints of velocity.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::step::Segment;
use crate::system::{Constrained, ConstrainedParameters, sizes};

/// Roundings of the terms of a constraint below which its value counts as 0.
const ROUNDINGS: f64 = 4.0;

/// M constraints on a segment: c = g(q1)/h or ψ(q̄, v̄).
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<S, const N: usize, const M: usize> {
    /// c, 0 where rounding explains it.
    pub(super) values: SVector<S, M>,
    /// ∂c/∂v̄ at fixed q0: G(q1), or A(q̄) + (h/2) ∂ψ/∂q.
    pub(super) gradients: SMatrix<S, M, N>,
}

/// `rows` with `of_velocity` in place of its last ones.
pub(super) fn with_last<S: Scalar, const M: usize, const K: usize>(
    mut rows: SMatrix<S, M, K>,
    of_velocity: &SMatrix<S, M, K>,
    count: usize,
) -> SMatrix<S, M, K> {
    for (column, last) in rows.data.0.iter_mut().zip(&of_velocity.data.0) {
        let entries = column.iter_mut().zip(last).skip(M - count.min(M));
        entries.for_each(|(entry, last)| *entry = *last);
    }
    rows
}

/// q̄ = q0 + (h/2) v̄.
fn middle<S: Scalar, const N: usize>(segment: &Segment<S, N>) -> SVector<S, N> {
    segment.q0 + segment.v * half(segment)
}

fn half<S: Scalar, const N: usize>(segment: &Segment<S, N>) -> S {
    segment.h * S::constant(0.5)
}

/// ψ, A + (h/2) ∂ψ/∂q and (h/2) ∂ψ/∂q − A.
#[expect(clippy::type_complexity, reason = "three values that belong together here alone")]
fn at_middle<L: Constrained<N, M>, const N: usize, const M: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
) -> (SVector<L::Scalar, M>, SMatrix<L::Scalar, M, N>, SMatrix<L::Scalar, M, N>) {
    let half = half(segment);
    system.later(half, |system| {
        let q = middle(segment);
        let ((values, by_q), (_, by_v)) =
            (system.constraint_rates(&q, &segment.v), system.constraint_gradients(&q));
        (values, by_v + by_q * half, by_q * half - by_v)
    })
}

impl<S: Scalar, const N: usize, const M: usize> Rows<S, N, M> {
    pub(super) fn on<L: Constrained<N, M, Scalar = S>>(system: &L, segment: &Segment<S, N>) -> Self {
        let Segment { q0, v, h } = *segment;
        let mut rows = if L::OF_VELOCITY < M {
            system.later(h, |system| {
                let (values, gradients) = system.constraint_gradients(&segment.end());
                let terms = sizes(&gradients, &(q0.abs() + (v * h).abs()));
                Self { values: beyond_rounding(values, &terms) / h, gradients }
            })
        } else {
            Self { values: nalgebra::zero(), gradients: nalgebra::zero() }
        };
        if L::OF_VELOCITY > 0 {
            let (values, gradients, _) = at_middle(system, segment);
            let values = beyond_rounding(values, &sizes(&gradients, &v));
            rows.values = with_last(rows.values, &values, L::OF_VELOCITY);
            rows.gradients = with_last(rows.gradients, &gradients, L::OF_VELOCITY);
        }
        rows
    }

    /// Fails where the end of the segment is off a holonomic constraint by more roundings than `most`, with
    /// the first one and its value.
    pub(super) fn far_off<L>(system: &L, segment: &Segment<S, N>, most: f64) -> Result<(), (usize, S)>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        system.later(segment.h, |system| {
            let end = segment.end();
            let (values, gradients) = system.constraint_gradients(&end);
            let terms = sizes(&gradients, &(segment.q0.abs() + (segment.v * segment.h).abs()));
            let most = (terms + system.constraint_rounding(&end)) * (S::EPSILON * S::constant(most));
            let holonomic = values.as_slice().iter().zip(most.as_slice()).take(M - L::OF_VELOCITY.min(M));
            let mut found = holonomic.enumerate();
            // One without a value is named where the momentum is asked for.
            let first = found.find(|(_, (value, most))| value.abs() > **most);
            first.map_or(Ok(()), |(k, (value, _))| Err((k, *value)))
        })
    }

    /// Whether more is left of a constraint on another segment, near that of these rows, than its rounding.
    pub(super) fn is_off_on<L>(&self, system: &L, segment: &Segment<S, N>) -> bool
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let left = self.values(system, segment);
        is_left(&left) && !is_explained(system, segment, &left)
    }

    /// Whether more than rounding is left of a constraint.
    pub(super) fn is_off(&self) -> bool {
        is_left(&self.values)
    }

    /// c on another segment, near that of these rows.
    pub(super) fn values<L>(&self, system: &L, segment: &Segment<S, N>) -> SVector<S, M>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let Segment { q0, v, h } = *segment;
        let mut rows: SVector<S, M> = nalgebra::zero();
        if L::OF_VELOCITY < M {
            let values = system.later(h, |system| system.constraints(&segment.end()));
            rows = beyond_rounding(values, &sizes(&self.gradients, &(q0.abs() + (v * h).abs()))) / h;
        }
        if L::OF_VELOCITY > 0 {
            let values =
                system.later(half(segment), |system| system.velocity_constraints(&middle(segment), &v));
            let values = beyond_rounding(values, &sizes(&self.gradients, &v));
            rows = with_last(rows, &values, L::OF_VELOCITY);
        }
        rows
    }

    /// ∂c/∂q0 and ∂c/∂q1 of h·c.
    pub(super) fn at_ends<L>(system: &L, segment: &Segment<S, N>) -> [SMatrix<S, M, N>; 2]
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let rows = Self::on(system, segment).gradients;
        if L::OF_VELOCITY == 0 {
            return [nalgebra::zero(), rows];
        }
        let (_, _, by_start) = at_middle(system, segment);
        [with_last(nalgebra::zero(), &by_start, L::OF_VELOCITY), rows]
    }

    /// The derivatives of h·c by parameters, where those of g(q1) are `by`.
    pub(super) fn by_parameters<L, const P: usize>(
        system: &L,
        segment: &Segment<S, N>,
        by: SMatrix<S, M, P>,
    ) -> SMatrix<S, M, P>
    where
        L: ConstrainedParameters<N, M, P, Scalar = S>,
    {
        if L::OF_VELOCITY == 0 {
            return by;
        }
        let rates = system.later(half(segment), |system| {
            system.constraints_by_parameters(&middle(segment), &segment.v, &nalgebra::zero()).rates
        });
        with_last(by, &(rates * segment.h), L::OF_VELOCITY)
    }
}

/// Whether the rounding of g itself explains what is `left` of the constraints: near the origin of q the
/// terms of g are larger than q tells.
#[cold]
#[inline(never)]
fn is_explained<S: Scalar, L, const N: usize, const M: usize>(
    system: &L,
    segment: &Segment<S, N>,
    left: &SVector<S, M>,
) -> bool
where
    L: Constrained<N, M, Scalar = S>,
{
    let end = segment.end();
    let (values, rounding) =
        system.later(segment.h, |system| (system.constraints(&end), system.constraint_rounding(&end)));
    let holonomic = M - L::OF_VELOCITY.min(M);
    let is_held = |(value, rounding): (&S, &S)| rounding.is_finite() && value.abs() <= *rounding * S::EPSILON;
    let mut rows = values.as_slice().iter().zip(rounding.as_slice()).take(holonomic);
    let mut of_velocity = left.as_slice().iter().skip(holonomic);
    of_velocity.all(|left| *left == S::zero()) && rows.all(is_held)
}

/// Whether one of the values is more than rounding.
fn is_left<S: Scalar, const M: usize>(values: &SVector<S, M>) -> bool {
    values.as_slice().iter().any(|value| *value != S::zero())
}

/// The values, 0 where rounding of terms of these sizes explains one.
fn beyond_rounding<S: Scalar, const M: usize>(
    mut values: SVector<S, M>,
    sizes: &SVector<S, M>,
) -> SVector<S, M> {
    let unit = S::EPSILON * S::constant(ROUNDINGS);
    for (value, size) in values.as_mut_slice().iter_mut().zip(sizes.as_slice()) {
        if value.abs() <= *size * unit {
            *value = S::zero();
        }
    }
    values
}
