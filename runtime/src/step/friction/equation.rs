//! The equation of a step with friction that holds, for v̄ alone.

use core::cell::{Cell, RefCell};

use nalgebra::{SMatrix, SVector};

use super::element::elements;
use super::set::{Elements, Held};
use crate::numbers::{Factored, NewtonMatrix, Pivoted, Scalar};
use crate::step::equation::{Equation, OfRule, StepEquation};
use crate::step::{ClosedForm, Discrete, Fused, Momenta, Segment, State, StepError, StepKernel};
use crate::system::{DryFriction, Lagrangian, Slips};

/// Halvings of a step size, in search of one that would do.
const HALVINGS: u32 = 40;

/// Shares of a velocity at which friction that falls with it is looked at: where it falls most steeply is not
/// known.
const SHARES: [f64; 6] = [0.0, 0.0625, 0.125, 0.25, 0.5, 0.75];

/// Shares of the longest velocity in reach at which the slope of the objective is looked at: where
/// friction falls is not known, so more closely near rest.
const LOOKS: [f64; 8] = [0.004, 0.03, 0.1, 0.25, 0.4, 0.6, 0.8, 1.0];

/// A share of the velocity of the step nearer than which its own slope, 0, is not looked at.
const NEAR: f64 = 1e-6;

/// Roundings of its terms below which that slope is 0.
const OF_SLOPE: f64 = 1024.0;

/// Slips on a segment with what a Newton matrix W makes of friction forces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sliding<S, const N: usize, const M: usize> {
    /// u.
    values: SVector<S, M>,
    /// Sizes of its terms.
    terms: SVector<S, M>,
    /// ∂u/∂v̄ at fixed q0.
    rows: SMatrix<S, M, N>,
    /// (h/2) Fₖ ∂uₖ/∂v, column by column: what s adds to p0.
    directions: SMatrix<S, N, M>,
    /// The rows times W⁻¹ times the directions.
    response: SMatrix<S, M, M>,
}

impl<S: Scalar, const N: usize, const M: usize> Sliding<S, N, M> {
    /// Of these slips at `v` over a step of size `h`, where q is q0 + `share` v̄, with W `factored`.
    ///
    /// # Errors
    /// [`StepError::NegativeFriction`], [`StepError::NotConvex`].
    pub(super) fn of(
        slips: &Slips<S, N, M>,
        v: &SVector<S, N>,
        (share, h): (S, S),
        factored: &impl Factored<S, N>,
    ) -> Result<Self, StepError> {
        let directions = direction_of(slips, h)?;
        let rows = slips.by_velocity + slips.by_configuration * share;
        let response = rows * factored.solve_columns(&directions);
        let mut own = response.data.0.iter().enumerate().map(|(k, column)| column.get(k));
        if let Some(component) = own.position(|entry| entry.is_some_and(|entry| *entry < S::zero())) {
            return Err(StepError::NotConvex { component, h: h.widen(), enough: 0.0 });
        }
        let terms = slips.values.abs() + slips.by_velocity.abs() * v.abs();
        Ok(Self { values: slips.values, terms, rows, directions, response })
    }

    /// s, and what sticks, of what is `left` of the equation without friction.
    pub(super) fn held(
        &self,
        sizes: &[usize],
        factored: &impl Factored<S, N>,
        left: &SVector<S, N>,
        start: &SVector<S, M>,
    ) -> Option<Held<S, M>> {
        let correction = factored.solve(left);
        let free = self.values - self.rows * correction;
        let terms = self.terms + self.rows.abs() * correction.abs();
        let elements = Elements { sizes, response: self.response, free, terms };
        let mut held = elements.held(start)?;
        if M > 1 && held.sticks.contains(&true) {
            let remains = left + self.impulse(&held.forces);
            let slip = self.values - self.rows * factored.solve(&remains);
            // Of what sticks redundantly no more is known.
            if let Some(rest) = elements.rest(&held.sticks, &slip)
                && rest.dot(&rest) <= S::EPSILON
            {
                held.forces += rest;
            }
        }
        Some(held)
    }

    /// No number as what is left, where the slips or limits are none: no smaller step would help.
    #[cold]
    fn unknown(&self) -> Option<SVector<S, N>> {
        let is_finite = self.response.iter().chain(&self.values).all(|entry| entry.is_finite());
        (!is_finite).then(|| SVector::repeat(S::constant(f64::NAN)))
    }

    /// The share of the friction forces s in p0.
    pub(super) fn impulse(&self, forces: &SVector<S, M>) -> SVector<S, N> {
        self.directions * forces
    }
}

