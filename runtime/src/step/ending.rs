//! Ends of steps whose equation is solved for v̄.

use crate::step::{Fused, Momenta, Segment, State, Step, StepError};
use crate::system::Lagrangian;

/// The end of a step whose equation is solved for v̄.
pub trait Ending<L: Lagrangian<N> + ?Sized, R, const N: usize> {
    /// Whether the momenta of the equation are those of the step.
    const IS_OF_EQUATION: bool;

    /// p0, and what the equation has for p1.
    fn momenta(system: &L, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N>;

    /// The step of size h from `state` that was solved for.
    ///
    /// # Errors
    /// Those of the end.
    fn ended(
        system: &L,
        state: &State<L::Scalar, N>,
        step: Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError>;
}

/// Ends of steps by a formula for p1: D2 L_d + f_d⁺.
#[derive(Clone, Copy, Debug)]
pub struct OfFormula;

impl<L, R, const N: usize> Ending<L, R, N> for OfFormula
where
    L: Fused<R, N> + ?Sized,
{
    const IS_OF_EQUATION: bool = true;

    #[inline]
    fn momenta(system: &L, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        Fused::<R, N>::momenta(system, segment)
    }

    #[inline(always)]
    fn ended(
        _: &L,
        _: &State<L::Scalar, N>,
        step: Step<L::Scalar, N>,
        _: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        Ok(step)
    }
}
