//! The start of a run: whether the system is the one written.

use nalgebra::SVector;

use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::{State, StepError};
use crate::system::{
    Lagrangian, derivatives_apart,
    verification::{around, has_two_values, slopes_around},
};

impl<S: Scalar, const N: usize> State<S, N> {
    /// Verifies that the derivatives of `system` belong to its functions as written
    /// ([`verification`](crate::system::verification)): values and slopes, here and farther away.
    ///
    /// With the standard library every run does so before its first step; on core alone a program calls it
    /// where it has the time.
    ///
    /// ```
    /// use dalembert::{State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    /// }
    ///
    /// let system = Oscillator { k: 4.0 };
    /// let start = State::from_velocity(&system, [0.3], [0.0])?;
    /// start.verify(&system)?;
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::GeneratedDiffers`].
    #[cold]
    #[inline(never)]
    pub fn verify<L: Lagrangian<N, Scalar = S>>(&self, system: &L) -> Result<(), StepError> {
        if !has_two_values(L::STRUCTURE.engine) {
            return Ok(());
        }
        let v = velocity(system, self);
        around(system, &self.q, &v)?;
        Ok(slopes_around(system, &self.q, &v)?)
    }
}

/// Verifies a system where a run starts, `elapsed` after its own time: values, and `with_slopes` slopes too,
/// where there is the standard library.
#[cold]
#[inline(never)]
pub(crate) fn verify_start<L: Lagrangian<N>, const N: usize>(
    system: &L,
    elapsed: f64,
    state: &State<L::Scalar, N>,
    with_slopes: bool,
) -> Result<(), StepError> {
    if !has_two_values(L::STRUCTURE.engine) {
        return Ok(());
    }
    system.later(L::Scalar::constant(elapsed), |system| {
        if cfg!(feature = "std") && with_slopes {
            return state.verify(system);
        }
        Ok(around(system, &state.q, &velocity(system, state))?)
    })
}

/// The velocity of a state, by one Newton iteration for ∂L/∂v(q, v) = p from rest: exact where L is quadratic
/// in v, and a point as good as any elsewhere.
fn velocity<L: Lagrangian<N>, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> SVector<L::Scalar, N> {
    let rest = SVector::zeros();
    let l = derivatives_apart(system, &state.q, &rest);
    l.d22.solve(&(state.p - l.d2)).unwrap_or(rest)
}
