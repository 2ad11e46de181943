//! Initial-value problems solved until more steps change nothing but rounding.
//!
//! Verner's explicit pair of order 9 takes equal steps over τ ∈ [0, 1]; their number doubles until the end of the motion
//! no longer changes. Equal steps keep the result a smooth function of the data and their errors comparable, and the
//! comparison is an error estimate that needs no tolerance in the units of each component.

use core::cell::Cell;

use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::ExplicitRungeKutta;
use differential_equations::ode::{ODE, OrdinaryNumericalMethod, solve_ode};
use differential_equations::solout::Solout;
use differential_equations::solution::Solution;

use super::ExactError;

/// Steps of the first attempt.
const FIRST: usize = 8;

/// Steps of the last attempt.
const LAST: usize = 1 << 14;

/// Differences between attempts at this size may be rounding, where the right-hand side itself is right to rounding.
pub(super) const ROUNDING: f64 = 1e-10;

/// Order 9 divides the difference by 512 when the steps double; less than this, and rounding holds it up.
const FALLING: f64 = 16.0;

/// Where an evaluation of the right-hand side stops.
#[derive(Clone, Copy, Debug)]
pub(super) enum Breakdown {
    /// ∂²L/∂v² is singular.
    Degenerate { column: usize },
    /// L, R or f is NaN or infinite.
    NotFinite,
}

/// An initial-value problem y′ = f(y) over τ ∈ [0, 1].
pub(super) struct Problem<'a, F> {
    /// The values at τ = 0.
    pub(super) start: Vec<f64>,
    /// Lengths of consecutive runs of components that share a unit: errors are relative to the largest of each run.
    pub(super) blocks: &'a [usize],
    /// f.
    pub(super) rate: F,
    /// The time that τ = 1 stands for; for messages.
    pub(super) h: f64,
    /// Relative differences between attempts that may be rounding, once they have stopped falling.
    pub(super) rounding: f64,
}

/// The solution of a [`Problem`].
pub(super) struct Resolved {
    /// y at τ = 1.
    pub(super) end: Vec<f64>,
    /// Largest |y| on the way, for each component.
    pub(super) largest: Vec<f64>,
    /// y at τ = 0, ¼, ½, ¾, 1.
    pub(super) snapshots: Vec<Vec<f64>>,
    /// Integration steps.
    pub(super) steps: usize,
    /// Largest difference to half as many steps, relative to the largest of the block.
    pub(super) difference: f64,
}

impl<F: Fn(&[f64], &mut [f64]) -> Result<(), Breakdown>> Problem<'_, F> {
    /// Solves the problem until the relative difference between two attempts is at most `sufficient`, or rounding.
    pub(super) fn resolve(&self, sufficient: f64) -> Result<Resolved, ExactError> {
        let mut steps = FIRST;
        let mut coarse = self.attempt(steps)?;
        let mut previous = f64::INFINITY;
        loop {
            steps *= 2;
            let mut fine = self.attempt(steps)?;
            let difference = self.difference(&coarse, &fine);
            fine.difference = difference;
            let stagnant = difference <= self.rounding && difference > previous / FALLING;
            if difference <= sufficient || stagnant {
                return Ok(fine);
            }
            if steps >= LAST {
                return if difference <= self.rounding {
                    Ok(fine)
                } else {
                    Err(ExactError::Unresolved { steps, difference })
                };
            }
            (coarse, previous) = (fine, difference);
        }
    }

    fn attempt(&self, steps: usize) -> Result<Resolved, ExactError> {
        let step = 1.0 / steps as f64;
        // With nothing to compare its error to, the method accepts every step, and takes the largest allowed.
        let mut method =
            ExplicitRungeKutta::rkv988e().rtol(0.0).atol(f64::MAX).h0(step).h_max(step).max_steps(2 * steps);
        let equation = Equation { rate: &self.rate, breakdown: Cell::new(None) };
        let mut watch = Watch {
            breakdown: &equation.breakdown,
            largest: vec![0.0; self.start.len()],
            snapshots: Vec::with_capacity(5),
        };
        let solved = solve_ode(&mut method, &equation, 0.0, 1.0, &self.start, &mut watch);
        let end = method.y().clone();
        if let Some((fraction, breakdown)) = equation.breakdown.get() {
            let time = fraction * self.h;
            return Err(match breakdown {
                Breakdown::Degenerate { column } => ExactError::DegenerateLagrangian { time, column },
                Breakdown::NotFinite => ExactError::MotionNotFinite { time },
            });
        }
        if solved.is_err() || end.iter().any(|entry| !entry.is_finite()) {
            return Err(ExactError::MotionNotFinite { time: method.t() * self.h });
        }
        let Watch { largest, snapshots, .. } = watch;
        Ok(Resolved { end, largest, snapshots, steps, difference: f64::INFINITY })
    }

    /// Largest difference of two attempts, relative to the largest component of the block on the way.
    fn difference(&self, coarse: &Resolved, fine: &Resolved) -> f64 {
        let mut worst = 0.0_f64;
        let mut first = 0;
        for &length in self.blocks {
            let block = first..first + length;
            first += length;
            let scale = block.clone().map(|i| fine.largest[i]).fold(0.0, f64::max);
            let apart = block.map(|i| (fine.end[i] - coarse.end[i]).abs()).fold(0.0, f64::max);
            if apart > 0.0 {
                worst = worst.max(apart / scale);
            }
        }
        worst
    }
}

