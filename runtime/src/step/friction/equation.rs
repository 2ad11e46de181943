//! The equation of a step with friction that holds, for v̄ alone.

mod convex;

use core::cell::{Cell, RefCell};

use nalgebra::{SMatrix, SVector};

use super::set::Held;
use super::sliding::Sliding;
use crate::numbers::{Factored, NewtonMatrix, Pivoted, Scalar};
use crate::step::equation::{Equation, OfRule, StepEquation};
use crate::step::{ClosedForm, Discrete, Fused, Momenta, Segment, State, StepError, StepKernel};
use crate::system::{DryFriction, Lagrangian, Slips};

/// The equation F(v̄) = 0 of a step with friction from a state (q0, p), as p + F(v̄) = p.
pub(super) struct WithFriction<'a, L, R, const N: usize, const M: usize>
where
    L: ClosedForm<R, N>,
{
    system: &'a L,
    free: OfRule<'a, L, R>,
    state: &'a State<L::Scalar, N>,
    /// Whether momenta take W of the last kernel.
    is_frozen: Cell<bool>,
    rounding: Cell<SVector<L::Scalar, N>>,
    /// s and what sticks, as found last, and on which segment.
    held: Cell<Option<Held<L::Scalar, M>>>,
    on: Cell<Option<Segment<L::Scalar, N>>>,
    last: RefCell<Option<Factors<L, R, N>>>,
    /// An error of friction, and the velocity at which it was met.
    error: Cell<Option<StepError>>,
    at: Cell<SVector<L::Scalar, N>>,
}

type Factors<L, R, const N: usize> = Pivoted<<L as Lagrangian<N>>::Scalar, <L as Fused<R, N>>::Matrix, N>;

impl<'a, L, R, const N: usize, const M: usize> WithFriction<'a, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    pub(super) fn new(system: &'a L, state: &'a State<L::Scalar, N>) -> Self {
        Self {
            system,
            free: OfRule::new(system),
            state,
            is_frozen: Cell::new(true),
            rounding: Cell::new(nalgebra::zero()),
            held: Cell::new(None),
            on: Cell::new(None),
            last: RefCell::new(None),
            error: Cell::new(None),
            at: Cell::new(nalgebra::zero()),
        }
    }

    /// s and what sticks on the segment of the step.
    pub(super) fn held(&self, segment: &Segment<L::Scalar, N>) -> Option<Held<L::Scalar, M>> {
        // The solver may have looked elsewhere since.
        if self.on.get().is_none_or(|on| on.v != segment.v || on.q0 != segment.q0) {
            self.kernel(segment);
        }
        self.held.get()
    }

    /// The error of a step, by the friction where it is the cause.
    #[cold]
    pub(super) fn explained(&self, error: StepError) -> StepError {
        match self.error.get() {
            Some(StepError::NotConvex { component, h, .. }) => {
                StepError::NotConvex { component, h, enough: self.convex_from(h) }
            }
            Some(of_friction) => of_friction,
            None => error,
        }
    }

    /// F with W factored, where p0 is this without friction; nothing where friction has no solution.
    fn residual(
        &self,
        segment: &Segment<L::Scalar, N>,
        factored: &impl Factored<L::Scalar, N>,
        p0: &SVector<L::Scalar, N>,
    ) -> Option<SVector<L::Scalar, N>> {
        let half = segment.h * L::Scalar::constant(0.5);
        let slips = at_middle(self.system, segment);
        let sliding = match Sliding::of(&slips, &segment.v, (half, segment.h), factored) {
            Ok(sliding) => sliding,
            Err(error) => {
                // The first is that of the step size asked for.
                if self.error.get().is_none() {
                    self.error.set(Some(error));
                    self.at.set(segment.v);
                }
                return None;
            }
        };
        let left = p0 - self.state.p;
        let start = self.held.get().map_or(nalgebra::zero(), |held| held.forces);
        let held = sliding.held(L::ELEMENTS, factored, &left, &start);
        self.held.set(held);
        self.on.set(Some(*segment));
        let Some(held) = held else { return sliding.unknown() };
        let impulse = sliding.impulse(&held.forces);
        let rounding = impulse.abs() * (L::Scalar::EPSILON * L::Scalar::constant(4.0));
        self.rounding.set(rounding);
        // Where an element holds all that pushes, nothing else in the equation tells what counts as 0.
        Some((left + impulse).zip_map(&rounding, |left, rounding| {
            if left <= rounding && left >= -rounding { nalgebra::zero() } else { left }
        }))
    }
}

