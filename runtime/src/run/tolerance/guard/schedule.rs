//! Where a guarded run is looked at, and where its error is carried.

use super::{Choice, Chosen, GuardedTrajectory, Methods};
use crate::numbers::Scalar;
use crate::system::ActingForce;

/// Steps between two looks at most.
pub(super) const STRIDE: u64 = 40;

/// Runs of fewer steps are looked at in every step, unless the steps between show what they err by.
pub(super) const FEW: u64 = 100;

/// Looks at a run whose steps show that, where these are more than one in [`STRIDE`].
const LOOKS: u64 = 12;

/// The share of the run's cost that the motion's derivatives along it may take.
const SHARE: f64 = 0.05;

/// Of so many coordinates errors are followed in every turn, whatever it costs.
pub(super) const RESOLVED: usize = 3;

/// A step is looked at where the motion has become rougher than where it was looked at last, by this factor.
pub(super) const ROUGHER: f64 = 2.0;

/// The share of the tolerance above which a change of the force with time over one step is looked at.
const STROKE: f64 = 0.05;

/// The cost of the motion's derivative at a state, in evaluations: two, and the algebra of N×N matrices
/// beside forces of some N terms.
pub(super) fn derivatives(n: usize) -> f64 {
    2.0 + 1.3 * (n * n) as f64 + 4.0 * n as f64
}

impl<L, M, const N: usize> GuardedTrajectory<'_, L, M, N>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    /// The next look: at no period.
    pub(super) fn schedule_look(&mut self) {
        let Chosen { steps, method, .. } = self.choice.chosen;
        let stride = if method.is_gauss() && !self.guard.estimate.is_timed() {
            (steps / LOOKS).clamp(1, STRIDE)
        } else if steps < FEW {
            1
        } else {
            STRIDE
        };
        let next = self.guard.taken + 1 + (stride - 1) / 2 + self.guard.random.draw() % stride;
        self.guard.looks[1] = next.min(self.choice.chosen.steps);
    }

    /// The evaluations that the derivatives may take for each step.
    pub(super) fn affordable(&self) -> f64 {
        let share = if N <= RESOLVED { f64::INFINITY } else { SHARE };
        share * self.choice.chosen.evaluations_per_step
    }

    pub(super) fn schedule_derivatives(&mut self) {
        let angle = self.guard.estimate.speed * self.step_size();
        let resolved = if angle > 0.0 { self.guard.estimate.angle() / angle } else { f64::INFINITY };
        // Seldom where the step is long already; twice the last distance at most, as a period may look like
        // rest.
        let last = (self.guard.taken - self.guard.carried[2]).max(1) as f64;
        let resolved = resolved.min(2.0 * last);
        let (least, most) = if self.guard.estimate.is_coarse() {
            (derivatives(N) / (3.0 * SHARE * self.choice.chosen.evaluations_per_step), 4 * STRIDE)
        } else {
            (1.0, STRIDE)
        };
        let stride = resolved.max(least).clamp(1.0, most as f64);
        self.guard.carried[1] = self.guard.taken + stride as u64;
    }

    /// The largest fourth difference of q.
    pub(super) fn fourth_difference(&mut self) -> f64 {
        let q = self.guard.state.q;
        let [a, b, c, d] = self.guard.recent;
        let (four, six) = (L::Scalar::constant(4.0), L::Scalar::constant(6.0));
        let difference = ((q + d) - (a + c) * four + b * six).amax();
        self.guard.recent = [q, a, b, c];
        if self.guard.taken >= self.guard.segment.steps[0] + 4 { difference.widen() } else { 0.0 }
    }

    /// Whether the force, where it changes with time, has done so within the last step as it did not before:
    /// between the nodes of the step.
    pub(super) fn is_struck(&mut self) -> bool {
        let Choice { system, methods, chosen } = self.choice;
        let Chosen { tolerance, evaluations_per_step, is_watchful, .. } = chosen;
        let step_size = self.step_size();
        let is_seldom = !is_watchful
            && self.choice.chosen.steps >= FEW
            && 4.0 > SHARE * evaluations_per_step * (1 + self.guard.taken % 8) as f64;
        if !self.guard.estimate.is_timed() || is_seldom {
            return false;
        }
        // In the middle of the step, and where it ends: what strikes there is shared by two steps.
        let change = [0.5, 0.0].map(|share| {
            let time = self.time() - share * step_size;
            self.guard.estimate.change_of_force((system, methods), time)
        });
        let change = change[0].max(change[1]);
        let is_more = change > ROUGHER * self.guard.stroke;
        // Who bounds the step expects more than one.
        self.guard.stroke = if is_watchful { change } else { self.guard.stroke.max(change) };
        is_more && change * step_size * self.guard.scale.weight() > STROKE * tolerance
    }
}
