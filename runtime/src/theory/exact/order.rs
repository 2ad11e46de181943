//! The order of a discretisation, measured against the exact discrete objects.
//!
//! At q1 = q0 + h v with h → 0, for a rule whose flow is of order r:
//!
//! ```text
//! |p0 − p0^ex|, |p1 − p1^ex| = O(hʳ)         −D1 L_d − f_d⁻ and D2 L_d + f_d⁺
//! |L_d − L_d^ex| = O(hʳ⁺¹),  |f_d^± − f_d^ex±| = O(hʳ⁺¹)   sufficient for it, but not necessary
//! ```
//!
//! A rule may share the work between L_d and f_d differently from the exact pair. With constant mass matrix
//! M, the midpoint rule's f_d^± are off by ∓(h²/12)(df_L/dt − (∂f_L/∂v)ᵀM⁻¹f_L), which its D L_d makes up
//! for. So the order of the flow is read off the momenta.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::{Exact, ExactError, ExactSegment};
use crate::numbers::CovectorDerivatives;
use crate::step::{Discrete, Discretised};
use crate::system::ActingForce;
use crate::theory::verdict::largest;

/// An error this many times the reference's own counts as round-off plateau.
const PLATEAU: f64 = 30.0;

/// The errors of a rule at one step size: largest coordinate of each difference.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OrderSample {
    /// The step size.
    pub h: f64,
    /// |L_d − L_d^ex|.
    pub lagrangian: f64,
    /// |f_d⁻ − f_d^ex−|.
    pub force_minus: f64,
    /// |f_d⁺ − f_d^ex+|.
    pub force_plus: f64,
    /// |p0 − p0^ex|, p0 = −D1 L_d − f_d⁻.
    pub p0: f64,
    /// |p1 − p1^ex|, p1 = D2 L_d + f_d⁺.
    pub p1: f64,
    /// Round-off floors of the above, in the same order: errors below them say nothing.
    pub floors: [f64; 5],
}

/// How one error falls with h.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Convergence {
    /// Slope of log error over log h, least squares; `None` where fewer than two errors stand above the
    /// plateau.
    pub slope: Option<f64>,
    /// Slope of the two smallest step sizes above the plateau: nearest to the limit h → 0.
    pub last: Option<f64>,
    /// Step sizes used.
    pub used: usize,
    /// Step sizes left out, their errors being round-off or 0.
    pub cut: usize,
    /// The largest round-off floor of those left out.
    pub plateau: f64,
}

/// The orders of a rule.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct OrderReport {
    /// The errors, in the order of the step sizes given.
    pub samples: Vec<OrderSample>,
    /// Of L_d.
    pub lagrangian: Convergence,
    /// Of f_d⁻.
    pub force_minus: Convergence,
    /// Of f_d⁺.
    pub force_plus: Convergence,
    /// Of p0: the order of the rule's flow.
    pub p0: Convergence,
    /// Of p1: the order of the rule's flow.
    pub p1: Convergence,
}

