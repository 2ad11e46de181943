//! Derivatives of steps by what a system lists, and of runs, which are their products.

use dalembert::nalgebra::SVector;
use dalembert::step::PhaseMatrix;
use dalembert_face::{Column, by_state};

/// How a state of a run follows its start and the parameters.
#[derive(Clone, Debug)]
pub struct Dependence<const N: usize> {
    /// ∂(q, p)/∂(q0, p0).
    pub by_start: PhaseMatrix<f64, N>,
    /// ∂(q, p)/∂θ, (q0, p0) being held.
    pub by_parameters: Vec<Column<f64, N>>,
}

impl<const N: usize> Dependence<N> {
    /// The dependence of the start itself, with so many parameters.
    #[must_use]
    pub fn none(parameters: usize) -> Self {
        let zero = SVector::zeros();
        Self { by_start: PhaseMatrix::identity(), by_parameters: vec![[zero, zero]; parameters] }
    }

    /// After a step with the derivatives A and ∂(q1, p1)/∂θ.
    pub fn follow(&mut self, a: &PhaseMatrix<f64, N>, step: &[Column<f64, N>]) {
        self.by_start = *a * self.by_start;
        for ([q, p], [by_q, by_p]) in self.by_parameters.iter_mut().zip(step) {
            (*q, *p) = (a.q_by_q * *q + a.q_by_p * *p + by_q, a.p_by_q * *q + a.p_by_p * *p + by_p);
        }
    }
}

/// A = ∂(q1, p1)/∂(q0, p0), row by row.
#[must_use]
pub fn matrix_rows<const N: usize>(a: &PhaseMatrix<f64, N>) -> Vec<f64> {
    column_rows(by_state(a).as_flattened())
}

/// Columns as the rows of a matrix with 2N of them.
#[must_use]
pub fn column_rows<const N: usize>(columns: &[Column<f64, N>]) -> Vec<f64> {
    let of_q = (0..N).flat_map(|i| columns.iter().map(move |[q, _]| q[i]));
    of_q.chain((0..N).flat_map(|i| columns.iter().map(move |[_, p]| p[i]))).collect()
}
