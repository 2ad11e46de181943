//! Looks of a guarded run: a step held against its halves, and the error carried on.

use super::schedule::{FEW, STRIDE};
use super::{Breach, Choice, Chosen, GuardedTrajectory, MethodStep, Methods, Since, local_error};
use crate::step::State;
use crate::system::ActingForce;

/// Steps from one energy to the next at least, after as many as lie between two looks.
const ENERGY: u64 = 10;

/// The estimate, over the tolerance, at which a breach is reported: as a rule the estimate is above the
/// error, by up to a factor of 2.
const REPORTED: f64 = 1.35;

impl<L, M, const N: usize> GuardedTrajectory<'_, L, M, N>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    /// Carries the error by a twin to the present state, where that is far enough or must be.
    pub(super) fn carry_by_twin(&mut self, must: bool) {
        let Choice { system, methods, .. } = self.choice;
        let step_size = self.step_size();
        let (from, taken) = self.guard.twin;
        let steps = self.guard.taken - taken;
        if must || steps >= self.guard.estimate.twin_stride(step_size, STRIDE) {
            let span = [self.time() - step_size * steps as f64, step_size * steps as f64];
            self.guard.estimate.carry_by_twin(
                system,
                methods,
                &from,
                span,
                &self.guard.scale,
                &mut self.twin,
            );
            self.guard.twin = (self.guard.state, self.guard.taken);
        }
    }

    /// Carries the error on to the present state.
    pub(super) fn carry(&mut self) {
        let steps = (self.guard.taken - self.guard.carried[0]) as f64;
        let Choice { system, methods, chosen } = self.choice;
        let Chosen { roundings, .. } = chosen;
        let is_energy = self.choice.chosen.steps < FEW
            || self.guard.taken <= STRIDE
            || self.guard.taken >= self.guard.energy + ENERGY;
        if is_energy {
            self.guard.energy = self.guard.taken;
        }
        let is_driven = self.guard.estimate.is_driven();
        let since = Since {
            steps,
            roundings,
            passed: self.guard.unresolved.passed(is_driven),
            foreseen: (self.guard.taken - self.guard.looks[0]).max(1) as f64 * self.guard.local,
            affordable: steps * self.affordable(),
            is_energy,
            ahead: chosen.time - self.time(),
        };
        let time = self.time();
        self.guard.estimate.carry((system, methods), &self.guard.state, time, &self.guard.scale, &since);
        self.guard.carried[2] = self.guard.carried[0];
        self.guard.carried[0] = self.guard.taken;
        self.schedule_derivatives();
    }

    /// Holds the last step, from `before`, against its halves; halves that cannot be taken are a breach.
    ///
    /// `unresolved` is what a Gauss method has left so. A step that is struck by a force errs as by a jump.
    pub(super) fn look(
        &mut self,
        before: &State<L::Scalar, N>,
        unresolved: Option<[f64; 2]>,
        is_struck: bool,
    ) {
        let h = self.step_size();
        let elapsed = self.guard.segment.time(self.guard.taken - 1);
        self.half.forget();
        let halves = self.half.advance(self.choice.system, elapsed, before).and_then(|first| {
            let second = self.half.advance(self.choice.system, elapsed + 0.5 * h, &first.step.state)?;
            self.guard.looked += first.evaluations + second.evaluations;
            Ok(second.step.state)
        });
        let steps = (self.guard.taken - self.guard.looks[0]) as f64;
        let Ok(halves) = halves else {
            self.guard.hardest.add(before, [elapsed, h], f64::INFINITY, [1.0, steps]);
            self.report(f64::INFINITY);
            return;
        };
        let order = if is_struck { 1 } else { self.choice.chosen.method.order() };
        let local = local_error(order, &self.guard.state, &halves);
        let over_a_turn = self.guard.estimate.over_a_turn(&local, &self.guard.scale);
        let size = self.guard.scale.largest(&over_a_turn);
        let unseen = match unresolved {
            Some(_) if size == 0.0 => 0.0,
            Some(coefficients) => {
                let is_driven = self.guard.estimate.is_driven();
                self.guard.unresolved.look(coefficients, over_a_turn, &self.guard.scale, is_driven) / size
            }
            // Those not looked at lie between the last one that was and this one.
            None if size > 0.0 => 0.5 * (steps - 1.0) * (1.0 + (self.guard.local / size).min(steps)),
            None => steps - 1.0,
        };
        self.guard.estimate.add(&local, unseen);
        self.guard.hardest.add(before, [elapsed, h], size, [1.0 + unseen, steps]);
        self.guard.local = size;
        self.guard.looks[0] = self.guard.taken;
        self.schedule_look();
    }

    pub(super) fn report(&mut self, expected: f64) {
        let tolerance = self.choice.chosen.tolerance;
        let size = if expected.is_nan() { f64::INFINITY } else { expected };
        self.guard.largest = self.guard.largest.max(size);
        if self.guard.breach.is_none() && size > REPORTED * tolerance {
            let share = (self.guard.taken as f64 / self.choice.chosen.steps as f64) * (tolerance / expected);
            let instead = tolerance * share.min(0.5);
            self.guard.breach = Some(Breach { time: self.time(), expected, tolerance, instead });
        }
    }
}
