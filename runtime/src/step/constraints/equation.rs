//! The equation of a step on constraints, for v̄ alone.

use core::cell::{Cell, RefCell};

use nalgebra::{SMatrix, SVector};

use super::bordered::{Bordered, rounding_of_reactions};
use super::nearest::{held, require_on};
use super::rows::Rows;
use super::undefined::undefined_on;
use crate::numbers::{Factored, NewtonMatrix, Pivoted, Scalar};
use crate::step::equation::{OfRule, StepEquation};
use crate::step::{ClosedForm, Discrete, Fused, Momenta, Segment, State, Step, StepError, StepKernel};
use crate::system::{Constrained, Lagrangian};

/// Corrections by the constraints alone, of which one nearly always does.
const MOST_CORRECTIONS: u32 = 4;

/// Roundings by which a root may be off a constraint before it is corrected: up to 1200 have been seen at
/// bodies of 10⁻⁹ of the others' mass.
const MOST_NEAR: f64 = 1048576.0;

/// Roundings that a step may leave of a constraint where it cannot be corrected further.
const MOST_LEFT: f64 = 16.0;

/// The equation F(v̄) = 0 of a step on constraints from a state (q0, p), as p + F(v̄) = p.
pub(super) struct OnConstraints<'a, L, R, const N: usize, const M: usize>
where
    L: ClosedForm<R, N>,
{
    pub(super) system: &'a L,
    free: OfRule<'a, L, R>,
    pub(super) state: &'a State<L::Scalar, N>,
    /// G(q0)ᵀ, the directions of the reactions.
    directions: SMatrix<L::Scalar, N, M>,
    /// Whether momenta take W and S of the last kernel: of the quick method, to which the equation is all.
    is_frozen: Cell<bool>,
    /// The rounding of the reactions at the v̄ at which the kernel was asked for last.
    rounding: Cell<SVector<L::Scalar, N>>,
    /// At the v̄ at which the kernel was asked for last.
    last: RefCell<Option<Solved<L, R, N, M>>>,
}

/// W, made ready to solve with, and its border.
type Solved<L, R, const N: usize, const M: usize> = (
    Pivoted<<L as Lagrangian<N>>::Scalar, <L as Fused<R, N>>::Matrix, N>,
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
        require_on(system, (&values, &gradients), &state.q)?;
        let (free, directions, last) = (OfRule::new(system), gradients.transpose(), RefCell::new(None));
        let (is_frozen, rounding) = (Cell::new(true), Cell::new(nalgebra::zero()));
        Ok(Self { system, free, state, directions, is_frozen, rounding, last })
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
        let solved = Pivoted::of(&kernel.matrix).and_then(|factored| {
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
            Some((factored, bordered)) => self.state.p + bordered.refined(&factored, &(p0 - self.state.p)),
            None => *p0,
        }
    }

    /// κ = (h/2)λ on the segment of a step.
    pub(super) fn multipliers(&self, segment: &Segment<L::Scalar, N>) -> Option<SVector<L::Scalar, M>> {
        let (kernel, solved) = self.evaluated(segment);
        let (factored, bordered) = solved?;
        Some(bordered.multipliers(&factored, &(kernel.p0 - self.state.p)))
    }

    /// The step with its end on N to rounding, and its momentum: G(q1)·v(q1, p1) = 0.
    ///
    /// # Errors
    /// [`StepError::NoRealSolution`] of a step that is no root because it is off N; those of [`held`].
    pub(super) fn on_constraints(
        &self,
        step: Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let segment = Segment { q0: self.state.q, v: step.velocity, h };
        let is_off = match self.last.try_borrow().as_deref() {
            Ok(Some((_, last))) => last.is_off(self.system, &segment),
            _ => false,
        };
        let step = if is_off { self.corrected(segment, &step)? } else { step };
        held::<L, N, M>(self.system, step, h).map_err(|error| off_is_no_root(error, &step))
    }

    /// The step with its end brought onto N.
    #[cold]
    #[inline(never)]
    fn corrected(
        &self,
        segment: Segment<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let segment = self.brought_on(segment).map_err(|error| off_is_no_root(error, step))?;
        let momenta = Momenta { p0: self.state.p, p1: self.free.momenta(&segment).p1 };
        Step::completed(self.state, segment.h, segment.v, &momenta, step.report)
    }

    /// The segment corrected along the reactions, by what is left of the constraints alone: F stays as it is,
    /// from as near as a root may be.
    ///
    /// Beside reactions that are large and cancel, as at a light body between rods or in a triangle that is
    /// nearly flat, F does not see how far q1 is off. Nor does it at a place far off N where redundant
    /// constraints contradict one another: that is no root.
    ///
    /// # Errors
    /// [`StepError::OffConstraint`] where none is near.
    fn brought_on(&self, mut segment: Segment<L::Scalar, N>) -> Result<Segment<L::Scalar, N>, StepError> {
        let off = |(constraint, value): (usize, L::Scalar)| StepError::OffConstraint {
            constraint,
            value: value.widen(),
        };
        Rows::far_off(self.system, &segment, MOST_NEAR).map_err(off)?;
        for _ in 0..MOST_CORRECTIONS {
            let Some((factored, bordered)) = self.evaluated(&segment).1 else { break };
            match bordered.correction(&factored) {
                Some(correction) => segment.v -= correction,
                None => break,
            }
        }
        Rows::far_off(self.system, &segment, MOST_LEFT).map_err(off)?;
        Ok(segment)
    }
}

