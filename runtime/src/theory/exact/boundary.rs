//! The motion from q0 to q1 in time h: Newton's method on the initial velocity.
//!
//! From the straight line's velocity, or the user's guess, damped where a full step does not shrink the next
//! correction. Where that fails, the motion is followed from small h, where it is nearly straight, to the h
//! asked for: this keeps to the branch that the exact discrete Lagrangian is defined on.
//!
//! A motion whose variations grow is not told by its start: damping seen backwards grows like e^{r|h|/m}. It
//! is told by its end, from which everything shrinks. Both are tried, and the error that rounding of the
//! start makes at the end is stated.

use nalgebra::{SMatrix, SVector};

use super::collocation::unit_of;
use super::mesh::Carried;
use super::motion::{Dynamics, Family, Point};
use super::{ExactError, WORST};
use crate::numbers::linear::inverse;
use crate::system::ActingForce;
use crate::theory::verdict::largest;

/// Points count as conjugate when the end determines the motion inside to less than half the digits, 1/√ε.
pub(super) const CONJUGATE: f64 = 6.7e7;

/// Newton iterations for one h.
const MAX_ITERATIONS: u32 = 40;

/// Halvings of a Newton step.
const MAX_HALVINGS: u32 = 10;

/// Step sizes less far apart, relatively, are not tried when a motion is followed.
const FINEST: f64 = 1e-6;

/// Two motions meet and cease where a variation grows like 1/√(1 − h/h*): followed to h* as closely as above,
/// a motion that grows less than this has not been lost to conjugate points, but to Newton's method.
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
    /// The error at the end from one rounding of the start, relative to the largest of the motion.
    pub(super) conditioning: f64,
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
    conditioning: f64,
    /// The error of q(h) from one rounding of the initial momentum, largest coordinate.
    enlargement: f64,
}

/// The boundary-value problem.
pub(super) struct Boundary<'a, L, const N: usize> {
    pub(super) dynamics: Dynamics<'a, L, N>,
    pub(super) q0: SVector<f64, N>,
    pub(super) q1: SVector<f64, N>,
}

