//! The flow of rules whose step is one equation for v̄.

use nalgebra::SVector;

use crate::step::cause::cause_of;
use crate::step::{
    BoundedFlow, BoundedStep, Discrete, Flow, Linearization, State, Step, StepError, StepWith,
    newton::Equation, of_equation_and_step, step_by, step_within_by, verify_momenta,
};
use crate::system::{GeneratedDiffers, derivatives_apart};

/// A rule whose step is solved for v̄ itself, by the [`step_kernel`](Discrete::step_kernel) and
/// [`momenta`](Discrete::momenta) that its systems have.
///
/// A rule of one's own states it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` steps no system as it stands",
    label = "how its step is solved is not known",
    note = "nodes and weights of your own, `impl DisplacementRule`, step every system as `Quadrature(rule)`",
    note = "a rule whose systems implement `Discrete` states it: `impl dalembert::rules::SolvedForVelocity for {Self} {{}}`"
)]
pub trait SolvedForVelocity {}

/// A rule whose discrete objects are formulas in (q0, q1): nothing within a segment has to be solved for.
///
/// [`Gauss`](crate::Gauss) rules are not of this kind: their discrete objects are asked of
/// [`segment`](crate::Discretised::segment), which may fail.
///
/// ```compile_fail
/// use dalembert::{Discretise, Gauss, nalgebra::vector, rayleigh_system};
/// #[rayleigh_system(rule = gauss)]
/// fn free(q: [f64; 1], v: [f64; 1]) -> f64 {
///     0.5 * v[0] * v[0] - 0.0 * q[0]
/// }
/// let _ = Free {}.by(Gauss::<2>, 0.1).discrete_lagrangian(&vector![0.0], &vector![0.1]);
/// ```
#[diagnostic::on_unimplemented(
    message = "the discrete objects by `{Self}` have to be solved for",
    label = "no formula in (q0, q1)",
    note = "ask the segment for them, which may have no solution: `by.segment(&q0, &q1)?`"
)]
pub trait ClosedForm {}

impl<R: SolvedForVelocity> ClosedForm for R {}

impl<L, R, const N: usize> Flow<R, N> for L
where
    R: SolvedForVelocity,
    L: Discrete<R, N> + ?Sized,
{
    type RunMemory = L::Memory;

    /// By Newton's method. Without a guess it starts at the velocity of the state, and ∂²L/∂v² is checked to
    /// be invertible; where that leads nowhere, it starts again at rest, away from it if rest is a singular
    /// point, and at last follows the root from small step sizes. h may be negative. Neither allocates nor
    /// panics (unless L, R or f do), and takes at most a fixed number of iterations.
    #[inline]
    fn step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let equation = (
            |q0: &_, v: &_, h| self.step_kernel(q0, v, h),
            |q0: &_, v: &_, h| self.momenta(q0, v, h),
            |q0: &_, v: &_| derivatives_apart(self, q0, v).d22,
            |q0: &_, v: &_, h| self.cancelling_terms(q0, v, h),
            |q0: &_, v: &_, h| cause_of(self, self.without_derivative_on(q0, v, h)),
        );
        let step = step_by(self, kind::<L, R, N>(), equation, state, h, guess);
        if cfg!(debug_assertions)
            && let Ok(step) = &step
        {
            self.verify_segment(&state.q, &step.velocity, h)?;
        }
        step
    }

    fn linearized_step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<StepWith<L::Scalar, N, Linearization<L::Scalar, N>>, StepError> {
        let step = self.step(state, h, guess)?;
        Ok((step, self.linearization(&state.q, &step.state.q, h)?))
    }

    fn verify_momenta(&self, state: &State<L::Scalar, N>, h: L::Scalar) -> Result<(), GeneratedDiffers> {
        verify_momenta::<L, R, N>(self, state, h, &|q0, v| of_equation_and_step(self, q0, v, h))
    }
}

impl<L, R, const N: usize> BoundedFlow<R, N> for L
where
    R: SolvedForVelocity,
    L: Discrete<R, N> + ?Sized,
{
    fn step_within(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        let bounded = step_within_by(
            self,
            kind::<L, R, N>(),
            (
                |q0: &_, v: &_| self.step_kernel(q0, v, h),
                |q0: &_, v: &_| self.momenta(q0, v, h),
                |q0: &_, v: &_| cause_of(self, self.without_derivative_on(q0, v, h)),
            ),
            state,
            h,
            guess,
            iterations,
        );
        if cfg!(debug_assertions)
            && let Ok(bounded) = &bounded
        {
            self.verify_segment(&state.q, &bounded.step.velocity, h)?;
        }
        bounded
    }
}

/// Whether one correction solves the step's equation.
const fn kind<L: Discrete<R, N> + ?Sized, R, const N: usize>() -> Equation {
    if L::LINEAR { Equation::Linear } else { Equation::General }
}
