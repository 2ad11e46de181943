//! L_d^ex, f_d^ex and the momenta on one segment.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::boundary::{Boundary, Shot};
use super::motion::{Family, Point, Reader, Writer};
use super::resolve::{Problem, ROUNDING};
use super::{ActingForce, ExactError};
use crate::{CovectorDerivatives, DiscreteForce, Gradient, Lagrangian};

/// The exact discrete objects at (q0, q1, h).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Segment<const N: usize> {
    /// q(0).
    pub q0: SVector<f64, N>,
    /// q(h).
    pub q1: SVector<f64, N>,
    /// The step size.
    pub h: f64,
    /// Velocity of the motion at q0.
    pub v0: SVector<f64, N>,
    /// Velocity of the motion at q1.
    pub v1: SVector<f64, N>,
    /// L_d^ex, D1 L_d^ex and D2 L_d^ex, each an integral of its own along the motion.
    pub lagrangian: Gradient<f64, N>,
    /// f_d^ex− and f_d^ex+.
    pub force: DiscreteForce<f64, N>,
    /// p0 = ∂L/∂v(q0, v0), with its derivatives by q0 and q1.
    pub p0: CovectorDerivatives<f64, N>,
    /// p1 = ∂L/∂v(q1, v1), with its derivatives by q0 and q1.
    pub p1: CovectorDerivatives<f64, N>,
    /// What the figures are good for.
    pub report: SegmentReport,
    /// The motion's start, with the variations of q0 and q1.
    pub(super) start: Point<N>,
    /// The motion at times 0, h/4, h/2, 3h/4 and h.
    pub(super) quarters: [Point<N>; 5],
}

/// How a segment was found, and error estimates that need no knowledge of the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SegmentReport {
    /// Newton iterations of the boundary-value problem, at the step size asked for.
    pub iterations: u32,
    /// Smaller step sizes that the motion had to be followed through.
    pub continuation: u32,
    /// Integration steps.
    pub steps: usize,
    /// Relative difference to the results with half as many steps: truncation and rounding of the integration.
    pub difference: f64,
    /// Relative error of the boundary conditions of q(t), ∂q(t)/∂q0 and ∂q(t)/∂q1 at t = h.
    pub boundary: f64,
    /// Relative error of D1 L_d^ex + f_d^ex− = −p0 and D2 L_d^ex + f_d^ex+ = p1: integrals on the left, ends of the
    /// motion on the right.
    pub identity: f64,
    /// How much larger a variation of q1 is inside the segment than at its end: 1 away from conjugate points.
    pub growth: f64,
}

impl SegmentReport {
    /// The largest of the three error estimates.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.difference.max(self.boundary).max(self.identity)
    }
}

impl fmt::Display for SegmentReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} Newton iterations, {} integration steps; relative errors: integration {:.1e}, boundary {:.1e}, \
             identity D L_d + f_d = ∓p {:.1e}; growth {:.1e}",
            self.iterations, self.steps, self.difference, self.boundary, self.identity, self.growth
        )?;
        if self.continuation > 0 {
            write!(f, "; followed through {} smaller step sizes", self.continuation)?;
        }
        Ok(())
    }
}

impl<const N: usize> fmt::Display for Segment<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let row = |vector: &SVector<f64, N>| {
            let entries: Vec<_> = vector.iter().map(|entry| format!("{entry:.15e}")).collect();
            entries.join("  ")
        };
        writeln!(f, "exact discrete objects, h = {}", self.h)?;
        writeln!(f, "  L_d^ex   {:.15e}", self.lagrangian.value)?;
        writeln!(f, "  D1 L_d   {}", row(&self.lagrangian.d1))?;
        writeln!(f, "  D2 L_d   {}", row(&self.lagrangian.d2))?;
        writeln!(f, "  f_d^ex−  {}", row(&self.force.minus))?;
        writeln!(f, "  f_d^ex+  {}", row(&self.force.plus))?;
        writeln!(f, "  p0       {}", row(&self.p0.value))?;
        writeln!(f, "  p1       {}", row(&self.p1.value))?;
        write!(f, "  {}", self.report)
    }
}