impl<L: ActingForce<N, Scalar = f64>, const N: usize> Boundary<'_, L, N> {
    /// The motion from q0 to q1 by Newton's method from the straight line's velocity, or a guess.
    ///
    /// Where rounding is enlarged beyond `limit`, that is the error.
    pub(super) fn directly(
        &self,
        h: f64,
        guess: Option<&SVector<f64, N>>,
        limit: f64,
    ) -> Result<Shot<N>, ExactError> {
        self.shoot(h, guess.copied().unwrap_or_else(|| (self.q1 - self.q0) / h), limit)
    }

    /// The motion from q0 to q1, followed from small h on; `first_failure` is the error where it is not found
    /// for any of them.
    pub(super) fn followed(&self, h: f64, first_failure: ExactError) -> Result<Shot<N>, ExactError> {
        let straight = |h: f64| (self.q1 - self.q0) / h;
        let small = (1..=12).map(|k| h / f64::from(1 << k));
        let Some((mut reached, mut shot)) =
            small.into_iter().find_map(|h| self.shoot(h, straight(h), WORST).ok().map(|shot| (h, shot)))
        else {
            return Err(first_failure);
        };
        let mut ratio = 2.0_f64;
        let mut in_a_row = 0;
        let mut continuation = 1;
        while reached != h {
            let next = if (reached * ratio / h) < 1.0 { reached * ratio } else { h };
            match self.shoot(next, shot.v0 * (reached / next), WORST) {
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
                    if matches!(failure, ExactError::TooMuchWork { .. }) {
                        return Err(failure);
                    }
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
    fn shoot(&self, h: f64, v0: SVector<f64, N>, limit: f64) -> Result<Shot<N>, ExactError> {
        let unit = self.q0.amax().max(self.q1.amax()) / h.abs();
        let mut trial = self.trial(h, v0)?;
        // A trial that runs away is large itself: what counts is what its start does to ends of the size
        // asked for.
        let ends = self.q0.amax().max(self.q1.amax());
        if trial.enlargement > limit * ends {
            return Err(ExactError::IllConditioned { h, error: trial.enlargement / ends });
        }
        let mut previous = f64::INFINITY;
        for iterations in 1..=MAX_ITERATIONS {
            let size = trial.correction.amax();
            let scale = unit.max(trial.v0.amax());
            if size <= 1e-9 * scale && (size <= 8.0 * f64::EPSILON * scale || size > previous / 4.0) {
                if trial.growth > CONJUGATE {
                    return Err(ExactError::ConjugatePoints { h, growth: trial.growth });
                }
                if trial.conditioning > limit {
                    return Err(ExactError::IllConditioned { h, error: trial.conditioning });
                }
                let Trial { v0, end, inverse, growth, conditioning, .. } = trial;
                return Ok(Shot { v0, end, inverse, growth, conditioning, iterations, continuation: 0 });
            }
            previous = size;
            trial = self.descend(h, &trial)?;
        }
        Err(Self::failure(h, &trial))
    }

    /// A Newton step, shortened until the next correction (by the same matrix) is shorter.
    fn descend(&self, h: f64, trial: &Trial<N>) -> Result<Trial<N>, ExactError> {
        let size = trial.correction.amax();
        let mut share = 1.0;
        for _ in 0..=MAX_HALVINGS {
            match self.trial(h, trial.v0 + trial.correction * share) {
                Ok(next) => {
                    let simplified = trial.inverse * next.residual;
                    let before = trial.inverse * trial.residual;
                    // At rounding level corrections cannot shrink any more.
                    let rounding = size <= 1e-9 * trial.v0.amax().max(self.q1.amax() / h.abs());
                    if rounding || simplified.amax() <= (1.0 - share / 4.0) * before.amax() {
                        return Ok(next);
                    }
                }
                Err(exhausted @ ExactError::TooMuchWork { .. }) => return Err(exhausted),
                Err(_) => {}
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

    fn trial(&self, h: f64, v0: SVector<f64, N>) -> Result<Trial<N>, ExactError> {
        let local = self
            .dynamics
            .local(0.0, &self.q0, &v0)
            .map_err(|breakdown| breakdown.at(0.0, self.dynamics.work))?;
        let start = Point {
            q: self.q0,
            p: local.l.d2,
            v: v0,
            minus: Family { q: SMatrix::identity(), p: SMatrix::zeros() },
            plus: Family { q: SMatrix::zeros(), p: SMatrix::identity() },
        };
        let mesh = self.dynamics.mesh(&start, h)?;
        let carried = self.dynamics.carry(&start, &mesh, &mut |_, _| {})?;
        let end = carried.end;
        let largest = SMatrix::<f64, N, N>::from_column_slice(&carried.largest[3 * N + 2 * N * N..][..N * N]);
        let conjugate = ExactError::ConjugatePoints { h, growth: f64::INFINITY };
        let inverse = inverse(&end.plus.q).map_err(|_| conjugate)?;
        // Diagonal entries of max|∂q(t)/∂p0| |∂q(h)/∂p0|⁻¹ carry no unit.
        let growth = (largest * SMatrix::abs(&inverse)).diagonal().amax().max(1.0);
        let residual = end.q - self.q1;
        let inverse_mass = crate::numbers::linear::inverse(&local.l.d22)
            .map_err(|singular| ExactError::DegenerateLagrangian { time: 0.0, column: singular.column })?;
        let correction = -(inverse_mass * (inverse * residual));
        let unit = SVector::from_fn(|a, _| unit_of(&local, a));
        let conditioning = conditioning(&start, &carried, &unit);
        let enlargement = f64::EPSILON * (end.plus.q.abs() * start.p.abs()).amax();
        Ok(Trial { v0, end, residual, correction, inverse, growth, conditioning, enlargement })
    }
}

/// The error at the end from one rounding of (q0, p0), relative to the largest of the motion, in units in
/// which every coordinate has mass 1. The families are those of q0 and p0.
pub(super) fn conditioning<const N: usize>(
    start: &Point<N>,
    Carried { end, largest: most, .. }: &Carried<N>,
    unit: &SVector<f64, N>,
) -> f64 {
    let (q0, p0) = (start.q.abs(), start.p.abs());
    let moved_q = end.minus.q.abs() * q0 + end.plus.q.abs() * p0;
    let moved_p = end.minus.p.abs() * q0 + end.plus.p.abs() * p0;
    let ratio = |moved: [f64; N], most: [f64; N]| {
        let (moved, most) = (largest(moved), largest(most));
        if moved == 0.0 { 0.0 } else { moved / most }
    };
    let in_q =
        ratio(core::array::from_fn(|a| moved_q[a] * unit[a]), core::array::from_fn(|a| most[a] * unit[a]));
    let in_p = ratio(
        core::array::from_fn(|a| moved_p[a] / unit[a]),
        core::array::from_fn(|a| most[N + a] / unit[a]),
    );
    f64::EPSILON * largest([in_q, in_p])
}
