//! A run as the caller's memory holds it, and what a call does with it: the same for every system.

use dalembert::nalgebra::SVector;
use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, PhaseMatrix, Quantity, StateBy};
use dalembert::system::{Lagrangian, Scalar};
use dalembert::{State, StepError};

use crate::{CParameters, Status};

/// The parameters and the run of a system: what lies behind the signature.
pub struct Machine<P, V, M, const N: usize>
where
    V: Flow<M, N>,
{
    /// The system, as C filled it in.
    pub system: P,
    /// The run of its views.
    pub run: DrivenTrajectory<V, M, N>,
}

/// The parameters, none of which is NaN.
///
/// # Errors
/// [`Status::ParameterNan`].
pub fn parameters<P: CParameters>(given: P) -> Result<P, Status> {
    if given.has_nan() { Err(Status::ParameterNan) } else { Ok(given) }
}

/// The input, all of it finite.
///
/// # Errors
/// [`Status::InputNotFinite`].
pub fn input<S: Scalar, const K: usize>(given: [S; K]) -> Result<[S; K], Status> {
    if given.iter().all(|value| value.is_finite()) { Ok(given) } else { Err(Status::InputNotFinite) }
}

/// Fails where `h` is 0 or not finite.
///
/// # Errors
/// [`StepError::StepSize`].
pub fn require_step_size<S: Scalar>(h: S) -> Result<(), StepError> {
    let h = h.widen();
    if h.is_finite() && h != 0.0 { Ok(()) } else { Err(StepError::StepSize { h }) }
}

/// The state of these numbers.
///
/// # Errors
/// [`StepError::NonFinite`].
pub fn state<S: Scalar, const N: usize>(q: [S; N], p: [S; N]) -> Result<State<S, N>, StepError> {
    let odd = |values: &[S; N]| values.iter().position(|value| !value.is_finite());
    let error = |quantity| move |index| Err(StepError::NonFinite { quantity, index });
    odd(&q).map_or(Ok(()), error(Quantity::Configuration))?;
    odd(&p).map_or(Ok(()), error(Quantity::Momentum))?;
    Ok(State { q: q.into(), p: p.into() })
}

/// A run of `view` from (q, v), with step size `h`.
///
/// # Errors
/// [`StepError`]s of the start.
pub fn start<V, W, M, const N: usize>(
    view: &W,
    h: V::Scalar,
    [q, v]: [[V::Scalar; N]; 2],
) -> Result<DrivenTrajectory<V, M, N>, StepError>
where
    V: Flow<M, N>,
    W: Lagrangian<N, Scalar = V::Scalar>,
{
    require_step_size(h)?;
    let start = State::from_velocity(view, SVector::from(q), SVector::from(v))?;
    Ok(DrivenTrajectory::new(h, start))
}

/// Where a step of `after`, or none, leads to from `state`.
///
/// # Errors
/// A [`StepError`].
pub fn state_after<L: Flow<M, N>, M, const N: usize>(
    system: &L,
    after: L::Scalar,
    state: &State<L::Scalar, N>,
) -> Result<State<L::Scalar, N>, StepError> {
    if after == L::Scalar::constant(0.0) { Ok(*state) } else { Ok(system.step(state, after, None)?.state) }
}

impl<P: Copy, V, M, const N: usize> Machine<P, V, M, N>
where
    V: Flow<M, N>,
{
    /// Goes on from the present state and time with other parameters.
    pub fn change_parameters(&mut self, system: P) {
        *self = Self { system, run: DrivenTrajectory::resume(self.run.present()) };
    }
}

/// A = ∂(q1, p1)/∂(q0, p0) in rows of (q1, p1), a column each of (q0, p0).
#[must_use]
pub fn rows_by_state<S: Scalar, const N: usize, const ROWS: usize>(
    a: &PhaseMatrix<S, N>,
) -> [[S; ROWS]; ROWS] {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| {
            let block = match (row < N, column < N) {
                (true, true) => &a.q_by_q,
                (true, false) => &a.q_by_p,
                (false, true) => &a.p_by_q,
                (false, false) => &a.p_by_p,
            };
            block[(row % N, column % N)]
        })
    })
}

/// ∂(q1, p1)/∂θ in rows of (q1, p1), a column each of θ.
#[must_use]
pub fn rows_by<S: Scalar, const N: usize, const K: usize, const ROWS: usize>(
    b: &StateBy<S, N, K>,
) -> [[S; K]; ROWS] {
    core::array::from_fn(|row| {
        let block = if row < N { &b.q } else { &b.p };
        core::array::from_fn(|column| block[(row % N, column)])
    })
}
