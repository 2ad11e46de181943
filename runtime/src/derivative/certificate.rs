//! The certificate of a step that was taken: how well its equation was posed, and on which branch its root
//! lies.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Scalar, linear};
use crate::step::{Discrete, Discretised, EquationAt, State, Step, StepError};

/// Condition, remaining correction and branch of a step, by its Newton matrix ∂p0/∂v̄; see
/// [`Discretised::certificate`](crate::Discretised::certificate).
///
/// **When to worry.** The step finds v̄ from p0, and rounding of p0 reaches v̄ enlarged by up to the
/// condition number: with `condition` = 10^d some d of the digits of v̄ may be lost, out of 16 in `f64` and 7
/// in `f32`. Up to 1/√ε (7e7 in `f64`, 3e3 in `f32`) at least half of them are left: nothing to do. Above,
/// look for a fold close by (step size, negative damping), for a mass that is nearly singular, or for
/// stiffness far beyond the step, where only some directions lose digits; a shorter step tells them apart: it
/// brings the condition down to that of the mass matrix. From 1/ε on (5e15, 8e6) no digit is sure, and a step
/// is liable to end with [`StepError::SingularNewtonMatrix`]. With one coordinate there is nothing to
/// compare: the number is 1, also near a fold.
///
/// For [`Gauss`](crate::Gauss) it is the matrix with the stages eliminated, not that of all stages which its
/// solver factors: the same question of p0 and v̄.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Certificate<S> {
    /// Condition number of the Newton matrix, ‖DAD‖₁ ‖(DAD)⁻¹‖₁ with D = diag(1/√|Mᵢᵢ|), M = ∂²L/∂v² (1 for
    /// an entry that is 0): momenta and velocities in units in which every coordinate has mass 1, so
    /// that no unit of q, t or m changes it. Infinite where the matrix is singular.
    pub condition: S,
    /// The Newton correction still to be made, in the same units, as a share of v̄: the relative error of v̄,
    /// but for rounding.
    pub correction: S,
    /// Whether the determinant of the step's equations has the sign that it has for small h. Otherwise an
    /// odd number of folds lies between this step and those of small h: the root belongs to another
    /// branch than the flow, as with negative damping past hr = −2m. The equations are p0(v̄) = p0, with
    /// det ∂p0/∂v̄ against det ∂²L/∂v², with friction in its place in coordinates without mass; those of all
    /// stages for [`Gauss`](crate::Gauss), where det ∂p0/∂v̄ changes sign through infinity at conjugate
    /// points, past which a step is as good as before.
    pub on_the_branch_of_the_flow: bool,
}

impl<S: Scalar> Certificate<S> {
    /// [`Discretised::certificate`](crate::Discretised::certificate).
    pub(crate) fn of<L, R, const N: usize>(
        system: &L,
        state: &State<S, N>,
        step: &Step<S, N>,
        h: S,
    ) -> Result<Self, StepError>
    where
        L: Discrete<R, N, Scalar = S>,
    {
        let EquationAt { p0, matrix, mass, on_the_branch_of_the_flow } =
            system.equation_at(state, step, h)?;
        let unit = SVector::<S, N>::from_fn(|i, _| {
            let inertia = mass[(i, i)].abs();
            if inertia > S::zero() { S::one() / inertia.sqrt() } else { S::one() }
        });
        let scaled = SMatrix::<S, N, N>::from_fn(|i, j| matrix[(i, j)] * unit[i] * unit[j]);
        let infinite = S::one() / S::zero();
        let (condition, correction) = match linear::inverse(&scaled) {
            Ok(inverse) => {
                let residual = (p0 - state.p).component_mul(&unit);
                (norm(&scaled) * norm(&inverse), (inverse * residual).norm())
            }
            Err(_) => (infinite, infinite),
        };
        let size = step.velocity.component_div(&unit).norm();
        Ok(Self {
            condition,
            correction: if correction == S::zero() { correction } else { correction / size },
            on_the_branch_of_the_flow,
        })
    }
}

/// The 1-norm: the largest column sum.
fn norm<S: Scalar, const N: usize>(matrix: &SMatrix<S, N, N>) -> S {
    (0..N).fold(S::zero(), |largest, j| {
        largest.max((0..N).fold(S::zero(), |sum, i| sum + matrix[(i, j)].abs()))
    })
}

/// Certificates.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// How well the equation of a step that was taken from `state` was posed, and on which branch its root
    /// lies.
    ///
    /// Costs one evaluation and the inverse of an N×N matrix, twice a Newton iteration or less; a step itself
    /// never asks for it.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn spring(q: [f64; 2], v: [f64; 2], k: f64) -> f64 {
    ///     0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (q[1] - q[0]).powi(2)
    /// }
    /// let state = State { q: vector![0.0, 1.0], p: vector![0.2, -0.3] };
    /// let system = Spring { k: 4e6 };
    /// let by = system.by(Midpoint, 1.0);
    /// // I + (h²k/4) [1 −1; −1 1]: the stretch is a million times as stiff as the mass.
    /// let condition = by.certificate(&state, &by.step(&state)?)?.condition;
    /// assert!((condition / 2e6 - 1.0).abs() < 1e-6);
    ///
    /// #[rayleigh_system]
    /// fn accelerated(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] - 0.0 * q[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let state = State { q: vector![0.0], p: vector![1.0] };
    /// let past_the_fold = |r: f64| {
    ///     let system = Accelerated { r };
    ///     let by = system.by(Midpoint, 1.0);
    ///     !by.certificate(&state, &by.step(&state).unwrap()).unwrap().on_the_branch_of_the_flow
    /// };
    /// assert!(!past_the_fold(-1.9) && past_the_fold(-2.1));
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if derivatives at the step are not finite; those of a step of
    /// [`Gauss`](crate::Gauss), which solves for its stages again.
    pub fn certificate(
        &self,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
    ) -> Result<Certificate<L::Scalar>, StepError> {
        Certificate::of(self.system, state, step, self.h)
    }
}
