//! States on the constraints: the nearest one in the metric of the mass.

use nalgebra::{SMatrix, SVector};

use super::complement::Complement;
use super::independent::Independent;
use super::inertia::Inertia;
use super::rows::with_last;
use super::undefined::undefined;
use crate::numbers::linear::by_columns;
use crate::numbers::{Scalar, linear};
use crate::step::newton::{estimated_floor, held_against};
use crate::step::{State, Step, StepError};
use crate::system::{Constrained, Quantity, off, sizes};

/// Corrections of a configuration or a velocity.
const MOST: u32 = 24;

/// Projections of a momentum whose velocity is linear in it.
const PROJECTIONS: u32 = 3;

/// The share of its square, in roundings, that others leave of a gradient that depends on them.
const DEPENDENT: f64 = 64.0;

/// Roundings of the terms of G·v below which its value counts as 0.
const ROUNDINGS: f64 = 8.0;

impl<S: Scalar, const N: usize> State<S, N> {
    /// The state on the constraints of `system` that is nearest to (q, v), in the metric of the mass ∂²L/∂v²:
    /// q first, then v at q. The configuration is found along the normals, by Newton's method: off the
    /// nearest one by about the square of the distance over the radius of curvature, at most. Where all
    /// constraints are of velocity, q stays as it is.
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
    /// no state in reach is on all of them; [`StepError::NoDerivative`] where one has no gradient; those of
    /// [`State::from_velocity`](crate::State::from_velocity) but for the constraints.
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
        // Constraints of velocity alone do not hold q.
        for _ in 0..if L::OF_VELOCITY < M { MOST } else { 0 } {
            let at = AtPoint::<S, N, M>::of_configuration(system, &q, &v)?;
            let correction = at.answers * at.complement.solve(&at.values);
            let next = q - correction;
            StepError::require_finite(&next, Quantity::Configuration)
                .map_err(|_| undefined_or_dependent::<L, N, M>(system, &q))?;
            q = next;
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
    /// # Errors
    /// [`StepError::DependentConstraints`]; those of [`Inertia::at`].
    pub(super) fn at<L>(system: &L, q: &SVector<S, N>, v: &SVector<S, N>) -> Result<Self, StepError>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        Self::of(system, q, Inertia::at(system, q, v)?)
    }

    /// # Errors
    /// [`StepError::DependentConstraints`].
    fn of<L>(system: &L, q: &SVector<S, N>, inertia: Inertia<S, N>) -> Result<Self, StepError>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let (values, gradients) = system.constraint_gradients(q);
        Self::by(system, q, inertia, (values, gradients), None)
    }

    /// Without constraints of velocity: their rows are 0.
    ///
    /// # Errors
    /// Those of [`at`](Self::at).
    pub(super) fn of_configuration<L>(
        system: &L,
        q: &SVector<S, N>,
        v: &SVector<S, N>,
    ) -> Result<Self, StepError>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let (values, gradients) = system.constraint_gradients(q);
        let gradients = with_last(gradients, &nalgebra::zero(), L::OF_VELOCITY);
        // Whatever stands on the diagonal there, their multipliers are 0.
        let beside = with_last(nalgebra::zero(), &SMatrix::identity(), L::OF_VELOCITY);
        Self::by(system, q, Inertia::at(system, q, v)?, (values, gradients), Some(&beside))
    }

    fn by<L>(
        system: &L,
        q: &SVector<S, N>,
        inertia: Inertia<S, N>,
        (values, gradients): (SVector<S, M>, SMatrix<S, M, N>),
        beside: Option<&SMatrix<S, M, M>>,
    ) -> Result<Self, StepError>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let directions = gradients.transpose();
        let answers = by_columns(&directions, |direction| inertia.solve(direction));
        let product = gradients * answers;
        let matrix = beside.map_or(product, |beside| product + beside);
        match Complement::of(&matrix, || Independent::of(&{ gradients }, &{ directions }, &{ answers })) {
            Some(complement) => Ok(Self { values, gradients, inertia, answers, complement }),
            None => Err(undefined_or_dependent::<L, N, M>(system, q)),
        }
    }
}

