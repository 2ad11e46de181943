//! A run as the caller's memory holds it, and what a call does with it: the same for every system.

use core::marker::PhantomData;

use dalembert::nalgebra::SVector;
use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, Linearizable, Memory, PhaseMatrix, Quantity, StateBy, StepTaken};
use dalembert::system::Scalar;
use dalembert::{State, StepError};

use crate::boundary::{Plain, refused};
use crate::{CParameters, Status};

/// A system that the functions of C can step. Where an entry of [`c_api!`](crate::c_api) does not fit, the
/// compiler says so once, by the message of this trait.
#[diagnostic::on_unimplemented(
    message = "C cannot step `{Self}` by `{M}` with {N} coordinates",
    label = "no step with this number of coordinates, this rule, this input",
    note = "`coordinates` is the length of q, `rule` one of those that `#[rayleigh_system(rule = …)]` lists, midpoint if none",
    note = "a force with an input needs `driven: Driven…, inputs: …`; L, R or f with the time `time` behind them, or `at_time: …AtTime`"
)]
pub trait Stepped<M, const N: usize>: Linearizable<M, N> {}

#[diagnostic::do_not_recommend]
impl<V: Linearizable<M, N>, M, const N: usize> Stepped<M, N> for V {}

/// That a system is [`Stepped`], as a type: said before anything that follows from its not being so.
pub struct Checked<V: Stepped<M, N>, M, const N: usize>(PhantomData<fn() -> (V, M)>);

/// A system as C sees it: what [`c_api!`](crate::c_api) states once, so that the functions are the same for
/// all.
pub trait Interface<const N: usize>: Sized + 'static {
    /// The signature that a memory of this system begins with: [`layout`](crate::layout).
    const SIGNATURE: u64;
    /// The struct of the system.
    type Parameters: CParameters;
    /// The rule.
    type Rule: 'static;
    /// `f64` or `f32`.
    type Scalar: Scalar + Plain;
    /// The input and the time of a step, as far as the system takes them.
    type Given;
    /// The derivatives of a step, as C reads them.
    type Linearized: Plain;
    /// The memory that a run keeps from step to step.
    type RunMemory: for<'a> Memory<Self::View<'a>, Self::Rule, N> + Clone + 'static;
    /// Views as a run names them.
    type Kind: Stepped<Self::Rule, N, Scalar = Self::Scalar, RunMemory = Self::RunMemory> + 'static;
    /// The system with its input and time.
    type View<'a>: Stepped<Self::Rule, N, Scalar = Self::Scalar, RunMemory = Self::RunMemory>;

    /// Takes what the system needs of an input and a time; `None` where the input has another length.
    fn given(input: &[Self::Scalar], time: Self::Scalar) -> Option<Self::Given>;

    /// The system with what is given.
    fn view(system: &Self::Parameters, given: Self::Given) -> Self::View<'_>;

    /// The derivatives of a step.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn linearized(
        taken: &StepTaken<'_, Self::View<'_>, Self::Rule, N>,
    ) -> Result<Self::Linearized, StepError>;

    /// A, B and the derivatives by parameters, one row of (q1, p1) after the other; none where there are
    /// none.
    fn rows(linearized: &Self::Linearized) -> [&[Self::Scalar]; 3];
}

/// The parameters and the run of a system: what lies behind the signature.
pub struct Machine<I: Interface<N>, const N: usize> {
    /// The system, as C filled it in.
    pub system: I::Parameters,
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

/// A run of `system` from (q, v), with step size `h`.
///
/// # Errors
/// [`StepError`]s of the start.
pub fn start<I: Interface<N>, const N: usize>(
    system: &I::Parameters,
    given: I::Given,
    h: I::Scalar,
    [q, v]: [[I::Scalar; N]; 2],
) -> Result<DrivenTrajectory<I::Kind, I::Rule, N>, StepError> {
    require_step_size(h)?;
    let start = State::from_velocity(&I::view(system, given), SVector::from(q), SVector::from(v))?;
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
