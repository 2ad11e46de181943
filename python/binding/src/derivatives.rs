//! Derivatives of steps by what a system lists, and of runs, which are their products.

use dalembert::StepError;
use dalembert::nalgebra::SVector;
use dalembert::step::{DiscreteDriven, DiscreteParameters, Linearizable, PhaseMatrix, StateBy, StepTaken};

/// A system without an input.
pub enum NoInput {}

/// A system with an input u ∈ ℝᵁ.
pub enum Input<const U: usize> {}

/// A system that lists no parameters.
pub enum NoParameters {}

/// A system that lists P parameters.
pub enum Parameters<const P: usize> {}

/// The derivatives (∂q1, ∂p1) of a step by each of some quantities.
pub type ColumnsOf<const N: usize> = Vec<(SVector<f64, N>, SVector<f64, N>)>;

/// The quantities by which the steps of V by M are differentiated.
pub trait Columns<V: Linearizable<M, N>, M, const N: usize> {
    /// The derivatives by each of them.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn columns(taken: &StepTaken<'_, V, M, N>) -> Result<ColumnsOf<N>, StepError>;
}

impl<V: Linearizable<M, N>, M, const N: usize> Columns<V, M, N> for NoInput {
    fn columns(_: &StepTaken<'_, V, M, N>) -> Result<ColumnsOf<N>, StepError> {
        Ok(Vec::new())
    }
}

impl<V: Linearizable<M, N>, M, const N: usize> Columns<V, M, N> for NoParameters {
    fn columns(_: &StepTaken<'_, V, M, N>) -> Result<ColumnsOf<N>, StepError> {
        Ok(Vec::new())
    }
}

impl<V, M, const N: usize, const U: usize> Columns<V, M, N> for Input<U>
where
    V: Linearizable<M, N, Scalar = f64> + DiscreteDriven<M, N, U>,
{
    fn columns(taken: &StepTaken<'_, V, M, N>) -> Result<ColumnsOf<N>, StepError> {
        taken.by_input::<U>().map(|by| columns(&by))
    }
}

impl<V, M, const N: usize, const P: usize> Columns<V, M, N> for Parameters<P>
where
    V: Linearizable<M, N, Scalar = f64> + DiscreteParameters<M, N, P>,
{
    fn columns(taken: &StepTaken<'_, V, M, N>) -> Result<ColumnsOf<N>, StepError> {
        taken.by_parameters::<P>().map(|by| columns(&by))
    }
}

fn columns<const N: usize, const K: usize>(by: &StateBy<f64, N, K>) -> ColumnsOf<N> {
    (0..K).map(|k| (by.q.column(k).into_owned(), by.p.column(k).into_owned())).collect()
}

/// How a state of a run follows its start and the parameters.
#[derive(Clone, Debug)]
pub struct Dependence<const N: usize> {
    /// ∂(q, p)/∂(q0, p0).
    pub by_start: PhaseMatrix<f64, N>,
    /// ∂(q, p)/∂θ, (q0, p0) being held.
    pub by_parameters: ColumnsOf<N>,
}

impl<const N: usize> Dependence<N> {
    /// The dependence of the start itself, with so many parameters.
    #[must_use]
    pub fn none(parameters: usize) -> Self {
        let zero = SVector::zeros();
        Self { by_start: PhaseMatrix::identity(), by_parameters: vec![(zero, zero); parameters] }
    }

    /// After a step with the derivatives A and ∂(q1, p1)/∂θ.
    pub fn follow(&mut self, a: &PhaseMatrix<f64, N>, step: &ColumnsOf<N>) {
        self.by_start = *a * self.by_start;
        for ((q, p), (by_q, by_p)) in self.by_parameters.iter_mut().zip(step) {
            (*q, *p) = (a.q_by_q * *q + a.q_by_p * *p + by_q, a.p_by_q * *q + a.p_by_p * *p + by_p);
        }
    }
}

/// A = ∂(q1, p1)/∂(q0, p0), row by row.
#[must_use]
pub fn matrix_rows<const N: usize>(a: &PhaseMatrix<f64, N>) -> Vec<f64> {
    let mut rows = Vec::with_capacity(4 * N * N);
    for (left, right) in [(&a.q_by_q, &a.q_by_p), (&a.p_by_q, &a.p_by_p)] {
        for i in 0..N {
            rows.extend(left.row(i).iter().chain(right.row(i).iter()));
        }
    }
    rows
}

/// Columns as the rows of a matrix with 2N of them.
#[must_use]
pub fn column_rows<const N: usize>(columns: &ColumnsOf<N>) -> Vec<f64> {
    let of_q = (0..N).flat_map(|i| columns.iter().map(move |(q, _)| q[i]));
    of_q.chain((0..N).flat_map(|i| columns.iter().map(move |(_, p)| p[i]))).collect()
}
