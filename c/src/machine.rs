//! A run as the caller's memory holds it, and what a call does with it: the same for every system.

use core::marker::PhantomData;

use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, Linearizable, PhaseMatrix, Quantity};
use dalembert::system::Scalar;
use dalembert::{State, StepError};
use dalembert_face::{Column, Interface};

use crate::boundary::{Plain, refused};
use crate::{CParameters, Status};

/// A system that the functions of C can step. Where an entry of [`c_api!`](crate::c_api) does not fit, the
/// compiler says so once, by the message of this trait.
#[diagnostic::on_unimplemented(
    message = "C cannot step `{Self}` by `{M}` with {N} coordinates",
    label = "no step by this rule",
    note = "`rule` is one of those that `#[rayleigh_system(rule = …)]` lists, midpoint if none"
)]
pub trait Stepped<M, const N: usize>: Linearizable<M, N> {}

#[diagnostic::do_not_recommend]
impl<V: Linearizable<M, N>, M, const N: usize> Stepped<M, N> for V {}

/// That a system is [`Stepped`], as a type: said before anything that follows from its not being so.
pub struct Checked<V: Stepped<M, N>, M, const N: usize>(PhantomData<fn() -> (V, M)>);

/// A system by a rule whose numbers C reads as they are.
pub trait Plainly<const N: usize>: Interface<N, System: CParameters, Scalar: Plain> {}

impl<I: Interface<N, System: CParameters, Scalar: Plain>, const N: usize> Plainly<N> for I {}

/// The parameters and the run of a system: what lies behind the signature.
pub struct Machine<I: Interface<N>, const N: usize> {
    /// The system, as C filled it in.
    pub system: I::System,
    /// The run of its views.
    pub run: DrivenTrajectory<I::Kind, I::Rule, N>,
}

impl<I: Interface<N>, const N: usize> Clone for Machine<I, N> {
    fn clone(&self) -> Self {
        Self { system: self.system, run: self.run.clone() }
    }
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
    if given.iter().all(|value| value.is_finite()) { Ok(given) } else { Err(refused(Status::InputNotFinite)) }
}

/// The time, if it is finite.
///
/// # Errors
/// [`Status::InputNotFinite`].
pub fn time<S: Scalar>(given: S) -> Result<S, Status> {
    input([given]).map(|[given]| given)
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

/// Derivatives in rows of (q1, p1), a column each of what they are by.
#[must_use]
pub fn rows<S: Scalar, const N: usize, const K: usize, const ROWS: usize>(
    columns: &[Column<S, N>],
) -> [[S; K]; ROWS] {
    let entry = |row: usize, [q, p]: &Column<S, N>| if row < N { q[row % N] } else { p[row % N] };
    core::array::from_fn(|row| {
        core::array::from_fn(|k| columns.get(k).map_or(S::constant(0.0), |column| entry(row, column)))
    })
}