/// The integrals along the motion that `shot` found.
pub(super) fn along<L, F, const N: usize>(
    boundary: &Boundary<'_, L, F, N>,
    h: f64,
    shot: &Shot<N>,
) -> Result<Segment<N>, ExactError>
where
    L: Lagrangian<N, Scalar = f64>,
    F: ActingForce<L, N>,
{
    let Boundary { dynamics, q0, q1 } = *boundary;
    // At fixed q1 a variation of q0 changes p0 by −(∂q(h)/∂p0)⁻¹ ∂q(h)/∂q0; at fixed q0 one of q1 by (∂q(h)/∂p0)⁻¹.
    let start = Point {
        q: q0,
        v: shot.v0,
        minus: Family { q: SMatrix::identity(), p: -(shot.inverse * shot.end.minus.q) },
        plus: Family { q: SMatrix::zeros(), p: shot.inverse },
    };

    // Beside the motion: L, its two first variations, and the work of f on both families.
    let mut numbers = vec![0.0; Point::<N>::LENGTH + 1 + 4 * N];
    start.write(&mut numbers);
    let blocks: Vec<usize> = Point::<N>::BLOCKS.into_iter().chain([1, 2 * N, 2 * N]).collect();
    let rate = |y: &[f64], rate: &mut [f64]| {
        let (motion, integrands) = rate.split_at_mut(Point::<N>::LENGTH);
        let (point, local) = dynamics.point_rate(y, motion, h)?;
        let mut writer = Writer(integrands);
        writer.put(&[local.l.value * h]);
        for family in [&point.minus, &point.plus] {
            let variation = family.q.tr_mul(&local.l.d1) + local.velocities(family).tr_mul(&local.l.d2);
            writer.put((variation * h).as_slice());
        }
        for family in [&point.minus, &point.plus] {
            writer.put((family.q.tr_mul(&local.f.value) * h).as_slice());
        }
        Ok(())
    };
    let resolved = Problem { start: numbers, blocks: &blocks, rate, h, rounding: ROUNDING }.resolve(0.0)?;

    let end = Point::<N>::read(&resolved.end);
    let mut integrals = Reader(&resolved.end[Point::<N>::LENGTH..]);
    let lagrangian = Gradient { value: integrals.number(), d1: integrals.vector(), d2: integrals.vector() };
    let force = DiscreteForce { minus: integrals.vector(), plus: integrals.vector() };
    let momentum = |q, v| dynamics.system.lagrangian_gradient(q, v).d2;
    let p0 = CovectorDerivatives { value: momentum(&q0, &shot.v0), d1: start.minus.p, d2: start.plus.p };
    let p1 = CovectorDerivatives { value: momentum(&end.q, &end.v), d1: end.minus.p, d2: end.plus.p };

    let largest = Point::<N>::read(&resolved.largest);
    let boundary = relative((end.q - q1).amax(), largest.q.amax())
        .max(relative(end.minus.q.amax(), largest.minus.q.amax()))
        .max(relative((end.plus.q - SMatrix::identity()).amax(), largest.plus.q.amax()));
    let size = [&lagrangian.d1, &lagrangian.d2, &force.minus, &force.plus, &p0.value, &p1.value]
        .into_iter()
        .map(SVector::amax)
        .fold(0.0, f64::max);
    let identity = relative((lagrangian.d1 + force.minus + p0.value).amax(), size)
        .max(relative((lagrangian.d2 + force.plus - p1.value).amax(), size));

    let mut quarters = [start; 5];
    for (quarter, numbers) in quarters.iter_mut().zip(&resolved.snapshots) {
        *quarter = Point::read(numbers);
    }
    Ok(Segment {
        q0,
        q1,
        h,
        v0: shot.v0,
        v1: end.v,
        lagrangian,
        force,
        p0,
        p1,
        report: SegmentReport {
            iterations: shot.iterations,
            continuation: shot.continuation,
            steps: resolved.steps,
            difference: resolved.difference,
            boundary,
            identity,
            growth: shot.growth,
        },
        start,
        quarters,
    })
}

/// |error|/scale, 0 where there is no error.
fn relative(error: f64, scale: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / scale }
}