/// The error of a step to a place off N, which is no root.
#[cold]
fn off_is_no_root<S: Scalar, const N: usize>(error: StepError, step: &Step<S, N>) -> StepError {
    match error {
        StepError::OffConstraint { value, .. } => {
            StepError::NoRealSolution { iteration: step.report.iterations, residual: value.abs() }
        }
        other => other,
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
                let (p, left) = (self.state.p, p0 - self.state.p);
                let is_frozen = self.is_frozen.get();
                let residual = if is_frozen { Bordered::residual } else { Bordered::refined };
                let with = p + residual(bordered, factored, &left);
                self.rounding.set(rounding_of_reactions(&p0, &with));
                StepKernel { p0: with, matrix }
            }
            // Singular itself, or the complement is: what is solved with it says so.
            None if Pivoted::of(&matrix).is_none() => StepKernel { p0, matrix },
            None if undefined_on::<L, N, M>(self.system, segment).is_some() => {
                StepKernel { p0: SVector::repeat(L::Scalar::constant(f64::NAN)), matrix }
            }
            None => StepKernel { p0, matrix: NewtonMatrix::zero() },
        };
        if let Ok(mut last) = self.last.try_borrow_mut() {
            *last = solved;
        }
        kernel
    }

    fn floor(&self, floor: SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        floor + self.rounding.get()
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

    fn along_constraints(
        &self,
        segment: &Segment<L::Scalar, N>,
        correction: &SVector<L::Scalar, N>,
    ) -> Option<SVector<L::Scalar, N>> {
        let found =
            self.evaluated(segment).1.map(|(factored, bordered)| bordered.along(&factored, correction));
        Some(found.unwrap_or_else(|| SVector::repeat(L::Scalar::constant(f64::NAN))))
    }

    fn is_held(&self, segment: &Segment<L::Scalar, N>) -> bool {
        self.brought_on(*segment).is_ok()
    }

    fn inertia(&self, segment: &Segment<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.free.inertia(segment)
    }

    /// Terms of L, R and f, and of the reactions one by one: at rest they cancel the forces, and at a light
    /// body between rods one another.
    fn cancelling(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        let left = self.free.momenta(segment).p0 - self.state.p;
        let reactions = match self.evaluated(segment).1 {
            Some((factored, bordered)) => bordered.reactions(&factored, &left),
            None => left.abs(),
        };
        self.free.cancelling(segment) + reactions + reactions
    }

    fn cause(&self, segment: &Segment<L::Scalar, N>) -> Option<StepError> {
        self.free.cause(segment).or_else(|| undefined_on::<L, N, M>(self.system, segment))
    }
}
