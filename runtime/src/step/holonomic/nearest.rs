//! States on the constraints: the nearest one in the metric of the mass.

use nalgebra::{SMatrix, SVector};

use super::columns::by_columns;
use super::complement::Complement;
use super::inertia::Inertia;
use crate::numbers::{Scalar, linear};
use crate::step::newton::{estimated_floor, held_against};
use crate::step::{State, StepError};
use crate::system::{Constrained, Quantity, off, sizes};

/// Corrections of a configuration or a velocity.
const MOST: u32 = 24;

/// Roundings of the terms of G·v below which its value counts as 0.
const ROUNDINGS: f64 = 8.0;

impl<S: Scalar, const N: usize> State<S, N> {
    /// The state on the constraints of `system` that is nearest to (q, v), in the metric of the mass ∂²L/∂v²:
    /// q first, then v at q.
    ///
    /// ```
    /// use dalembert::{State, rayleigh_system};
    ///
    /// struct Pendulum;
    ///
    /// #[rayleigh_system]
    /// impl Pendulum {
    ///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
    ///         0.5 * (v[0] * v[0] + v[1] * v[1]) - 9.81 * q[1]
    ///     }
    ///     fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
    ///         [q[0] * q[0] + q[1] * q[1] - 1.0]
    ///     }
    /// }
    ///
    /// let start = State::nearest(&Pendulum, [0.6, -0.79], [1.0, 0.0])?;
    /// assert!((start.q.norm() - 1.0).abs() < 1e-15 && start.q.dot(&start.p).abs() < 1e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::DependentConstraints`] where the gradients of the constraints do not tell where to go, or
    /// no state in reach is on all of them; those of [`State::from_velocity`](crate::State::from_velocity)
    /// but for the constraints.
    pub fn nearest<L, const M: usize>(
        system: &L,
        q: impl Into<SVector<S, N>>,
        v: impl Into<SVector<S, N>>,
    ) -> Result<Self, StepError>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let (mut q, v) = (q.into(), v.into());
        StepError::require_finite(&q, Quantity::Configuration)?;
        StepError::require_finite(&v, Quantity::Velocity)?;
        for _ in 0..MOST {
            let at = AtPoint::<S, N, M>::of(system, &q, Inertia::at(system, &q, &v)?)?;
            let correction = at.answers * at.complement.solve(&at.values);
            q -= correction;
            StepError::require_finite(&q, Quantity::Configuration)?;
            let mut entries = correction.as_slice().iter().zip(q.as_slice());
            if entries.all(|(correction, q)| correction.abs() <= q.abs() * S::EPSILON) {
                break;
            }
        }
        let p = system.lagrangian_gradient(&q, &v).d2;
        tangent(system, &Self { q, p }).map_err(|error| match error {
            // No state in reach is on all of them.
            StepError::OffConstraint { constraint, .. } => StepError::DependentConstraints { constraint },
            other => other,
        })
    }
}

/// The constraints at a point in the metric of the mass.
pub(super) struct AtPoint<S: Scalar, const N: usize, const M: usize> {
    /// g(q).
    pub(super) values: SVector<S, M>,
    /// G(q).
    pub(super) gradients: SMatrix<S, M, N>,
    pub(super) inertia: Inertia<S, N>,
    /// M⁻¹ Gᵀ.
    pub(super) answers: SMatrix<S, N, M>,
    /// G M⁻¹ Gᵀ.
    pub(super) complement: Complement<S, M>,
}

impl<S: Scalar, const N: usize, const M: usize> AtPoint<S, N, M> {
    pub(super) fn of<L: Constrained<N, M, Scalar = S>>(
        system: &L,
        q: &SVector<S, N>,
        inertia: Inertia<S, N>,
    ) -> Result<Self, StepError> {
        let (values, gradients) = system.constraint_gradients(q);
        let directions = gradients.transpose();
        let answers = by_columns(&directions, |direction| inertia.solve(direction));
        match Complement::of(&(gradients * answers)) {
            Some(complement) => Ok(Self { values, gradients, inertia, answers, complement }),
            None => {
                StepError::require_finite(&directions, Quantity::Derivatives)?;
                Err(StepError::DependentConstraints { constraint: 0 })
            }
        }
    }
}

/// Fails where q is off a constraint.
pub(super) fn require_on<S: Scalar, const N: usize, const M: usize>(
    values: &SVector<S, M>,
    gradients: &SMatrix<S, M, N>,
    q: &SVector<S, N>,
) -> Result<(), StepError> {
    match off(values, gradients, q) {
        None => Ok(()),
        Some((constraint, value)) => Err(StepError::OffConstraint { constraint, value: value.widen() }),
    }
}

/// The state with its momentum on N: p − Gᵀμ with G·v(q, p − Gᵀμ) = 0.
pub(super) fn tangent<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<State<L::Scalar, N>, StepError>
where
    L: Constrained<N, M>,
{
    let State { q, mut p } = *state;
    let rest = nalgebra::zero();
    let at_rest = system.lagrangian_derivatives(&q, &rest);
    // Where L is quadratic in v, M is the mass everywhere.
    let at = AtPoint::<_, N, M>::of(system, &q, Inertia::of(system, &q, &rest, &at_rest.d22)?)?;
    require_on(&at.values, &at.gradients, &q)?;
    let mut v = at.inertia.solve(&(p - at_rest.d2));
    let mu = at.complement.solve(&(at.gradients * v));
    let moved = p - at.gradients.transpose() * mu;
    v -= at.answers * mu;
    let residual = system.lagrangian_gradient(&q, &v).d2 - moved;
    if held_against(&residual, &estimated_floor(&moved, &at_rest.d22, &v)).2 {
        return Ok(State { q, p: moved });
    }
    v = state.velocity(system)?;
    for _ in 0..MOST {
        let at = AtPoint::<_, N, M>::of(system, &q, Inertia::at(system, &q, &v)?)?;
        let left = at.gradients * v;
        if is_held(&left, &at.gradients, &v) {
            break;
        }
        p -= at.gradients.transpose() * at.complement.solve(&left);
        v = State { q, p }.velocity(system)?;
    }
    Ok(State { q, p })
}

/// Whether rounding explains what is `left` of G·v.
fn is_held<S: Scalar, const N: usize, const M: usize>(
    left: &SVector<S, M>,
    gradients: &SMatrix<S, M, N>,
    v: &SVector<S, N>,
) -> bool {
    let unit = S::EPSILON * S::constant(ROUNDINGS);
    let most = sizes(gradients, v) * unit;
    left.as_slice().iter().zip(most.as_slice()).all(|(left, most)| left.abs() <= *most)
}

/// The first constraint whose gradient depends on those before it, in the metric of the mass at rest.
#[cold]
#[inline(never)]
pub(super) fn dependent<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Option<usize>
where
    L: Constrained<N, M>,
{
    let inertia = Inertia::at(system, q, &nalgebra::zero()).ok()?;
    let (_, gradients) = system.constraint_gradients(q);
    let answers = by_columns(&gradients.transpose(), |direction| inertia.solve(direction));
    let complement: SMatrix<L::Scalar, M, M> = gradients * answers;
    linear::require_regular(&complement).err().map(|singular| singular.column)
}
