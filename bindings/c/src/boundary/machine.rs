//! A run as the caller's memory holds it, and what a call does with it: the same for every system.

use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, Quantity, StepTaken};
use dalembert::system::Scalar;
use dalembert::{State, StepError};
use dalembert_face::{Column, Fields, Interface, Multipliers, StepMade, by_state};

use super::{CParameters, Plain, refused};
use crate::Status;

/// A system by a rule whose numbers C reads as they are.
pub trait Plainly<const N: usize>: Interface<N, System: CParameters, Scalar: Plain> {}

#[diagnostic::do_not_recommend]
impl<I: Interface<N, System: CParameters, Scalar: Plain>, const N: usize> Plainly<N> for I {}

/// A system as the functions of C enter it: a type of its own in each [`c_api!`](crate::c_api), so that a
/// wrong rule is said of it, and not of each function.
pub trait Entered<const N: usize>: 'static {
    /// The signature that a memory of this system begins with: [`layout`](dalembert_face::layout).
    const SIGNATURE: u64;
    /// The system by its rule.
    type Of: Plainly<N>;
    /// The derivatives of a step, as C reads them.
    type Linearized: Plain;

    /// The derivatives of a step.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn linearized(taken: &Taken<'_, '_, Self, N>) -> Result<Self::Linearized, StepError>;
}

/// The struct that C fills in.
pub type Filled<C, const N: usize> = <System<C, N> as Fields>::Given;
/// The struct of the system.
pub type System<C, const N: usize> = <<C as Entered<N>>::Of as Interface<N>>::System;
/// `f64` or `f32`.
pub type Number<C, const N: usize> = <<C as Entered<N>>::Of as Interface<N>>::Scalar;
/// The rule.
pub type Rule<C, const N: usize> = <<C as Entered<N>>::Of as Interface<N>>::Rule;
/// Views as a run names them.
pub type Kind<C, const N: usize> = <<C as Entered<N>>::Of as Interface<N>>::Kind;
/// The system with its input and time.
pub type View<'a, C, const N: usize> = <<C as Entered<N>>::Of as Interface<N>>::View<'a>;
/// A step that was just taken.
pub type Taken<'a, 's, C, const N: usize> = StepTaken<'a, View<'s, C, N>, Rule<C, N>, N>;
/// u and t of a step.
pub type Given<C, const N: usize> = (<<C as Entered<N>>::Of as Interface<N>>::Input, Number<C, N>);

/// The type of λ.
pub type Lambda<C, const N: usize> = <<C as Entered<N>>::Of as Interface<N>>::Multipliers;
/// A step with its input and time.
pub type Made<C, const N: usize> = (Given<C, N>, StepMade<Number<C, N>, N>);

/// The parameters and the run of a system: what lies behind the signature.
pub struct Machine<C: Entered<N>, const N: usize> {
    /// The system, as C filled it in.
    pub system: System<C, N>,
    /// The run of its views.
    pub run: DrivenTrajectory<Kind<C, N>, Rule<C, N>, N>,
    /// The last step with these parameters, of which λ is asked.
    pub last: <Lambda<C, N> as Multipliers>::Kept<Made<C, N>>,
}

impl<C: Entered<N>, const N: usize> Machine<C, N> {
    /// A run that has taken no step with these parameters.
    pub fn begun(system: System<C, N>, run: DrivenTrajectory<Kind<C, N>, Rule<C, N>, N>) -> Self {
        Self { system, run, last: Default::default() }
    }
}

impl<C: Entered<N>, const N: usize> Clone for Machine<C, N> {
    fn clone(&self) -> Self {
        Self { system: self.system, run: self.run.clone(), last: self.last }
    }
}

/// The system of these parameters, none of which is NaN, and tables of which have the right points.
///
/// # Errors
/// [`Status::ParameterNan`], or the status of a [`WrongPoints`](dalembert_face::WrongPoints).
pub fn parameters<P: CParameters>(given: &P::Given) -> Result<P, Status> {
    if given.has_nan() {
        return Err(Status::ParameterNan);
    }
    P::of(given).map_err(Status::from)
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

/// The derivatives of a step by state, input and parameters, as matrices of S.
pub type Rows<S, const M: usize, const P: usize, const ROWS: usize> =
    ([[S; ROWS]; ROWS], [[S; M]; ROWS], [[S; P]; ROWS]);

/// The derivatives of a step, in rows of (q1, p1).
///
/// # Errors
/// [`StepError::NonFinite`].
pub fn rows<I: Interface<N>, const N: usize, const M: usize, const P: usize, const ROWS: usize>(
    taken: &StepTaken<'_, I::View<'_>, I::Rule, N>,
) -> Result<Rows<I::Scalar, M, P, ROWS>, StepError> {
    let (by_input, by_parameters) = (I::by_input(taken)?, I::by_parameters(taken)?);
    let by_state = rows_by(by_state(&taken.by_state()?).as_flattened());
    Ok((by_state, rows_by(by_input.as_ref()), rows_by(by_parameters.as_ref())))
}

fn rows_by<S: Scalar, const N: usize, const K: usize, const ROWS: usize>(
    columns: &[Column<S, N>],
) -> [[S; K]; ROWS] {
    let entry = |row: usize, [q, p]: &Column<S, N>| if row < N { q[row % N] } else { p[row % N] };
    core::array::from_fn(|row| {
        core::array::from_fn(|k| columns.get(k).map_or(S::constant(0.0), |column| entry(row, column)))
    })
}
