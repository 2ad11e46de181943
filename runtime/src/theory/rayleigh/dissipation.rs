use core::fmt;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::system::{Rayleigh, is_timed};
use crate::theory::{
    samples::{SampleError, TangentPoint, Tolerance, coordinates, is_felt, region},
    verdict::largest,
};

/// Whether R takes energy out, over a set of points (q, v). See [`dissipation`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Dissipation<const N: usize> {
    /// Number of points looked at.
    pub samples: usize,
    /// Smallest v·∂R/∂v, the power that the force takes out.
    pub least_power: f64,
    /// Where that is.
    pub at: TangentPoint<f64, N>,
    /// When that is, from the time of a view on; 0 of a system without time.
    pub after: f64,
    /// Number of points where v·∂R/∂v is negative: the force drives the motion there.
    pub driven: usize,
    /// The tolerance within which a power counts as zero.
    pub tolerance: Tolerance,
    /// Largest entry of ∂R/∂q(q, 0).
    ///
    /// If it is not 0, R holds a g(q) that has no part in the motion but shifts f_d^∓ by ±(h²/4)∇g: subtract
    /// R(q, 0).
    pub gradient_at_rest: f64,
    /// The configuration where that is.
    pub gradient_at: SVector<f64, N>,
}

impl<const N: usize> Dissipation<N> {
    /// Whether v·∂R/∂v ≥ 0 at every point, to rounding.
    #[must_use]
    pub fn is_dissipative(&self) -> bool {
        self.driven == 0
    }
}

/// Tests v·∂R/∂v ≥ 0 at `points`: along the motion dE/dt = −v·∂R/∂v.
///
/// A power counts as negative below −1024 ε Σ|vᵢ ∂R/∂vᵢ|, the terms of its own sum.
///
/// **Points it needs.** One with v ≠ 0. Each is judged by itself: the answer is about these points.
///
/// A view that takes the time is judged over a duration, by [`dissipation_over`].
///
/// ```
/// use dalembert::rayleigh::dissipation;
/// use dalembert::{rayleigh_system, samples};
///
/// #[rayleigh_system]
/// fn mass(_q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0], r * v[0].powi(3) / 3.0)
/// }
///
/// // The force −r v² always pushes backwards: it drives a mass that moves backwards.
/// let report = dissipation(&Mass { r: 0.5 }, &samples::tangent_points([0.0], [1.0], [2.0], 100))?;
/// assert!(!report.is_dissipative() && report.at.v[0] < 0.0);
/// # Ok::<(), dalembert::samples::SampleError>(())
/// ```
///
/// # Errors
/// [`SampleError`] if there is no point, none with v ≠ 0, or a derivative or a power is not finite;
/// [`SampleError::OneTime`] of a view that takes the time.
pub fn dissipation<L, const N: usize>(
    system: &L,
    points: &[TangentPoint<L::Scalar, N>],
) -> Result<Dissipation<N>, SampleError>
where
    L: Rayleigh<N>,
{
    if is_timed(system) {
        return Err(SampleError::OneTime);
    }
    judged(system, points, &[0.0])
}

/// Tests v·∂R/∂v ≥ 0 at `points`, each at 32 times from that of a view on: at both ends of `duration`, and
/// between them.
///
/// The answer is about these points and times: friction that reverses for less than a thirtieth of the
/// duration can pass between them.
///
/// ```
/// use dalembert::rayleigh::{dissipation, dissipation_over};
/// use dalembert::samples::{SampleError, tangent_points};
/// use dalembert::rayleigh_system;
///
/// struct Damper { c: f64 }
///
/// #[rayleigh_system]
/// impl Damper {
///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * v[0] * v[0]
///     }
///     // It brakes at t = 0, and drives from t = π/2 on.
///     fn rayleigh(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
///         0.5 * self.c * t.cos() * v[0] * v[0]
///     }
/// }
///
/// let damper = Damper { c: 0.3 };
/// let view = damper.at_time(0.0);
/// let points = tangent_points([0.0], [1.0], [2.0], 100);
/// assert_eq!(dissipation(&view, &points).unwrap_err(), SampleError::OneTime);
/// assert!(dissipation_over(&view, &points, 1.5)?.is_dissipative());
/// let report = dissipation_over(&view, &points, 3.0)?;
/// assert!(!report.is_dissipative() && report.after == 3.0);
/// # Ok::<(), SampleError>(())
/// ```
///
/// # Errors
/// [`SampleError`] if there is no point, none with v ≠ 0, or a derivative or a power is not finite, as at a
/// time that is none.
pub fn dissipation_over<L, const N: usize>(
    system: &L,
    points: &[TangentPoint<L::Scalar, N>],
    duration: f64,
) -> Result<Dissipation<N>, SampleError>
where
    L: Rayleigh<N>,
{
    // Between the ends no two are evenly apart, so that no period hides from them.
    let between = region::<f64, 1>([0.0], [duration], TIMES - 2);
    let times: Vec<f64> = [0.0, duration].into_iter().chain(between.iter().map(|time| time[0])).collect();
    judged(system, points, &times)
}

