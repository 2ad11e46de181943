//! A system by a rule, without a word about which: what functions of other languages are written for once.

use core::marker::PhantomData;

use dalembert::nalgebra::SVector;
use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, Linearizable, Memory, StepTaken, require_step_size};
use dalembert::system::{Described, Scalar};
use dalembert::{State, StepError};

use crate::columns::{ByInput, ByParameters, Column};
use crate::constraints::{Holding, Multipliers, Reacting, StepMade};
use crate::mass::require_no_negative;
use crate::{FieldType, Fields, Outputs};

/// The type of u: numbers, or `()` where a system takes none.
pub trait Input<S>: Copy {
    /// Zeros.
    fn zero() -> Self;

    /// These numbers; `None` where they are more or fewer.
    fn of(numbers: &[S]) -> Option<Self>;
}

impl<S> Input<S> for () {
    fn zero() -> Self {}

    fn of(numbers: &[S]) -> Option<Self> {
        numbers.is_empty().then_some(())
    }
}

impl<S: Scalar, const M: usize> Input<S> for [S; M] {
    fn zero() -> Self {
        [S::constant(0.0); M]
    }

    fn of(numbers: &[S]) -> Option<Self> {
        numbers.try_into().ok()
    }
}

/// A system by a rule: [`By`] of the two.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no steps in other languages",
    label = "no steps of this system by this rule",
    note = "the rule is one of those that `#[rayleigh_system(rule = …)]` lists, midpoint if none",
    note = "the struct of the system is declared within `parameters! {{ … }}`"
)]
pub trait Interface<const N: usize>: Sized + 'static {
    /// The struct of the system.
    type System: Described<N, Scalar = Self::Scalar> + Fields;
    /// The rule.
    type Rule: 'static;
    /// `f64` or `f32`.
    type Scalar: Scalar + FieldType;
    /// The type of u.
    type Input: Input<Self::Scalar>;
    /// The type of λ.
    type Multipliers: Multipliers;
    /// The memory that a run keeps from step to step.
    type RunMemory: for<'a> Memory<Self::View<'a>, Self::Rule, N> + Clone + 'static;
    /// Views as a run names them.
    type Kind: Linearizable<Self::Rule, N, Scalar = Self::Scalar, RunMemory = Self::RunMemory> + 'static;
    /// The system with its input and time.
    type View<'a>: Linearizable<Self::Rule, N, Scalar = Self::Scalar, RunMemory = Self::RunMemory>;

    /// The system with u at time t, as far as it takes them.
    fn view(system: &Self::System, u: Self::Input, t: Self::Scalar) -> Self::View<'_>;

    /// The state on all constraints that is nearest to (q, v): [`Holding::nearest`].
    ///
    /// # Errors
    /// A [`StepError`].
    fn nearest(
        system: &Self::View<'_>,
        motion: [[Self::Scalar; N]; 2],
    ) -> Result<State<Self::Scalar, N>, StepError>;

    /// λ of a step: [`Reacting::reactions`].
    ///
    /// # Errors
    /// A [`StepError`].
    fn reactions(
        system: &Self::View<'_>,
        made: &StepMade<Self::Scalar, N>,
    ) -> Result<impl AsRef<[Self::Scalar]>, StepError>;

    /// The outputs at (q, v).
    fn outputs(
        system: &Self::View<'_>,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> impl AsRef<[Self::Scalar]>;

    /// The derivatives of a step by each entry of u.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_input(
        taken: &StepTaken<'_, Self::View<'_>, Self::Rule, N>,
    ) -> Result<impl AsRef<[Column<Self::Scalar, N>]>, StepError>;

    /// The derivatives of a step by each listed parameter.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_parameters(
        taken: &StepTaken<'_, Self::View<'_>, Self::Rule, N>,
    ) -> Result<impl AsRef<[Column<Self::Scalar, N>]>, StepError>;
}

/// The system S by the rule R.
pub struct By<S, R>(PhantomData<fn() -> (S, R)>);

#[diagnostic::do_not_recommend]
impl<S, R, K, const N: usize> Interface<N> for By<S, R>
where
    S: Described<N> + Fields,
    S::Scalar: FieldType,
    S::Input: Input<S::Scalar> + for<'a> ByInput<S::View<'a>, R, N>,
    S::Parameters: for<'a> ByParameters<S::View<'a>, R, N>,
    S::Multipliers: for<'a> Reacting<S::View<'a>, R, N>,
    S::Outputs: for<'a> Outputs<S::View<'a>, N>,
    for<'a> S::View<'a>: Linearizable<R, N> + Flow<R, N, RunMemory = K>,
    K: for<'a> Memory<S::View<'a>, R, N> + Clone + 'static,
    R: 'static,
{
    type System = S;
    type Rule = R;
    type Scalar = S::Scalar;
    type Input = S::Input;
    type Multipliers = S::Multipliers;
    type RunMemory = K;
    type Kind = S::View<'static>;
    type View<'a> = S::View<'a>;

    fn view(system: &S, u: S::Input, t: S::Scalar) -> S::View<'_> {
        system.view(*system, u, t)
    }

    fn nearest(system: &S::View<'_>, [q, v]: [[S::Scalar; N]; 2]) -> Result<State<S::Scalar, N>, StepError> {
        S::Multipliers::nearest(system, q.into(), v.into())
    }

    fn reactions(
        system: &S::View<'_>,
        made: &StepMade<S::Scalar, N>,
    ) -> Result<impl AsRef<[S::Scalar]>, StepError> {
        S::Multipliers::reactions(system, made)
    }

    fn outputs(
        system: &S::View<'_>,
        q: &SVector<S::Scalar, N>,
        v: &SVector<S::Scalar, N>,
    ) -> impl AsRef<[S::Scalar]> {
        S::Outputs::values(system, q, v)
    }

    fn by_input(
        taken: &StepTaken<'_, S::View<'_>, R, N>,
    ) -> Result<impl AsRef<[Column<S::Scalar, N>]>, StepError> {
        S::Input::columns(taken)
    }

    fn by_parameters(
        taken: &StepTaken<'_, S::View<'_>, R, N>,
    ) -> Result<impl AsRef<[Column<S::Scalar, N>]>, StepError> {
        S::Parameters::columns(taken)
    }
}

/// N of a system, which no type but the trait says.
#[must_use]
pub const fn coordinates<S: Described<N>, const N: usize>(_: PhantomData<fn() -> S>) -> usize {
    N
}

/// A run of `system` from (q, v), with step size `h`.
///
/// # Errors
/// [`StepError`]s of the start; [`StepError::MassNotPositiveDefinite`] where some velocity has a kinetic
/// energy below 0.
pub fn start<I: Interface<N>, const N: usize>(
    system: &I::System,
    (u, t): (I::Input, I::Scalar),
    h: I::Scalar,
    [q, v]: [[I::Scalar; N]; 2],
) -> Result<DrivenTrajectory<I::Kind, I::Rule, N>, StepError> {
    require_step_size(h)?;
    let (view, q, v) = (I::view(system, u, t), SVector::from(q), SVector::from(v));
    let start = State::from_velocity(&view, q, v)?;
    require_no_negative(&view, &q, &v)?;
    Ok(DrivenTrajectory::new(h, start))
}