/// (h/2) Fₖ ∂uₖ/∂v, column by column.
///
/// # Errors
/// [`StepError::NegativeFriction`].
pub(super) fn direction_of<S: Scalar, const N: usize, const M: usize>(
    slips: &Slips<S, N, M>,
    h: S,
) -> Result<SMatrix<S, N, M>, StepError> {
    let impulse = h * S::constant(0.5);
    let mut directions = slips.by_velocity.transpose();
    let limits = slips.limits.as_slice().iter();
    for (component, (column, limit)) in directions.data.0.iter_mut().zip(limits).enumerate() {
        if *limit < S::zero() {
            return Err(StepError::NegativeFriction { component, limit: limit.widen() });
        }
        column.iter_mut().for_each(|entry| *entry *= *limit * impulse);
    }
    Ok(directions)
}

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

    /// Fails where the objective is not convex at some velocity that lies between rest and that of the
    /// segment.
    #[cold]
    pub(super) fn require_convex(&self, segment: &Segment<L::Scalar, N>) -> Result<(), StepError> {
        for share in SHARES {
            let segment = Segment { v: segment.v * L::Scalar::constant(share), ..*segment };
            let half = segment.h * L::Scalar::constant(0.5);
            let Some(factored) = Pivoted::of(&self.free.kernel(&segment).matrix) else { continue };
            if let Err(error) =
                Sliding::of(&at_middle(self.system, &segment), &segment.v, (half, segment.h), &factored)
            {
                self.error.set(Some(error));
                self.at.set(segment.v);
                return Err(self.explained(error));
            }
        }
        self.require_one_least(segment)
    }

    /// Fails where the objective falls towards another least along the line from rest through the velocity of
    /// the segment, as far as the step without friction would go: a convex one falls to it and rises beyond.
    #[cold]
    fn require_one_least(&self, segment: &Segment<L::Scalar, N>) -> Result<(), StepError> {
        let zero = L::Scalar::constant(0.0);
        let at_rest = self.free.kernel(&Segment { v: nalgebra::zero(), ..*segment });
        let Some(factored) = Pivoted::of(&at_rest.matrix) else { return Ok(()) };
        let free = factored.solve(&(self.state.p - at_rest.p0));
        let (own, longest) = (segment.v.norm(), free.norm());
        let way = if own > zero { segment.v / own } else { free / longest };
        for share in LOOKS {
            let speed = longest * L::Scalar::constant(share);
            let v = way * speed;
            let at = Segment { v, ..*segment };
            let slips = at_middle(self.system, &at);
            let mut forces = slips.values;
            for element in elements(L::ELEMENTS) {
                let length = element.length(&slips.values);
                element.divide(&mut forces, if length > zero { length } else { L::Scalar::constant(1.0) });
            }
            // Friction that would push at such a speed is none of this step's.
            let Ok(directions) = direction_of(&slips, segment.h) else { break };
            let p0 = self.free.momenta(&at).p0;
            let slope = way.dot(&(p0 - self.state.p + directions * forces));
            let terms = p0.abs() + self.state.p.abs() + directions.abs() * forces.abs();
            let least = way.abs().dot(&terms) * L::Scalar::constant(OF_SLOPE) * L::Scalar::EPSILON;
            let near = own * L::Scalar::constant(NEAR);
            let falls_back = speed < own - near && slope > least;
            if falls_back || speed > own + near && slope < -least {
                let sizes = forces.abs();
                let largest = sizes.amax();
                let component = sizes.iter().position(|size| *size == largest).unwrap_or(0);
                let error = StepError::NotConvex { component, h: segment.h.widen(), enough: 0.0 };
                self.error.set(Some(error));
                self.at.set(v);
                return Err(self.explained(error));
            }
        }
        Ok(())
    }

    /// A part of h from which on the objective is convex, at the velocity at which it was not.
    #[cold]
    fn convex_from(&self, h: f64) -> f64 {
        // Back in time friction pushes.
        let h = h.abs();
        let v = self.at.get();
        let mut part = h;
        for _ in 0..HALVINGS {
            part *= 0.5;
            // With some room.
            let segment = Segment { q0: self.state.q, v, h: L::Scalar::constant(part * 1.125) };
            let half = segment.h * L::Scalar::constant(0.5);
            let factored = Pivoted::of(&self.free.kernel(&segment).matrix);
            let slips = at_middle(self.system, &segment);
            if factored
                .is_some_and(|factored| Sliding::of(&slips, &segment.v, (half, segment.h), &factored).is_ok())
            {
                break;
            }
        }
        part
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
