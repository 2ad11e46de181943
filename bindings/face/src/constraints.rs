//! Constraints of a system, however many there are: questions that the type of λ answers.

use dalembert::nalgebra::SVector;
use dalembert::rules::Fused;
use dalembert::step::{ClosedForm, Constraints, Discrete, Linearizable, Step};
use dalembert::system::{Constrained, Scalar};
use dalembert::{Discretise, Lagrangian, State, StepError};

/// A step that was made: h, the state before it, and the step.
#[derive(Clone, Copy, Debug)]
pub struct StepMade<S: Scalar, const N: usize> {
    /// h.
    pub h: S,
    /// (q0, p0).
    pub state: State<S, N>,
    /// The step.
    pub step: Step<S, N>,
}

/// The type of λ, the multipliers of all constraints: `[S; M]`, or `()` where there are none.
pub trait Multipliers: 'static {
    /// T of systems with constraints, once there is one: of others nothing, which takes no room.
    type Kept<T: Copy + 'static>: Copy + Default + 'static;

    /// T, where there are constraints.
    fn keep<T: Copy + 'static>(make: impl FnOnce() -> T) -> Self::Kept<T>;

    /// The one that is kept.
    fn kept<T: Copy + 'static>(kept: &Self::Kept<T>) -> Option<&T>;
}

/// The type of λ, by which states of V are brought onto its constraints.
pub trait Holding<V: Lagrangian<N>, const N: usize>: Multipliers {
    /// The state on all constraints that is nearest to (q, v), in the metric of the mass; without constraints
    /// that of (q, v).
    ///
    /// # Errors
    /// Those of [`State::nearest`], or of [`State::from_velocity`].
    fn nearest(
        system: &V,
        q: SVector<V::Scalar, N>,
        v: SVector<V::Scalar, N>,
    ) -> Result<State<V::Scalar, N>, StepError>;
}

/// The type of λ, by which steps of V by the rule R are asked for it.
pub trait Reacting<V: Linearizable<R, N>, R, const N: usize>: Holding<V, N> {
    /// λ of a step of `system`: the constraints act by the force Gᵀλ. Without constraints there is none.
    ///
    /// # Errors
    /// Those of [`Discretised::reactions`](dalembert::Discretised::reactions).
    fn reactions(system: &V, made: &StepMade<V::Scalar, N>) -> Result<impl AsRef<[V::Scalar]>, StepError>;
}

impl Multipliers for () {
    type Kept<T: Copy + 'static> = ();

    fn keep<T: Copy + 'static>(_: impl FnOnce() -> T) {}

    fn kept<T: Copy + 'static>(_: &()) -> Option<&T> {
        None
    }
}

impl<S: Scalar, const M: usize> Multipliers for [S; M] {
    type Kept<T: Copy + 'static> = Option<T>;

    fn keep<T: Copy + 'static>(make: impl FnOnce() -> T) -> Option<T> {
        Some(make())
    }

    fn kept<T: Copy + 'static>(kept: &Option<T>) -> Option<&T> {
        kept.as_ref()
    }
}

impl<V: Lagrangian<N>, const N: usize> Holding<V, N> for () {
    fn nearest(
        system: &V,
        q: SVector<V::Scalar, N>,
        v: SVector<V::Scalar, N>,
    ) -> Result<State<V::Scalar, N>, StepError> {
        State::from_velocity(system, q, v)
    }
}

impl<V: Linearizable<R, N>, R, const N: usize> Reacting<V, R, N> for () {
    fn reactions(_: &V, _: &StepMade<V::Scalar, N>) -> Result<impl AsRef<[V::Scalar]>, StepError> {
        Ok([])
    }
}

impl<V: Constrained<N, M>, const N: usize, const M: usize> Holding<V, N> for [V::Scalar; M] {
    fn nearest(
        system: &V,
        q: SVector<V::Scalar, N>,
        v: SVector<V::Scalar, N>,
    ) -> Result<State<V::Scalar, N>, StepError> {
        State::nearest(system, q, v)
    }
}

impl<V, R, const N: usize, const M: usize> Reacting<V, R, N> for [V::Scalar; M]
where
    V: Linearizable<R, N> + ClosedForm<R, N> + Discrete<R, N>,
    V: Constrained<N, M> + Fused<R, N, Border = Constraints<M>>,
    R: Default,
{
    fn reactions(system: &V, made: &StepMade<V::Scalar, N>) -> Result<impl AsRef<[V::Scalar]>, StepError> {
        let StepMade { h, state, step } = made;
        system.by(R::default(), *h).reactions::<M>(state, step).map(<[V::Scalar; M]>::from)
    }
}
