//! What can be asked of a step after it was taken: how well its equation was posed, and on which branch its root lies.

use nalgebra::{SMatrix, SVector};

use crate::linear::NewtonMatrix;
use crate::{Discrete, Scalar, State, Step, StepError};

/// What a step's Newton matrix says of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Certificate<S> {
    /// Condition number of the Newton matrix in the 1-norm, with velocities in units of 1/√|Mᵢᵢ|, M = ∂²L/∂v²: so many digits, log₁₀,
    /// may be lost in v̄. Infinite where the matrix is singular.
    pub condition: S,
    /// The Newton correction still to be made, in the same units, as a share of v̄: the relative error of v̄, but for rounding.
    pub correction: S,
    /// Whether det ∂p0/∂v̄ has the sign of det ∂²L/∂v². Otherwise an odd number of folds lies between this step and those of small h: the
    /// root belongs to another branch than the flow, as with negative damping past hr = −2m.
    pub on_the_branch_of_the_flow: bool,
}

impl<S: Scalar> Certificate<S> {
    /// Of a step taken from `state` with step size `h`. Costs N + 2 solves; a step itself never asks for it.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Certificate, Discrete, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn accelerated(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] - 0.0 * q[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let state = State { q: vector![0.0], p: vector![1.0] };
    /// let past_the_fold = |r: f64| {
    ///     let system = Accelerated { r };
    ///     let step = system.step(&state, 1.0, None).unwrap();
    ///     !Certificate::of_step(&system, Midpoint, &state, &step, 1.0).unwrap().on_the_branch_of_the_flow
    /// };
    /// assert!(!past_the_fold(-1.9) && past_the_fold(-2.1));
    /// ```
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if derivatives at the step are not finite.
    pub fn of_step<L, R, const N: usize>(
        system: &L,
        _rule: R,
        state: &State<S, N>,
        step: &Step<S, N>,
        h: S,
    ) -> Result<Self, StepError>
    where
        L: Discrete<R, N, Scalar = S>,
    {
        let kernel = system.step_kernel(&state.q, &step.velocity, h);
        let mass = system.lagrangian_derivatives(&state.q, &step.velocity).d22;
        StepError::require_finite(&kernel.p0, crate::Quantity::Derivatives)?;
        let matrix = kernel.matrix.dense();
        let unit = SVector::<S, N>::from_fn(|i, _| S::one() / mass[(i, i)].abs().sqrt());
        let scaled = SMatrix::<S, N, N>::from_fn(|i, j| matrix[(i, j)] * unit[i] * unit[j]);
        let norm = |column: &SVector<S, N>| column.iter().fold(S::zero(), |sum, entry| sum + entry.abs());
        let (mut largest, mut inverse) = (S::zero(), S::zero());
        let mut singular = false;
        for j in 0..N {
            let column = SVector::from_fn(|i, _| scaled[(i, j)]);
            largest = largest.max(norm(&column));
            let mut basis: SVector<S, N> = nalgebra::zero();
            basis[j] = S::one() / unit[j];
            match kernel.matrix.solve(&basis) {
                // D⁻¹A⁻¹D⁻¹e, D = diag(unit).
                Ok(x) => inverse = inverse.max(norm(&x.component_div(&unit))),
                Err(_) => singular = true,
            }
        }
        let length = |v: &SVector<S, N>| v.component_div(&unit).norm();
        let correction =
            kernel.matrix.solve(&(kernel.p0 - state.p)).map_or(S::one() / S::zero(), |c| length(&c));
        let size = length(&step.velocity);
        Ok(Self {
            condition: if singular { S::one() / S::zero() } else { largest * inverse },
            correction: if correction == S::zero() { correction } else { correction / size },
            on_the_branch_of_the_flow: has_positive_determinant(matrix) == has_positive_determinant(mass),
        })
    }
}

/// The sign of the determinant, by elimination with row exchanges.
fn has_positive_determinant<S: Scalar, const N: usize>(mut a: SMatrix<S, N, N>) -> bool {
    let mut positive = true;
    for k in 0..N {
        let mut pivot = k;
        for i in k + 1..N {
            if a[(i, k)].abs() > a[(pivot, k)].abs() {
                pivot = i;
            }
        }
        if pivot != k {
            a.swap_rows(k, pivot);
            positive = !positive;
        }
        if a[(k, k)] < S::zero() {
            positive = !positive;
        }
        if a[(k, k)] == S::zero() {
            continue;
        }
        for i in k + 1..N {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k..N {
                let upper = a[(k, j)];
                a[(i, j)] -= factor * upper;
            }
        }
    }
    positive
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::matrix;

    #[test]
    fn signs_of_determinants() {
        assert!(has_positive_determinant(matrix![2.0, 1.0; 1.0, 2.0]));
        assert!(!has_positive_determinant(matrix![1.0, 2.0; 2.0, 1.0]));
        assert!(!has_positive_determinant(matrix![0.0, 1.0; 1.0, 0.0]));
        assert!(has_positive_determinant(matrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 1.0, 0.0, 0.0]));
    }
}
