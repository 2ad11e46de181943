//! The motion from q0 to q1 in time h: Newton's method on the initial velocity.
//!
//! From the straight line's velocity, or the user's guess, damped where a full step does not shrink the next correction.
//! Where that fails, the motion is followed from small h, where it is nearly straight, to the h asked for: this keeps to
//! the branch that the exact discrete Lagrangian is defined on.

use nalgebra::{SMatrix, SVector};

use super::motion::{Dynamics, Family, Local, Point, Writer};
use super::resolve::{Breakdown, Problem, ROUNDING, Resolved};
use super::{ActingForce, ExactError};
use crate::Lagrangian;
use crate::linear::inverse;

/// Points count as conjugate when the end determines the motion inside to less than half the digits, 1/√ε.
pub(super) const CONJUGATE: f64 = 6.7e7;

/// Newton iterations for one h.
const MAX_ITERATIONS: u32 = 40;

/// Halvings of a Newton step.
const MAX_HALVINGS: u32 = 10;

/// Step sizes less far apart, relatively, are not tried when a motion is followed.
const FINEST: f64 = 1e-6;

/// Two motions meet and cease where a variation grows like 1/√(1 − h/h*): followed to h* as closely as above, a motion that
/// grows less than this has not been lost to conjugate points, but to Newton's method.
const CEASING: f64 = 50.0;

/// The initial velocity found, and ∂(q, p)(h)/∂(q0, p0) with it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shot<const N: usize> {
    pub(super) v0: SVector<f64, N>,
    /// End of the motion with variations of q0 (at fixed p0) and of p0 (at fixed q0).
    pub(super) end: Point<N>,
    /// Inverse of ∂q(h)/∂p0.
    pub(super) inverse: SMatrix<f64, N, N>,
    /// How much larger a variation of q1 is inside the segment than at its end, at least 1.
    pub(super) growth: f64,
    pub(super) iterations: u32,
    /// Smaller step sizes that the motion was followed through.
    pub(super) continuation: u32,
}

/// A motion from q0 with some initial velocity, and Newton's correction of it.
struct Trial<const N: usize> {
    v0: SVector<f64, N>,
    end: Point<N>,
    residual: SVector<f64, N>,
    correction: SVector<f64, N>,
    inverse: SMatrix<f64, N, N>,
    growth: f64,
}

/// The boundary-value problem.
pub(super) struct Boundary<'a, L, F, const N: usize> {
    pub(super) dynamics: Dynamics<'a, L, F, N>,
    pub(super) q0: SVector<f64, N>,
    pub(super) q1: SVector<f64, N>,
}

impl<L: Lagrangian<N, Scalar = f64>, F: ActingForce<L, N>, const N: usize> Dynamics<'_, L, F, N> {
    /// The motion from `start`, with both families of variations.
    pub(super) fn carry(&self, start: &Point<N>, h: f64, sufficient: f64) -> Result<Resolved, ExactError> {
        let mut numbers = vec![0.0; Point::<N>::LENGTH];
        start.write(&mut numbers);
        let rate = |y: &[f64], rate: &mut [f64]| self.point_rate(y, rate, h).map(drop);
        Problem { start: numbers, blocks: &Point::<N>::BLOCKS, rate, h, rounding: ROUNDING }
            .resolve(sufficient)
    }

    /// Writes the rates of change of a [`Point`], times h; gives the point and what was evaluated there.
    pub(super) fn point_rate(
        &self,
        y: &[f64],
        rate: &mut [f64],
        h: f64,
    ) -> Result<(Point<N>, Local<N>), Breakdown> {
        let point = Point::<N>::read(y);
        let local = self.local(&point.q, &point.v)?;
        let mut writer = Writer(rate);
        writer.put((point.v * h).as_slice());
        writer.put((local.acceleration * h).as_slice());
        for family in [&point.minus, &point.plus] {
            let v = local.velocities(family);
            writer.put((v * h).as_slice());
            writer.put((local.momentum_rates(&family.q, &v) * h).as_slice());
        }
        Ok((point, local))
    }
}

