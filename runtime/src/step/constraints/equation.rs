//! The equation of a step on constraints, for v̄ alone.

use core::cell::{Cell, RefCell};

use nalgebra::{SMatrix, SVector};

use super::bordered::Bordered;
use super::nearest::{dependent, require_on, tangent};
use crate::numbers::{Factored, NewtonMatrix};
use crate::step::equation::{OfRule, StepEquation};
use crate::step::{ClosedForm, Discrete, Fused, Momenta, Segment, State, Step, StepError, StepKernel};
use crate::system::{Constrained, Lagrangian};

/// The equation F(v̄) = 0 of a step on constraints from a state (q0, p), as p + F(v̄) = p.
pub(super) struct OnConstraints<'a, L, R, const N: usize, const M: usize>
where
    L: ClosedForm<R, N>,
{
    system: &'a L,
    free: OfRule<'a, L, R>,
    state: &'a State<L::Scalar, N>,
    /// G(q0)ᵀ, the directions of the reactions.
    directions: SMatrix<L::Scalar, N, M>,
    /// Whether momenta take W and S of the last kernel: of the quick method, to which the equation is all.
    is_frozen: Cell<bool>,
    /// At the v̄ at which the kernel was asked for last.
    last: RefCell<Option<Solved<L, R, N, M>>>,
}

/// W, made ready to solve with, and its border.
type Solved<L, R, const N: usize, const M: usize> = (
    <<L as Fused<R, N>>::Matrix as NewtonMatrix<<L as Lagrangian<N>>::Scalar, N>>::Factored,
    Bordered<<L as Lagrangian<N>>::Scalar, N, M>,
);

impl<'a, L, R, const N: usize, const M: usize> OnConstraints<'a, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + Constrained<N, M>,
{
    /// # Errors
    /// [`StepError::OffConstraint`] of a state that is off a constraint.
    pub(super) fn new(system: &'a L, state: &'a State<L::Scalar, N>) -> Result<Self, StepError> {
        let (values, gradients) = system.constraint_gradients(&state.q);
        require_on(&values, &gradients, &state.q)?;
        let (free, directions, last) = (OfRule::new(system), gradients.transpose(), RefCell::new(None));
        Ok(Self { system, free, state, directions, is_frozen: Cell::new(true), last })
    }

    /// p0 and W on the segment without the constraints; and W made ready with its border, where no matrix is
    /// singular beyond redundancy.
    #[expect(clippy::type_complexity, reason = "two values that belong together here alone")]
    fn evaluated(
        &self,
        segment: &Segment<L::Scalar, N>,
    ) -> (StepKernel<L::Scalar, N, L::Matrix>, Option<Solved<L, R, N, M>>) {
        let kernel = self.free.kernel(segment);
        // Where rounding is measured, q0 is moved.
        let directions = if segment.q0 == self.state.q {
            self.directions
        } else {
            self.system.constraint_gradients(&segment.q0).1.transpose()
        };
        let solved = kernel.matrix.factored().and_then(|factored| {
            let bordered = Bordered::of(self.system, segment, directions, &factored)?;
            Some((factored, bordered))
        });
        (kernel, solved)
    }

    /// p + F with W and S of this segment, where p0 has this value.
    #[cold]
    #[inline(never)]
    fn compared(&self, segment: &Segment<L::Scalar, N>, p0: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        match self.evaluated(segment).1 {
            Some((factored, bordered)) => self.state.p + bordered.residual(&factored, &(p0 - self.state.p)),
            None => *p0,
        }
    }

    /// κ = (h/2)λ on the segment of a step.
    pub(super) fn multipliers(&self, segment: &Segment<L::Scalar, N>) -> Option<SVector<L::Scalar, M>> {
        let (kernel, solved) = self.evaluated(segment);
        let (factored, bordered) = solved?;
        Some(bordered.multipliers(&factored, &(kernel.p0 - self.state.p)))
    }

