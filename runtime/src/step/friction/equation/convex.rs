//! Whether a step with friction that falls with the velocity is determined: its objective is convex.

use super::super::element::elements;
use super::super::sliding::{Sliding, direction_of};
use super::{WithFriction, at_middle};
use crate::numbers::{Factored, Pivoted, Scalar};
use crate::step::equation::StepEquation;
use crate::step::{ClosedForm, Discrete, Segment, StepError};
use crate::system::DryFriction;

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

impl<L, R, const N: usize, const M: usize> WithFriction<'_, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    /// Fails where the objective is not convex at some velocity that lies between rest and that of the
    /// segment.
    #[cold]
    pub(in super::super) fn require_convex(&self, segment: &Segment<L::Scalar, N>) -> Result<(), StepError> {
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
    pub(super) fn convex_from(&self, h: f64) -> f64 {
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
}