impl<L: Lagrangian<N, Scalar = f64>, F: ActingForce<L, N>, const N: usize> Boundary<'_, L, F, N> {
    /// The motion from q0 to q1.
    pub(super) fn solve(&self, h: f64, guess: Option<&SVector<f64, N>>) -> Result<Shot<N>, ExactError> {
        let straight = |h: f64| (self.q1 - self.q0) / h;
        let direct = self.shoot(h, guess.copied().unwrap_or_else(|| straight(h)));
        let first_failure = match direct {
            Ok(_) | Err(ExactError::ConjugatePoints { .. } | ExactError::DegenerateLagrangian { .. }) => {
                return direct;
            }
            Err(failure) => failure,
        };

        let small = (1..=12).map(|k| h / f64::from(1 << k));
        let Some((mut reached, mut shot)) =
            small.into_iter().find_map(|h| self.shoot(h, straight(h)).ok().map(|shot| (h, shot)))
        else {
            return Err(first_failure);
        };
        let mut ratio = 2.0_f64;
        let mut in_a_row = 0;
        let mut continuation = 1;
        while reached != h {
            let next = if (reached * ratio / h) < 1.0 { reached * ratio } else { h };
            match self.shoot(next, shot.v0 * (reached / next)) {
                Ok(further) => {
                    (reached, shot) = (next, further);
                    in_a_row += 1;
                    if in_a_row > 2 {
                        ratio = (ratio * ratio).min(2.0);
                    }
                    continuation += 1;
                }
                Err(failure) => {
                    in_a_row = 0;
                    ratio = ratio.sqrt();
                    if ratio < 1.0 + FINEST {
                        return Err(if shot.growth > CEASING {
                            ExactError::ConjugatePoints { h: reached, growth: shot.growth }
                        } else if let ExactError::NoMotion { residual, .. } = failure {
                            ExactError::NoMotion { reached, residual }
                        } else {
                            failure
                        });
                    }
                }
            }
        }
        Ok(Shot { continuation, ..shot })
    }

    /// Newton's method from the initial velocity `v0`.
    fn shoot(&self, h: f64, v0: SVector<f64, N>) -> Result<Shot<N>, ExactError> {
        let unit = self.q0.amax().max(self.q1.amax()) / h.abs();
        let mut full = false;
        let mut trial = self.trial(h, v0, full)?;
        let mut previous = f64::INFINITY;
        for iterations in 1..=MAX_ITERATIONS {
            let size = trial.correction.amax();
            let scale = unit.max(trial.v0.amax());
            if full && size <= 1e-9 * scale && (size <= 8.0 * f64::EPSILON * scale || size > previous / 4.0) {
                if trial.growth > CONJUGATE {
                    return Err(ExactError::ConjugatePoints { h, growth: trial.growth });
                }
                let Trial { v0, end, inverse, growth, .. } = trial;
                return Ok(Shot { v0, end, inverse, growth, iterations, continuation: 0 });
            }
            previous = size;
            let was_full = full;
            full = size <= 1e-4 * scale;
            if full && !was_full {
                // The same velocity again: its correction is now exact.
                trial = self.trial(h, trial.v0, full)?;
                previous = f64::INFINITY;
                continue;
            }
            trial = self.descend(h, &trial, full)?;
        }
        Err(Self::failure(h, &trial))
    }

    /// A Newton step, shortened until the next correction (by the same matrix) is shorter.
    fn descend(&self, h: f64, trial: &Trial<N>, full: bool) -> Result<Trial<N>, ExactError> {
        let size = trial.correction.amax();
        let mut share = 1.0;
        for _ in 0..=MAX_HALVINGS {
            if let Ok(next) = self.trial(h, trial.v0 + trial.correction * share, full) {
                let simplified = trial.inverse * next.residual;
                let before = trial.inverse * trial.residual;
                // At rounding level corrections cannot shrink any more.
                let rounding = size <= 1e-9 * trial.v0.amax().max(self.q1.amax() / h.abs());
                if rounding || simplified.amax() <= (1.0 - share / 4.0) * before.amax() {
                    return Ok(next);
                }
            }
            share *= 0.5;
        }
        Err(Self::failure(h, trial))
    }

    fn failure(h: f64, trial: &Trial<N>) -> ExactError {
        if trial.growth > CONJUGATE {
            ExactError::ConjugatePoints { h, growth: trial.growth }
        } else {
            ExactError::NoMotion { reached: 0.0, residual: trial.residual.amax() }
        }
    }

    fn trial(&self, h: f64, v0: SVector<f64, N>, full: bool) -> Result<Trial<N>, ExactError> {
        let start = Point {
            q: self.q0,
            v: v0,
            minus: Family { q: SMatrix::identity(), p: SMatrix::zeros() },
            plus: Family { q: SMatrix::zeros(), p: SMatrix::identity() },
        };
        let resolved = self.dynamics.carry(&start, h, if full { 0.0 } else { 1e-6 })?;
        let end = Point::read(&resolved.end);
        let largest = Point::<N>::read(&resolved.largest).plus.q;
        let conjugate = ExactError::ConjugatePoints { h, growth: f64::INFINITY };
        let inverse = inverse(&end.plus.q).map_err(|_| conjugate)?;
        // Diagonal entries of max|∂q(t)/∂p0| |∂q(h)/∂p0|⁻¹ carry no unit.
        let growth = (largest * SMatrix::abs(&inverse)).diagonal().amax().max(1.0);
        let residual = end.q - self.q1;
        let local = self.dynamics.local(&self.q0, &v0).map_err(|breakdown| match breakdown {
            Breakdown::Degenerate { column } => ExactError::DegenerateLagrangian { time: 0.0, column },
            Breakdown::NotFinite => ExactError::MotionNotFinite { time: 0.0 },
        })?;
        let correction = -(local.inverse_mass * (inverse * residual));
        Ok(Trial { v0, end, residual, correction, inverse, growth })
    }
}
