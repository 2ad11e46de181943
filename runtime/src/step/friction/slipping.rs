//! Which elements of friction stick at a state of the motion, and how the others slip.

use nalgebra::SVector;

use super::balanced::at_end;
use super::element::elements;
use super::end;
use crate::numbers::Scalar;
use crate::step::{ClosedForm, Discrete, Segment, State, StepError};
use crate::system::{DryFriction, Slips, sizes};

/// Roundings of its terms below which a slip counts as none.
const ROUNDINGS: f64 = 64.0;

/// The slips of all elements, component by component, and which of them stick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slipping<S, const M: usize> {
    slips: SVector<S, M>,
    sticks: [bool; M],
    /// Whether forces at the end of a step let it slip, and not those at the middle.
    by_end: [bool; M],
}

/// An element, by what it does.
pub(crate) enum Slip<S, const M: usize> {
    /// It sticks.
    None,
    /// It slips this way: of length 1, and of its components alone.
    Along(SVector<S, M>),
}

impl<S: Scalar, const M: usize> Slipping<S, M> {
    /// At a state: elements without a slip are said to stick.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub(crate) fn at<L, const N: usize>(system: &L, state: &State<S, N>) -> Result<Self, StepError>
    where
        L: DryFriction<N, M, Scalar = S>,
    {
        let v = state.velocity(system)?;
        let Slips { values, by_velocity, .. } = system.slips(&state.q, &v);
        let by_itself = system.slips(&state.q, &nalgebra::zero()).values;
        let most = (by_velocity.abs() * v.abs() + by_itself.abs()) * (S::EPSILON * S::constant(ROUNDINGS));
        let mut sticks = [false; M];
        for element in elements(L::ELEMENTS) {
            let mut entries = element.of(values.as_slice()).zip(element.of(most.as_slice()));
            let is_at_rest = entries.all(|(slip, most)| slip.abs() <= *most);
            element.of_mut(&mut sticks).for_each(|stick| *stick = is_at_rest);
        }
        Ok(Self { slips: values, sticks, by_end: [false; M] })
    }

    /// At the end of the step on a segment, which was solved for: as the step itself has it.
    ///
    /// # Errors
    /// Those of the step.
    pub(crate) fn at_end<L, R, const N: usize>(system: &L, segment: &Segment<S, N>) -> Result<Self, StepError>
    where
        L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M, Scalar = S>,
    {
        let end = end(system, segment, &system.momenta(segment).p1)?;
        if end.light.are_any() {
            // How fast the kinks let go there the end itself tells.
            let q = at_end(system, segment, &end)?.q;
            return system.later(segment.h, |system| {
                let mut slipping = Self::at(system, &State { q, p: end.p })?;
                let rows = end.light.columns(&system.slips(&q, &end.v).by_velocity);
                let moved = sizes(&rows, &SVector::repeat(S::one()));
                let touched = slipping.by_end.iter_mut().zip(moved.as_slice());
                touched.for_each(|(by_end, moved)| *by_end = *moved > S::zero());
                Ok(slipping)
            });
        }
        let half = segment.h * S::constant(0.5);
        let slips = system.later(half, |system| system.slips(&(segment.q0 + segment.v * half), &end.v));
        Ok(Self { slips: slips.values, sticks: end.held.sticks, by_end: [false; M] })
    }

    /// The share of the longest step which holds one of the elements that have so many components each, where
    /// its force is at its limit: the middle, or the end.
    pub(crate) fn at_limit(&self, sizes: &[usize], element: usize) -> f64 {
        let by_end = elements(sizes).nth(element).and_then(|element| element.head(&self.by_end));
        if by_end == Some(true) { 1.0 } else { 0.5 }
    }

    /// One of the elements that have so many components each.
    pub(crate) fn of(&self, sizes: &[usize], element: usize) -> Slip<S, M> {
        let Some(element) = elements(sizes).nth(element) else { return Slip::None };
        let (sticks, length) = (element.head(&self.sticks), element.length(&self.slips));
        if sticks == Some(true) || length == S::zero() {
            Slip::None
        } else {
            Slip::Along(element.part(&self.slips) / length)
        }
    }
}