/// v moves the constraints by G v, and they move by themselves where they are prescribed.
fn rates<L, const N: usize, const M: usize>(
    system: &L,
    at: &AtPoint<L::Scalar, N, M>,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> SVector<L::Scalar, M>
where
    L: Constrained<N, M>,
{
    if L::IS_PRESCRIBED { system.constraint_rates(q, v).0 } else { at.gradients * v }
}

/// Fails where q is off a constraint, or one is no number there.
pub(super) fn require_on<L, const N: usize, const M: usize>(
    system: &L,
    (values, gradients): (&SVector<L::Scalar, M>, &SMatrix<L::Scalar, M, N>),
    q: &SVector<L::Scalar, N>,
) -> Result<(), StepError>
where
    L: Constrained<N, M>,
{
    match off(values, gradients, q) {
        None => Ok(()),
        Some((constraint, value)) => {
            StepError::require_finite(q, Quantity::Configuration)?;
            let off = StepError::OffConstraint { constraint, value: value.widen() };
            Err(undefined::<L, N, M>(system, q, &nalgebra::zero()).unwrap_or(off))
        }
    }
}

/// The `step` of size `h` with its momentum on N at its end.
pub(super) fn held<L, const N: usize, const M: usize>(
    system: &L,
    step: Step<L::Scalar, N>,
    h: L::Scalar,
) -> Result<Step<L::Scalar, N>, StepError>
where
    L: Constrained<N, M>,
{
    let state = system.later(h, |system| tangent::<L, N, M>(system, &step.state))?;
    state.require_reached()?;
    Ok(Step { state, ..step })
}

/// The state with its momentum on N: p − Gᵀμ with ρ(q, v(q, p − Gᵀμ)) = 0.
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
    require_on(system, (&at.values, &at.gradients), &q)?;
    let mut v = at.inertia.solve(&(p - at_rest.d2));
    let mut moved = p;
    // Once, unless reactions are large and cancel, as at a light body.
    for projections in 0..PROJECTIONS {
        let left = rates(system, &at, &q, &v);
        if projections > 0 && is_held(&left, &at.gradients, &v) {
            break;
        }
        moved -= at.gradients.transpose() * at.complement.solve(&left);
        v = at.inertia.solve(&(moved - at_rest.d2));
    }
    let residual = system.lagrangian_gradient(&q, &v).d2 - moved;
    if held_against(&residual, &estimated_floor(&moved, &at_rest.d22, &v)).2 {
        return Ok(State { q, p: moved });
    }
    v = state.velocity(system)?;
    for _ in 0..MOST {
        let at = AtPoint::<_, N, M>::at(system, &q, &v)?;
        let left = rates(system, &at, &q, &v);
        if is_held(&left, &at.gradients, &v) {
            break;
        }
        p -= at.gradients.transpose() * at.complement.solve(&left);
        v = State { q, p }.velocity(system)?;
    }
    Ok(State { q, p })
}

/// Whether rounding explains what is `left` of ρ.
fn is_held<S: Scalar, const N: usize, const M: usize>(
    left: &SVector<S, M>,
    gradients: &SMatrix<S, M, N>,
    v: &SVector<S, N>,
) -> bool {
    let unit = S::EPSILON * S::constant(ROUNDINGS);
    let most = sizes(gradients, v) * unit;
    left.as_slice().iter().zip(most.as_slice()).all(|(left, most)| left.abs() <= *most)
}

/// The error of constraints of which one has no value or no gradient at q, or which do not determine their
/// reactions.
#[cold]
#[inline(never)]
fn undefined_or_dependent<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> StepError
where
    L: Constrained<N, M>,
{
    let undefined = undefined::<L, N, M>(system, q, &nalgebra::zero());
    undefined.unwrap_or_else(|| dependence::<L, N, M>(system, q))
}

/// The error of constraints that do not determine their reactions at q.
#[cold]
#[inline(never)]
pub(super) fn dependence<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> StepError
where
    L: Constrained<N, M>,
{
    let constraint = most_dependent::<L, N, M>(system, q).map_or(0, |(constraint, _)| constraint);
    StepError::DependentConstraints { constraint }
}

/// The constraint whose gradient depends on those before it, if rounding cannot tell one from them.
#[cold]
pub(super) fn dependent<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Option<usize>
where
    L: Constrained<N, M>,
{
    let (constraint, share) = most_dependent::<L, N, M>(system, q)?;
    let is_regular = share > L::Scalar::EPSILON * L::Scalar::constant(DEPENDENT);
    (!is_regular).then_some(constraint)
}

/// The constraint of whose gradient those before it leave least, in the metric of the mass at rest, and the
/// share that they leave: the square of a sine, NaN where there is no gradient.
#[cold]
#[inline(never)]
fn most_dependent<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Option<(usize, L::Scalar)>
where
    L: Constrained<N, M>,
{
    let inertia = Inertia::at(system, q, &nalgebra::zero()).ok()?;
    least_left(&system.constraint_gradients(q).1.transpose(), &inertia)
}

/// The column of which those before it leave least in this metric, and the share.
fn least_left<S: Scalar, const N: usize, const M: usize>(
    columns: &SMatrix<S, N, M>,
    inertia: &Inertia<S, N>,
) -> Option<(usize, S)> {
    let square = |x: &SVector<S, N>| linear::dot(x, &inertia.solve(x));
    let mut found: Option<(usize, S)> = None;
    // What each leaves, of length 1.
    let mut left = *columns;
    for (k, column) in columns.data.0.iter().enumerate() {
        let column = SVector::from(*column);
        let mut rest = column;
        for before in left.data.0.iter().take(k) {
            let before = SVector::from(*before);
            rest -= before * linear::dot(&before, &inertia.solve(&rest));
        }
        let size = square(&rest);
        let share = size / square(&column);
        if found.is_none_or(|(_, least)| least > share) || !share.is_finite() {
            found = Some((k, share));
        }
        if let Some(kept) = left.data.0.get_mut(k) {
            [*kept] = if size > S::zero() { rest / size.sqrt() } else { nalgebra::zero() }.data.0;
        }
    }
    found
}
