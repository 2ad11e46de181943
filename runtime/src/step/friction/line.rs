//! A line of the step with friction, linearised: what sticks in it is a border of its matrix.

use nalgebra::SMatrix;

use crate::numbers::{Scalar, linear::by_columns};
use crate::step::constraints::{complement::Complement, independent::Independent};
use crate::step::{StepError, invert};

/// A line of the step with what sticks in it: an equation X dx + D ds = …, rows dx = ….
pub(super) struct Line<S: Scalar, const N: usize, const M: usize> {
    pub(super) inverse: SMatrix<S, N, N>,
    pub(super) rows: SMatrix<S, M, N>,
    answers: SMatrix<S, N, M>,
    pub(super) complement: Complement<S, M>,
    sticks: [bool; M],
}

impl<S: Scalar, const N: usize, const M: usize> Line<S, N, M> {
    pub(super) fn of(
        matrix: &SMatrix<S, N, N>,
        directions: &SMatrix<S, N, M>,
        rows: &SMatrix<S, M, N>,
        sticks: &[bool; M],
    ) -> Result<Self, StepError> {
        let inverse = invert(matrix)?;
        let (mut directions, mut rows) = (*directions, *rows);
        let mut beside = SMatrix::<S, M, M>::zeros();
        let columns = directions.data.0.iter_mut().zip(&mut beside.data.0).zip(sticks).enumerate();
        for (k, ((direction, beside), _)) in columns.filter(|(_, (_, stick))| !**stick) {
            direction.fill(S::zero());
            beside.iter_mut().skip(k).take(1).for_each(|entry| *entry = S::one());
        }
        leave(&mut rows, sticks);
        let answers = inverse * directions;
        let complement =
            Complement::of(&(rows * answers + beside), || Independent::of(&rows, &directions, &answers))
                .ok_or(StepError::SingularNewtonMatrix { iteration: 0, column: 0 })?;
        Ok(Self { inverse, rows, answers, complement, sticks: *sticks })
    }

    /// The rows of what sticks.
    pub(super) fn left<const K: usize>(&self, of: &SMatrix<S, M, K>) -> SMatrix<S, M, K> {
        let mut left = *of;
        leave(&mut left, &self.sticks);
        left
    }

    /// x of X x + D s = `right`, rows x = `slip`.
    pub(super) fn solve<const K: usize>(
        &self,
        right: &SMatrix<S, N, K>,
        slip: &SMatrix<S, M, K>,
    ) -> SMatrix<S, N, K> {
        let free = self.inverse * right;
        let left = self.rows * free - slip;
        free - self.answers * by_columns(&left, |left| self.complement.solve(left))
    }
}

/// Leaves the rows of what sticks.
pub(super) fn leave<S: Scalar, const K: usize, const M: usize>(
    rows: &mut SMatrix<S, M, K>,
    sticks: &[bool; M],
) {
    for column in &mut rows.data.0 {
        let slides = column.iter_mut().zip(sticks).filter(|(_, stick)| !**stick);
        slides.for_each(|(entry, _)| *entry = S::zero());
    }
}
