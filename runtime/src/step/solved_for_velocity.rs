//! The flow of rules whose step is one equation for v̄.

use nalgebra::SVector;

use crate::step::{
    Border, BoundedFlow, BoundedStep, ByFormula, ClosedForm, Discrete, Flow, LinearizedStep, Segment, State,
    Step, StepError, of_equation_and_step, step_matrix, verify_momenta,
};
use crate::system::GeneratedDiffers;

/// A rule whose step is solved for v̄ itself, by the [`step_kernel`](crate::rules::Fused::step_kernel) and
/// [`momenta`](crate::rules::Fused::momenta) that its systems have.
///
/// A rule of one's own states it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` steps no system as it stands",
    label = "how its step is solved is not known",
    note = "nodes and weights of your own, `impl DisplacementRule`, step every system as `Quadrature(rule)`",
    note = "a rule whose systems implement `Fused` and `ClosedForm` states it: `impl dalembert::rules::SolvedForVelocity for {Self} {{}}`"
)]
pub trait SolvedForVelocity {
    /// [`Flow::TAKES_MASSLESS`]: p1 = 0 follows from p0 = 0 in a coordinate without mass.
    const TAKES_MASSLESS: bool = false;
}

impl<R: SolvedForVelocity> ByFormula for R {}

impl<L, R, const N: usize> Flow<R, N> for L
where
    R: SolvedForVelocity,
    L: ClosedForm<R, N> + ?Sized,
{
    type RunMemory = L::Memory;

    const TAKES_MASSLESS: bool = R::TAKES_MASSLESS;

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
        let step = <L::Border as Border<L, R, N>>::step(self, state, h, guess);
        if cfg!(debug_assertions)
            && let Ok(step) = &step
        {
            self.verify_segment(&Segment { q0: state.q, v: step.velocity, h })?;
        }
        step
    }

    fn linearized_step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<LinearizedStep<L::Scalar, N>, StepError> {
        let step = self.step(state, h, guess)?;
        Ok((step, step_matrix::<L, R, N>(self, state, &step, h)?))
    }

    fn verify_momenta(&self, state: &State<L::Scalar, N>, h: L::Scalar) -> Result<(), GeneratedDiffers> {
        verify_momenta::<L, R, N>(self, state, h, &|segment| of_equation_and_step(self, segment))
    }
}

impl<L, R, const N: usize> BoundedFlow<R, N> for L
where
    R: SolvedForVelocity,
    L: ClosedForm<R, N> + ?Sized,
{
    fn step_within(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        let bounded = <L::Border as Border<L, R, N>>::step_within(self, state, h, guess, iterations);
        if cfg!(debug_assertions)
            && let Ok(bounded) = &bounded
        {
            self.verify_segment(&Segment { q0: state.q, v: bounded.step.velocity, h })?;
        }
        bounded
    }
}