    /// The step with its momentum on N: G(q1)·v(q1, p1) = 0.
    pub(super) fn on_constraints(
        &self,
        step: Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let reached = self.system.later(h, |system| tangent::<L, N, M>(system, &step.state));
        let state = reached.map_err(|error| self.lost(error, &step))?;
        state.require_reached()?;
        Ok(Step { state, ..step })
    }

    /// The error of a step whose end is off a constraint: constraints that seemed redundant contradict one
    /// another, or the equation has no root in reach.
    #[cold]
    #[inline(never)]
    fn lost(&self, error: StepError, step: &Step<L::Scalar, N>) -> StepError {
        let is_deficient = self
            .last
            .try_borrow()
            .is_ok_and(|last| last.as_ref().is_some_and(|(_, last)| last.is_deficient()));
        match error {
            StepError::OffConstraint { constraint, .. } if is_deficient => {
                StepError::DependentConstraints { constraint }
            }
            StepError::OffConstraint { value, .. } => {
                StepError::NoRealSolution { iteration: step.report.iterations, residual: value.abs() }
            }
            other => other,
        }
    }

    /// The error of a step, by the constraints where these are its cause.
    #[cold]
    #[inline(never)]
    pub(super) fn explained(&self, error: StepError) -> StepError {
        match error {
            StepError::SingularNewtonMatrix { .. } | StepError::NoRealSolution { .. } => {
                match dependent::<L, N, M>(self.system, &self.state.q) {
                    Some(constraint) => StepError::DependentConstraints { constraint },
                    None => error,
                }
            }
            other => other,
        }
    }
}

impl<L, R, const N: usize, const M: usize> StepEquation<L::Scalar, N> for OnConstraints<'_, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + Constrained<N, M>,
{
    type Matrix = L::Matrix;

    fn kernel(&self, segment: &Segment<L::Scalar, N>) -> StepKernel<L::Scalar, N, L::Matrix> {
        let (StepKernel { p0, matrix }, solved) = self.evaluated(segment);
        let kernel = match &solved {
            Some((factored, bordered)) => {
                let p = self.state.p;
                StepKernel { p0: p + bordered.residual(factored, &(p0 - p)), matrix }
            }
            // Singular itself, or the complement is: what is solved with it says so.
            None if matrix.factored().is_none() => StepKernel { p0, matrix },
            None => StepKernel { p0, matrix: NewtonMatrix::zero() },
        };
        if let Ok(mut last) = self.last.try_borrow_mut() {
            *last = solved;
        }
        kernel
    }

    fn compare(&self) {
        self.is_frozen.set(false);
    }

    /// F with W and S of the last kernel, whose roots are those of F; where values are compared, F itself.
    fn momenta(&self, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        let Momenta { p0, p1 } = self.free.momenta(segment);
        if !self.is_frozen.get() {
            return Momenta { p0: self.compared(segment, &p0), p1 };
        }
        match self.last.try_borrow().as_deref() {
            Ok(Some((factored, bordered))) => {
                let p = self.state.p;
                Momenta { p0: p + bordered.residual_near(self.system, segment, factored, p0 - p), p1 }
            }
            _ => Momenta { p0, p1 },
        }
    }

    fn correction(&self, residual: &SVector<L::Scalar, N>) -> Option<SVector<L::Scalar, N>> {
        let last = self.last.try_borrow().ok()?;
        last.as_ref().map(|(factored, _)| factored.solve(residual))
    }

    fn inertia(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.free.inertia(q, v)
    }

    /// Terms of L, R and f, and of the reactions: all that cancels where a system hangs at rest.
    fn cancelling(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        let left = self.free.momenta(segment).p0 - self.state.p;
        self.free.cancelling(segment) + (left + left).abs()
    }

    fn cause(&self, segment: &Segment<L::Scalar, N>) -> Option<StepError> {
        self.free.cause(segment)
    }
}