/// Times of a duration.
const TIMES: usize = 32;

/// The powers at all points and times, from that of the system on.
fn judged<L, const N: usize>(
    system: &L,
    points: &[TangentPoint<L::Scalar, N>],
    times: &[f64],
) -> Result<Dissipation<N>, SampleError>
where
    L: Rayleigh<N>,
{
    let relative = Tolerance::rounding::<L::Scalar>();
    if !points.is_empty() && !points.iter().any(|point| is_felt(&point.v)) {
        return Err(SampleError::Uninformative { given: points.len() });
    }
    let mut report: Option<Dissipation<N>> = None;
    for (index, point) in points.iter().enumerate() {
        let TangentPoint { q, v } = point;
        let at = TangentPoint { q: q.map(Scalar::widen), v: v.map(Scalar::widen) };
        let mut is_driven = false;
        for &after in times {
            let [slope, at_rest] = system.later(L::Scalar::constant(after), |system| {
                [system.rayleigh_gradient(q, v).d2, system.rayleigh_gradient(q, &nalgebra::zero()).d1]
            });
            let power = slope.dot(v).widen();
            let tolerance = Tolerance { relative, scale: slope.abs().dot(&v.abs()).widen() };
            let gradient = largest(at_rest.iter().map(|entry| entry.widen()));
            if !(power.is_finite() && tolerance.bound().is_finite() && gradient.is_finite()) {
                return Err(SampleError::NonFinite { index });
            }
            is_driven |= power < -tolerance.bound();
            let report = report.get_or_insert(Dissipation {
                samples: points.len(),
                least_power: power,
                at,
                after,
                driven: 0,
                tolerance,
                gradient_at_rest: gradient,
                gradient_at: at.q,
            });
            if power < report.least_power {
                (report.least_power, report.at, report.after) = (power, at, after);
                report.tolerance = tolerance;
            }
            if gradient > report.gradient_at_rest {
                (report.gradient_at_rest, report.gradient_at) = (gradient, at.q);
            }
        }
        if let Some(report) = &mut report {
            report.driven += usize::from(is_driven);
        }
    }
    report.ok_or(SampleError::TooFew { given: 0, needed: 1 })
}

impl<const N: usize> fmt::Display for Dissipation<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_dissipative() {
            write!(f, "R is dissipative at all {} points: v·∂R/∂v ≥ {:.2e}", self.samples, self.least_power)?;
        } else {
            write!(
                f,
                "R is NOT dissipative: v·∂R/∂v < 0 at {} of {} points, least {:.3e} (zero below {}) at q = ",
                self.driven, self.samples, self.least_power, self.tolerance
            )?;
            coordinates(f, &self.at.q)?;
            f.write_str(", v = ")?;
            coordinates(f, &self.at.v)?;
            if self.after != 0.0 {
                write!(f, ", {:.4} later", self.after)?;
            }
        }
        if self.gradient_at_rest > 0.0 {
            write!(f, "\n  ∂R/∂q(q, 0) is up to {:.2e}, at q = ", self.gradient_at_rest)?;
            coordinates(f, &self.gradient_at)?;
            f.write_str(": subtract R(q, 0), which no motion feels but f_d does")?;
        }
        Ok(())
    }
}
