//! L_d^ex, f_d^ex and the momenta on one segment.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::ExactError;
use super::boundary::{Boundary, Shot};
use super::mesh::{Question, ROUNDING, Visitor};
use super::motion::{Family, Point};
use crate::numbers::{CovectorDerivatives, Gradient};
use crate::step::DiscreteForce;
use crate::system::ActingForce;
use crate::theory::verdict::largest;

/// The exact discrete objects at (q0, q1, h).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ExactSegment<const N: usize> {
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
    /// How the segment was found, and error estimates.
    pub report: SegmentReport,
    /// How the motion was followed.
    pub(super) course: Course<N>,
}

/// The motion as it was followed, with the variations of the ends that it starts and ends at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Course<const N: usize> {
    /// Whether it was followed from q1 back to q0.
    pub(super) reversed: bool,
    /// The motion at times 0, h/4, h/2, 3h/4 and h of its course.
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
    /// Relative difference to the results with half as many steps: truncation and rounding of the
    /// integration.
    pub difference: f64,
    /// Relative error of the boundary conditions of q(t), ∂q(t)/∂q0 and ∂q(t)/∂q1 at t = h.
    pub boundary: f64,
    /// Relative error of D1 L_d^ex + f_d^ex− = −p0 and D2 L_d^ex + f_d^ex+ = p1: integrals on the left, ends
    /// of the motion on the right.
    pub identity: f64,
    /// How much larger a variation of q1 is inside the segment than at its end: 1 away from conjugate
    /// points.
    pub growth: f64,
    /// The error at one end of the motion from one rounding at the other, relative to the largest of the
    /// motion.
    pub conditioning: f64,
}

impl SegmentReport {
    /// The largest of the error estimates: `difference`, `boundary`, `identity` and `conditioning`.
    #[must_use]
    pub fn error(&self) -> f64 {
        largest([self.difference, self.boundary, self.identity, self.conditioning])
    }
}

impl fmt::Display for SegmentReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} Newton iterations, {} integration steps; relative errors: integration {:.1e}, boundary {:.1e}, \
             identity D L_d + f_d = ∓p {:.1e}, conditioning {:.1e}; growth {:.1e}",
            self.iterations,
            self.steps,
            self.difference,
            self.boundary,
            self.identity,
            self.conditioning,
            self.growth
        )?;
        if self.continuation > 0 {
            write!(f, "; followed through {} smaller step sizes", self.continuation)?;
        }
        Ok(())
    }
}

impl<const N: usize> fmt::Display for ExactSegment<N> {
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
pub(super) fn along<L, const N: usize>(
    boundary: &Boundary<'_, L, N>,
    h: f64,
    shot: &Shot<N>,
) -> Result<ExactSegment<N>, ExactError>
where
    L: ActingForce<N, Scalar = f64>,
{
    let Boundary { dynamics, q0, q1 } = *boundary;
    let local = dynamics.local(0.0, &q0, &shot.v0).map_err(|breakdown| breakdown.at(0.0, dynamics.work))?;
    // At fixed q1 a variation of q0 changes p0 by −(∂q(h)/∂p0)⁻¹ ∂q(h)/∂q0; at fixed q0 one of q1 by
    // (∂q(h)/∂p0)⁻¹.
    let start = Point {
        q: q0,
        p: local.l.d2,
        v: shot.v0,
        minus: Family { q: SMatrix::identity(), p: -(shot.inverse * shot.end.minus.q) },
        plus: Family { q: SMatrix::zeros(), p: shot.inverse },
    };

    // Beside the motion: L, its two first variations, and the work of f on both families.
    let visitor = || -> Box<Visitor<'_, N>> {
        Box::new(|step, varied, sums| {
            for (i, stage) in step.stages.iter().enumerate() {
                let (l, f) = (&stage.local.l, &stage.local.f);
                sums.add(0, stage.weight * l.value);
                for (column, varied) in varied.iter().enumerate() {
                    let (q, v) = varied.stages[i];
                    sums.add(1 + column, stage.weight * (l.d1.dot(&q) + l.d2.dot(&v)));
                    sums.add(1 + 2 * N + column, stage.weight * f.value.dot(&q));
                }
            }
        })
    };
    // Rounding that the motion enlarges differs from mesh to mesh.
    let rounding = ROUNDING.max(100.0 * shot.conditioning);
    let question = Question { blocks: &[1, 2 * N, 2 * N], visitor: &visitor, rounding };
    let resolved = dynamics.resolve(&start, h, &question)?;

    let end = resolved.carried.end;
    let vector = |first: usize| SVector::from_column_slice(&resolved.sums[first..first + N]);
    let lagrangian = Gradient { value: resolved.sums[0], d1: vector(1), d2: vector(1 + N) };
    let force = DiscreteForce { minus: vector(1 + 2 * N), plus: vector(1 + 3 * N) };
    let p0 = CovectorDerivatives { value: start.p, d1: start.minus.p, d2: start.plus.p };
    let p1 = CovectorDerivatives { value: end.p, d1: end.minus.p, d2: end.plus.p };

    let most = |block: usize| {
        let first: usize = Point::<N>::BLOCKS[..block].iter().sum();
        largest(resolved.carried.largest[first..first + Point::<N>::BLOCKS[block]].iter().copied())
    };
    let of = |entries: &[f64]| largest(entries.iter().copied());
    let boundary = largest([
        relative(of((end.q - q1).as_slice()), most(0)),
        relative(of(end.minus.q.as_slice()), most(3)),
        relative(of((end.plus.q - SMatrix::identity()).as_slice()), most(5)),
    ]);
    let size = largest(
        [&lagrangian.d1, &lagrangian.d2, &force.minus, &force.plus, &p0.value, &p1.value]
            .into_iter()
            .flat_map(|vector| vector.iter().copied()),
    );
    let identity = largest([
        relative(of((lagrangian.d1 + force.minus + p0.value).as_slice()), size),
        relative(of((lagrangian.d2 + force.plus - p1.value).as_slice()), size),
    ]);
    Ok(ExactSegment {
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
            conditioning: shot.conditioning,
        },
        course: Course { reversed: false, quarters: resolved.carried.quarters },
    })
}

impl<const N: usize> ExactSegment<N> {
    /// The segment from q1 back to q0, its time running backwards: L_d changes its sign, and both ends change
    /// places.
    pub(super) fn reversed(self) -> Self {
        let turned =
            |p: CovectorDerivatives<f64, N>| CovectorDerivatives { value: p.value, d1: p.d2, d2: p.d1 };
        Self {
            q0: self.q1,
            q1: self.q0,
            h: -self.h,
            v0: self.v1,
            v1: self.v0,
            lagrangian: Gradient {
                value: -self.lagrangian.value,
                d1: -self.lagrangian.d2,
                d2: -self.lagrangian.d1,
            },
            force: DiscreteForce { minus: -self.force.plus, plus: -self.force.minus },
            p0: turned(self.p1),
            p1: turned(self.p0),
            report: self.report,
            course: Course { reversed: !self.course.reversed, ..self.course },
        }
    }
}

/// |error|/scale, 0 where there is no error.
fn relative(error: f64, scale: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / scale }
}