/// A right-hand side that remembers where it broke down.
struct Equation<'a, F> {
    rate: &'a F,
    breakdown: Cell<Option<(f64, Breakdown)>>,
}

impl<F: Fn(&[f64], &mut [f64]) -> Result<(), Breakdown>> ODE<f64, Vec<f64>> for Equation<'_, F> {
    fn diff(&self, t: f64, y: &Vec<f64>, dydt: &mut Vec<f64>) {
        if self.breakdown.get().is_none()
            && let Err(breakdown) = (self.rate)(y, dydt)
        {
            self.breakdown.set(Some((t, breakdown)));
        }
    }
}

/// Watches the motion at the end of each step, and ends it after a breakdown.
struct Watch<'a> {
    breakdown: &'a Cell<Option<(f64, Breakdown)>>,
    largest: Vec<f64>,
    snapshots: Vec<Vec<f64>>,
}

impl Solout<f64, Vec<f64>> for Watch<'_> {
    fn solout<I>(
        &mut self,
        t: f64,
        _t_previous: f64,
        y: &Vec<f64>,
        _y_previous: &Vec<f64>,
        _interpolator: &mut I,
        _solution: &mut Solution<f64, Vec<f64>>,
    ) -> ControlFlag<f64, Vec<f64>>
    where
        I: Interpolation<f64, Vec<f64>> + ?Sized,
    {
        if self.breakdown.get().is_some() {
            return ControlFlag::Terminate;
        }
        for (largest, entry) in self.largest.iter_mut().zip(y) {
            *largest = largest.max(entry.abs());
        }
        // Steps are powers of ½: the quarters are met exactly.
        if (4.0 * t).fract() == 0.0 {
            self.snapshots.push(y.clone());
        }
        ControlFlag::Continue
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swing(y: &[f64], rate: &mut [f64]) -> Result<(), Breakdown> {
        rate[0] = 2.0 * y[1];
        rate[1] = -2.0 * y[0];
        Ok(())
    }

    #[test]
    fn the_end_is_right_to_rounding() {
        let problem =
            Problem { start: vec![0.0, 1.0], blocks: &[2], rate: swing, h: 1.0, rounding: ROUNDING };
        let resolved = problem.resolve(0.0).unwrap();
        assert!((resolved.end[0] - 2.0_f64.sin()).abs() < 2e-15, "{:?}", resolved.end);
        assert!((resolved.end[1] - 2.0_f64.cos()).abs() < 2e-15, "{:?}", resolved.end);
        assert!(resolved.difference < 1e-14);
        assert_eq!(resolved.snapshots.len(), 5);
        assert!((resolved.snapshots[1][0] - 0.5_f64.sin()).abs() < 2e-15);
    }

    #[test]
    fn a_coarse_attempt_is_seen_to_be_coarse() {
        // Positive control of the comparison: what it calls 1e-4 is not right to rounding.
        let fast = |y: &[f64], rate: &mut [f64]| {
            rate[0] = 60.0 * y[1];
            rate[1] = -60.0 * y[0];
            Ok(())
        };
        let problem = Problem { start: vec![0.0, 1.0], blocks: &[2], rate: fast, h: 1.0, rounding: ROUNDING };
        let rough = problem.resolve(1e-2).unwrap();
        let error = (rough.end[0] - 60.0_f64.sin()).abs();
        assert!(error > 1e-12 && error < rough.difference, "{error} {}", rough.difference);
    }

    #[test]
    fn a_breakdown_names_its_time() {
        // y′ = 1, broken down from y = ½ on.
        let rate = |y: &[f64], rate: &mut [f64]| {
            rate[0] = 1.0;
            if y[0] < 0.5 { Ok(()) } else { Err(Breakdown::NotFinite) }
        };
        let problem = Problem { start: vec![0.0], blocks: &[1], rate, h: 4.0, rounding: ROUNDING };
        match problem.resolve(0.0) {
            Err(ExactError::MotionNotFinite { time }) => assert!((1.9..2.6).contains(&time), "{time}"),
            other => panic!("{:?}", other.map(|resolved| resolved.end)),
        }
    }
}