impl<L, const N: usize> Exact<'_, L, N>
where
    L: ActingForce<N, Scalar = f64>,
{
    /// Measures the order of rule `R` at q0 with mean velocity `v`, q1 = q0 + h v.
    ///
    /// Of a system at a time, a view, every segment starts at that time. Step sizes that differ in their sign
    /// alone count once.
    ///
    /// The rule discretises every force that the system has, so the objects compared must be those of every
    /// force too: with [`Exact::unforced`] of a damped system the slopes of f_d are 1.
    ///
    /// # Errors
    /// As [`Exact::segment`], at any of the step sizes; [`ExactError::RuleNotFinite`] where the rule has no
    /// finite objects.
    pub fn order<R>(
        &self,
        _rule: R,
        q0: impl Into<SVector<f64, N>>,
        v: impl Into<SVector<f64, N>>,
        step_sizes: &[f64],
    ) -> Result<OrderReport, ExactError>
    where
        L: Discrete<R, N>,
    {
        let (q0, v) = (q0.into(), v.into());
        let mut known: Vec<f64> = Vec::new();
        // The same step size twice says nothing of a slope.
        let mut is_new = |h: f64| {
            let is_new = !known.contains(&h.abs());
            known.push(h.abs());
            is_new
        };
        let step_sizes: Vec<f64> = step_sizes.iter().copied().filter(|&h| is_new(h)).collect();
        let samples =
            step_sizes.iter().map(|&h| self.sample::<R>(&q0, &v, h)).collect::<Result<Vec<_>, _>>()?;
        let of = |index: usize| convergence(&samples, index);
        let (lagrangian, force_minus, force_plus, p0, p1) = (of(0), of(1), of(2), of(3), of(4));
        Ok(OrderReport { samples, lagrangian, force_minus, force_plus, p0, p1 })
    }

    /// f at the start of the motion, with its derivatives.
    fn acting_derivatives(
        &self,
        segment: &ExactSegment<N>,
    ) -> Result<CovectorDerivatives<f64, N>, ExactError> {
        self.asked(|work| {
            let local = self.dynamics(0.0, work).local(0.0, &segment.q0, &segment.v0);
            local.map(|local| local.f).map_err(|breakdown| breakdown.at(0.0, work))
        })
    }

    fn sample<R>(&self, q0: &SVector<f64, N>, v: &SVector<f64, N>, h: f64) -> Result<OrderSample, ExactError>
    where
        L: Discrete<R, N>,
    {
        let q1 = q0 + v * h;
        let exact = self.solve(*q0, q1, h, Some(*v))?;
        let by = Discretised::<L, R, N>::new(self.system(), h);
        // By these very ends: q1 is rounded.
        let (mean, objects) = ((q1 - q0) / h, by.objects(q0, &q1));
        let (force, momenta, lagrangian) = (objects.force(), objects.momenta(), objects.lagrangian());
        // The largest entry, NaN if one is.
        let size = |vector: &SVector<f64, N>| largest(vector.iter().copied());
        if !largest([lagrangian, size(&force.minus), size(&force.plus), size(&momenta.p0), size(&momenta.p1)])
            .is_finite()
        {
            return Err(ExactError::RuleNotFinite { h });
        }
        let relative = exact.report.error().max(f64::EPSILON);
        let floor = |size: f64, by_end: f64| PLATEAU * (size * relative + by_end);
        // What a rounding of the ends, which the motion meets to no more, makes of each.
        let ends = SVector::<f64, N>::from_fn(|i, _| f64::EPSILON * q0[i].abs().max(q1[i].abs()));
        let moved = |by_q1: &SMatrix<f64, N, N>| size(&(by_q1.abs() * ends));
        let acting = self.acting_derivatives(&exact)?;
        let of_force = size(&(acting.d2.abs() * ends + acting.d1.abs() * ends * h.abs()));
        // The action may be a small difference of its parts, T − V; its variations are not.
        let action = exact.lagrangian.value.abs().max((mean.dot(&exact.p0.value) * h).abs());
        Ok(OrderSample {
            h,
            lagrangian: (lagrangian - exact.lagrangian.value).abs(),
            force_minus: size(&(force.minus - exact.force.minus)),
            force_plus: size(&(force.plus - exact.force.plus)),
            p0: size(&(momenta.p0 - exact.p0.value)),
            p1: size(&(momenta.p1 - exact.p1.value)),
            floors: [
                floor(action, exact.lagrangian.d2.abs().dot(&ends)),
                floor(size(&exact.force.minus), of_force),
                floor(size(&exact.force.plus), of_force),
                floor(size(&exact.p0.value), moved(&exact.p0.d2)),
                floor(size(&exact.p1.value), moved(&exact.p1.d2)),
            ],
        })
    }
}

impl OrderSample {
    fn errors(&self) -> [f64; 5] {
        [self.lagrangian, self.force_minus, self.force_plus, self.p0, self.p1]
    }
}

fn convergence(samples: &[OrderSample], index: usize) -> Convergence {
    let mut points: Vec<(f64, f64)> = samples
        .iter()
        .map(|sample| (sample.h.abs(), sample.errors()[index], sample.floors[index]))
        .filter(|&(_, error, floor)| error > floor)
        .map(|(h, error, _)| (h.ln(), error.ln()))
        .collect();
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    let last = match points[..] {
        [.., (x0, y0), (x1, y1)] => Some((y1 - y0) / (x1 - x0)),
        _ => None,
    };
    let below = |sample: &&OrderSample| sample.errors()[index] <= sample.floors[index];
    Convergence {
        slope: last.map(|_| least_squares(&points)),
        last,
        used: points.len(),
        cut: samples.len() - points.len(),
        plateau: largest(samples.iter().filter(below).map(|sample| sample.floors[index])),
    }
}

/// Slope of the line through the points, least squares.
fn least_squares(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let (above, below) = points.iter().fold((0.0, 0.0), |(above, below), point| {
        (above + (point.0 - x) * (point.1 - y), below + (point.0 - x).powi(2))
    });
    above / below
}

impl fmt::Display for Convergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.slope, self.last) {
            (Some(slope), Some(last)) => write!(
                f,
                "slope {slope:.3}, at the smallest h {last:.3} ({} step sizes, {} on the plateau left out)",
                self.used, self.cut
            ),
            _ if self.cut > 0 => write!(
                f,
                "equal to rounding at {} step sizes of {}, of {:.0e} at most",
                self.cut,
                self.cut + self.used,
                self.plateau
            ),
            _ => write!(f, "unknown: {} step sizes are too few for a slope", self.used),
        }
    }
}

impl fmt::Display for OrderReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "errors against the exact discrete objects, q1 = q0 + h v (* on the round-off plateau)")?;
        writeln!(
            f,
            "  {:>10}  {:>10}  {:>10}  {:>10}  {:>10}  {:>10}",
            "h", "L_d", "f_d⁻", "f_d⁺", "p0", "p1"
        )?;
        for sample in &self.samples {
            write!(f, "  {:>10.4e}", sample.h)?;
            for (error, floor) in sample.errors().into_iter().zip(sample.floors) {
                let mark = if error > floor { ' ' } else { '*' };
                write!(f, "  {error:>9.2e}{mark}")?;
            }
            writeln!(f)?;
        }
        writeln!(f, "  L_d   {}", self.lagrangian)?;
        writeln!(f, "  f_d⁻  {}", self.force_minus)?;
        writeln!(f, "  f_d⁺  {}", self.force_plus)?;
        writeln!(f, "  p0    {}", self.p0)?;
        write!(f, "  p1    {}", self.p1)
    }
}
