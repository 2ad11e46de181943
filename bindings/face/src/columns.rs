//! Derivatives of a step by the state, by the input and by the listed parameters.

use dalembert::StepError;
use dalembert::nalgebra::SVector;
use dalembert::step::{DiscreteDriven, DiscreteParameters, Linearizable, PhaseMatrix, StateBy, StepTaken};
use dalembert::system::Scalar;

/// Derivatives of a step by one number: ∂q1 and ∂p1.
pub type Column<S, const N: usize> = [SVector<S, N>; 2];

/// The columns of A = ∂(q1, p1)/∂(q0, p0): the derivatives by each entry of q0, and by each of p0.
pub fn by_state<S: Scalar, const N: usize>(a: &PhaseMatrix<S, N>) -> [[Column<S, N>; N]; 2] {
    let PhaseMatrix { q_by_q, q_by_p, p_by_q, p_by_p } = *a;
    [StateBy { q: q_by_q, p: p_by_q }, StateBy { q: q_by_p, p: p_by_p }].map(|by| each(&by))
}

/// The type of an input, by which steps of V by the rule R are differentiated.
pub trait ByInput<V: Linearizable<R, N>, R, const N: usize> {
    /// The derivatives by each entry of u.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn columns(taken: &StepTaken<'_, V, R, N>) -> Result<impl AsRef<[Column<V::Scalar, N>]>, StepError>;
}

/// The type of the listed parameters, by which steps of V by the rule R are differentiated.
pub trait ByParameters<V: Linearizable<R, N>, R, const N: usize> {
    /// The derivatives by each parameter.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn columns(taken: &StepTaken<'_, V, R, N>) -> Result<impl AsRef<[Column<V::Scalar, N>]>, StepError>;
}

impl<V: Linearizable<R, N>, R, const N: usize> ByInput<V, R, N> for () {
    fn columns(_: &StepTaken<'_, V, R, N>) -> Result<impl AsRef<[Column<V::Scalar, N>]>, StepError> {
        Ok([])
    }
}

impl<V: Linearizable<R, N>, R, const N: usize> ByParameters<V, R, N> for () {
    fn columns(_: &StepTaken<'_, V, R, N>) -> Result<impl AsRef<[Column<V::Scalar, N>]>, StepError> {
        Ok([])
    }
}

impl<V, R, const N: usize, const M: usize> ByInput<V, R, N> for [V::Scalar; M]
where
    V: Linearizable<R, N> + DiscreteDriven<R, N, M>,
{
    fn columns(taken: &StepTaken<'_, V, R, N>) -> Result<impl AsRef<[Column<V::Scalar, N>]>, StepError> {
        taken.by_input::<M>().map(|by| each(&by))
    }
}

impl<V, R, const N: usize, const P: usize> ByParameters<V, R, N> for [&'static str; P]
where
    V: Linearizable<R, N> + DiscreteParameters<R, N, P>,
{
    fn columns(taken: &StepTaken<'_, V, R, N>) -> Result<impl AsRef<[Column<V::Scalar, N>]>, StepError> {
        taken.by_parameters::<P>().map(|by| each(&by))
    }
}

fn each<S: Scalar, const N: usize, const K: usize>(by: &StateBy<S, N, K>) -> [Column<S, N>; K] {
    // Of arrays: an index that nothing shows to be within bounds would bring a panic into the step.
    let mut columns = [[SVector::zeros(); 2]; K];
    for ((column, q), p) in columns.iter_mut().zip(&by.q.data.0).zip(&by.p.data.0) {
        *column = [SVector::from(*q), SVector::from(*p)];
    }
    columns
}
