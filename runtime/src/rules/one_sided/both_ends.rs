//! The step with its end: solved for v̄ without it, then for v1 once.

use super::end::End;
use super::{OneSided, without_end};
use crate::step::{Ending, Free, Momenta, Segment, State, Step, StepError};
use crate::system::{ActingForce, Rayleigh};

/// The border of steps by [`OneSided`]: the end of a step is an equation for v1 by itself, which may fail.
pub type BothEnds = Free<EquationAtEnd>;

/// Ends of steps by an equation for v1: that for v̄ asks no end of a segment on the way.
#[derive(Clone, Copy, Debug)]
pub struct EquationAtEnd;

impl<L, const N: usize> Ending<L, OneSided, N> for EquationAtEnd
where
    L: Rayleigh<N> + ActingForce<N>,
{
    const IS_OF_EQUATION: bool = false;

    /// p0, and w in place of p1.
    fn momenta(system: &L, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        without_end(system, segment)
    }

    fn ended(
        system: &L,
        state: &State<L::Scalar, N>,
        step: Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let segment = Segment { q0: state.q, v: step.velocity, h };
        let end = End::of(system, &segment);
        let p = end.momentum(&end.velocity(&step.state.p)?);
        let state = State { q: step.state.q, p };
        state.require_reached()?;
        Ok(Step { state, ..step })
    }
}