/// Slips and limits at the middle of the segment.
pub(super) fn at_middle<L, const N: usize, const M: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
) -> Slips<L::Scalar, N, M>
where
    L: DryFriction<N, M>,
{
    let half = segment.h * L::Scalar::constant(0.5);
    system.later(half, |system| system.slips(&(segment.q0 + segment.v * half), &segment.v))
}

impl<L, R, const N: usize, const M: usize> StepEquation<L::Scalar, N> for WithFriction<'_, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    type Matrix = L::Matrix;

    fn kernel(&self, segment: &Segment<L::Scalar, N>) -> StepKernel<L::Scalar, N, L::Matrix> {
        let StepKernel { p0, matrix } = self.free.kernel(segment);
        let factored = Pivoted::of(&matrix);
        let residual = factored.as_ref().and_then(|factored| self.residual(segment, factored, &p0));
        // Without friction's share there is no equation, nor a correction.
        if let Ok(mut last) = self.last.try_borrow_mut() {
            *last = factored.filter(|_| residual.is_some());
        }
        match residual {
            Some(residual) => StepKernel { p0: self.state.p + residual, matrix },
            // Singular itself: what is solved with it says so.
            None if factored.is_none() => StepKernel { p0, matrix },
            None => StepKernel { p0, matrix: NewtonMatrix::zero() },
        }
    }

    fn floor(&self, floor: SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        floor + self.rounding.get()
    }

    fn compare(&self) {
        self.is_frozen.set(false);
    }

    fn momenta(&self, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        let Momenta { p0, p1 } = self.free.momenta(segment);
        let residual = if self.is_frozen.get() {
            match self.last.try_borrow().as_deref() {
                Ok(Some(factored)) => self.residual(segment, factored, &p0),
                _ => None,
            }
        } else {
            Pivoted::of(&self.free.kernel(segment).matrix)
                .and_then(|factored| self.residual(segment, &factored, &p0))
        };
        // No number where friction has no solution: that is no root.
        let unknown = || SVector::repeat(L::Scalar::constant(f64::NAN));
        Momenta { p0: residual.map_or_else(unknown, |residual| self.state.p + residual), p1 }
    }

    fn correction(&self, residual: &SVector<L::Scalar, N>) -> Option<SVector<L::Scalar, N>> {
        let last = self.last.try_borrow().ok()?;
        last.as_ref().map(|factored| factored.solve(residual))
    }

    fn inertia(&self, segment: &Segment<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.free.inertia(segment)
    }

    fn cancelling(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        let forces = self.held.get().map_or(nalgebra::zero(), |held| held.forces);
        let slips = at_middle(self.system, segment);
        let forces = forces.component_mul(&slips.limits) * segment.h;
        self.free.cancelling(segment)
            + slips.by_velocity.transpose().abs() * forces.abs() * L::Scalar::constant(2.0)
    }

    /// The impulses of friction at its limits.
    fn holding(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        let slips = at_middle(self.system, segment);
        let impulses = slips.limits * (segment.h * L::Scalar::constant(0.5));
        slips.by_velocity.transpose().abs() * impulses.abs()
    }

    fn kind(&self) -> Equation {
        if L::IS_UNIFORM { self.free.kind() } else { Equation::General }
    }

    fn takes_massless(&self) -> bool {
        self.free.takes_massless()
    }

    fn cause(&self, segment: &Segment<L::Scalar, N>) -> Option<StepError> {
        self.free.cause(segment)
    }
}
