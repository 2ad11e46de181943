use core::fmt;

use nalgebra::SVector;

use super::quadrature::between;
use super::residual::{keep_worse_gap, rounding_note};
use super::{Integral, RayleighStructure, SegmentFinding};
use crate::step::stop::Stop;
use crate::step::{Discrete, Discretised};
use crate::theory::{
    samples::{Pair, SampleError, Tolerance, at_segment, at_several_times},
    verdict::largest,
};

/// R_d recovered from f_d = (D1 R_d, −D2 R_d) by quadrature.
///
/// ```text
/// R_d(q0, q1) = ∫ f_d⁻·dq0 − f_d⁺·dq1      from the base, where R_d is set to 0
/// ```
///
/// R_d is determined up to that constant. It exists only where [`structure`](super::structure()) says so;
/// [`check`](Self::check) tests the integral itself along two paths.
pub struct Potential<'a, L, R, const N: usize>
where
    L: Discrete<R, N>,
{
    by: Discretised<'a, L, R, N>,
    base: Pair<L::Scalar, N>,
}

/// The recovered R_d over a set of segments. See [`Potential::check`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Recovery<const N: usize> {
    /// The conditions on the derivatives of f_d.
    pub structure: RayleighStructure<N>,
    /// R_d at each segment.
    pub values: Vec<f64>,
    /// Largest error estimate of the quadrature.
    pub quadrature_error: f64,
    /// R_d along the straight path less R_d along the edges of the box: 0 for every potential.
    pub path_dependence: SegmentFinding<N>,
    /// Rounding allowed, relative to ∫ |integrand|.
    pub tolerance: f64,
}

impl<const N: usize> Recovery<N> {
    /// Whether R_d exists: the conditions hold, and both paths agree.
    #[must_use]
    pub fn exists(&self) -> bool {
        self.structure.is_rayleigh() && self.path_dependence.vanishes()
    }
}

impl<'a, L, R, const N: usize> Potential<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The potential of the discrete force of `system` by `rule` with step size `h`, 0 at `base`.
    ///
    /// Where R(q, 0) = 0, a base at rest (a, a) gives the R_d of the rule itself.
    pub fn new(system: &'a L, _rule: R, h: L::Scalar, base: Pair<L::Scalar, N>) -> Self {
        const { Discretised::<L, R, N>::require_unconstrained() };
        Self { by: Discretised::new(system, h), base }
    }

    /// Ends [`check`](Self::check) as soon as `stop` is asked to end:
    /// [`Discretised::stopped_by`].
    #[must_use]
    pub fn stopped_by(self, stop: Stop<'a>) -> Self {
        Self { by: self.by.stopped_by(stop), ..self }
    }

    /// R_d(q0, q1) along the straight line from the base.
    pub fn at(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        along(&self.by, &self.base, &Pair { q0: *q0, q1: *q1 })
    }

    /// Recovers R_d at `segments`, along the straight path and along the edges of the box in Q×Q.
    ///
    /// **Segments it needs.** Those of [`structure`](super::structure()), away from the base.
    ///
    /// # Errors
    /// [`SampleError`] if there is no segment, none that moves, or a force on a path is not finite.
    pub fn check(&self, segments: &[Pair<L::Scalar, N>]) -> Result<Recovery<N>, SampleError> {
        let structure = self.by.tested_structure(segments)?;
        let given = segments.len();
        let segments = &at_several_times(&self.by, segments)[..];
        let relative = Tolerance::rounding::<L::Scalar>();
        let (mut values, mut quadrature_error, mut path_dependence) = (Vec::new(), 0.0_f64, None);
        for (index, segment) in segments.iter().enumerate() {
            let (straight, edges) = at_segment(&self.by, index, |by| {
                (along(by, &self.base, segment), along_edges(by, &self.base, segment))
            })?;
            let gap = straight + edges * -1.0;
            keep_worse_gap(&mut path_dependence, gap, relative, index, segment.widen())?;
            quadrature_error = largest([quadrature_error, straight.error]);
            values.extend((index < given).then_some(straight.value));
        }
        let path_dependence = path_dependence.ok_or(SampleError::TooFew { given: 0, needed: 1 })?;
        Ok(Recovery { structure, values, quadrature_error, path_dependence, tolerance: relative })
    }
}

/// R_d at `end` less R_d at `start`, along the straight line.
fn along<L: Discrete<R, N>, R, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    start: &Pair<L::Scalar, N>,
    end: &Pair<L::Scalar, N>,
) -> Integral {
    between(start, end, |q0, q1| by.objects(q0, q1).force())
}

/// That integral, one coordinate after the other, those of q0 first.
fn along_edges<L: Discrete<R, N>, R, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    start: &Pair<L::Scalar, N>,
    end: &Pair<L::Scalar, N>,
) -> Integral {
    let mut corner = *start;
    (0..2 * N).fold(Integral::ZERO, |sum, axis| {
        let from = corner;
        if axis < N {
            corner.q0[axis] = end.q0[axis];
        } else {
            corner.q1[axis - N] = end.q1[axis - N];
        }
        sum + along(by, &from, &corner)
    })
}

impl<const N: usize> fmt::Display for Recovery<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.structure)?;
        let (low, high) =
            self.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(*value), high.max(*value))
            });
        let verdict = match (self.structure.is_rayleigh(), self.path_dependence.vanishes()) {
            (true, true) => "the potential exists",
            (true, false) => {
                "the conditions hold, but paths disagree: a singularity lies between them, or a path leaves \
                              the region sampled"
            }
            (false, _) => "no potential",
        };
        writeln!(f, "R_d recovered: {verdict}")?;
        writeln!(
            f,
            "  values from {low:.6e} to {high:.6e}, quadrature error up to {:.1e}",
            self.quadrature_error
        )?;
        writeln!(f, "  between two paths: {}", self.path_dependence)?;
        rounding_note(f, self.tolerance)
    }
}
