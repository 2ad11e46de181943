use core::fmt;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::system::Rayleigh;
use crate::theory::{
    samples::{SampleError, TangentPoint, Tolerance, coordinates, is_felt},
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
/// **Points it needs.** One with v ≠ 0. Each is judged by itself, at the time of a view: the answer is
/// about these points and this time.
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
/// [`SampleError`] if there is no point, none with v ≠ 0, or a derivative or a power is not finite.
pub fn dissipation<L, const N: usize>(
    system: &L,
    points: &[TangentPoint<L::Scalar, N>],
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
        let slope = system.rayleigh_gradient(q, v).d2;
        let power = slope.dot(v).widen();
        let tolerance = Tolerance { relative, scale: slope.abs().dot(&v.abs()).widen() };
        let at_rest = system.rayleigh_gradient(q, &nalgebra::zero()).d1;
        let gradient = largest(at_rest.iter().map(|entry| entry.widen()));
        if !(power.is_finite() && tolerance.bound().is_finite() && gradient.is_finite()) {
            return Err(SampleError::NonFinite { index });
        }
        let driven = usize::from(power < -tolerance.bound());
        let at = TangentPoint { q: q.map(Scalar::widen), v: v.map(Scalar::widen) };
        let report = report.get_or_insert(Dissipation {
            samples: points.len(),
            least_power: power,
            at,
            driven: 0,
            tolerance,
            gradient_at_rest: gradient,
            gradient_at: at.q,
        });
        report.driven += driven;
        if power < report.least_power {
            (report.least_power, report.at, report.tolerance) = (power, at, tolerance);
        }
        if gradient > report.gradient_at_rest {
            (report.gradient_at_rest, report.gradient_at) = (gradient, at.q);
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
        }
        if self.gradient_at_rest > 0.0 {
            write!(f, "\n  ∂R/∂q(q, 0) is up to {:.2e}, at q = ", self.gradient_at_rest)?;
            coordinates(f, &self.gradient_at)?;
            f.write_str(": subtract R(q, 0), which no motion feels but f_d does")?;
        }
        Ok(())
    }
}
