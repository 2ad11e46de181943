use core::fmt;

use nalgebra::SVector;

use super::quadrature::{along_edges, along_line};
use super::residual::{keep_worse_gap, rounding_note};
use super::{Integral, RayleighStructure, SegmentFinding};
use crate::numbers::Scalar;
use crate::step::stop::Stop;
use crate::step::{Discrete, Discretised};
use crate::theory::{
    samples::{Pair, SampleError, Tolerance, at_segment, at_several_times},
    verdict::largest,
};

/// Any forced system as a Rayleigh one: L_d^± with −D1 L_d⁺ = p0 and D2 L_d⁻ = p1.
///
/// ```text
/// L_d⁺ = L_d + ∫ₐ^{q0} f_d⁻(s, q1)·ds,   L_d⁻ = L_d + ∫ₐ^{q1} f_d⁺(q0, s)·ds
/// L_d′ = ½(L_d⁺ + L_d⁻),   R_d′ = ½(L_d⁺ − L_d⁻)
/// ```
///
/// The new system (L_d′, R_d′) has the same Legendre transforms, and so the same flow and momenta, as (L_d,
/// f_d). For n = 1 it exists for every force; for n > 1 iff D1 f_d⁻ and D2 f_d⁺ are symmetric. The base a
/// fixes the free functions of integration: L_d⁺(a, q1) = L_d(a, q1) and L_d⁻(q0, a) = L_d(q0, a).
pub struct Resplit<'a, L, R, const N: usize>
where
    L: Discrete<R, N>,
{
    by: Discretised<'a, L, R, N>,
    base: SVector<L::Scalar, N>,
}

/// Whether the re-split exists, over a set of segments. See [`Resplit::check`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ResplitReport<const N: usize> {
    /// The conditions on the derivatives of f_d; the first two decide.
    pub structure: RayleighStructure<N>,
    /// ∫ f_d⁻·ds along the straight line less that along coordinate edges.
    pub plus: SegmentFinding<N>,
    /// ∫ f_d⁺·ds along the straight line less that along coordinate edges.
    pub minus: SegmentFinding<N>,
    /// Largest error estimate of the quadrature.
    pub quadrature_error: f64,
    /// Rounding allowed, relative to ∫ |integrand|.
    pub tolerance: f64,
}

impl<const N: usize> ResplitReport<N> {
    /// Whether L_d⁺ and L_d⁻ exist: D1 f_d⁻ and D2 f_d⁺ are symmetric, and the integrals depend on no path.
    #[must_use]
    pub fn exists(&self) -> bool {
        self.structure.allows_resplit() && self.plus.vanishes() && self.minus.vanishes()
    }
}

impl<'a, L, R, const N: usize> Resplit<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The re-split of `system` by `rule` with step size `h`; `base` is the point a.
    pub fn new(system: &'a L, _rule: R, h: L::Scalar, base: impl Into<SVector<L::Scalar, N>>) -> Self {
        const { Discretised::<L, R, N>::require_unconstrained() };
        Self { by: Discretised::new(system, h), base: base.into() }
    }

    /// Ends [`check`](Self::check) as soon as `stop` is asked to end:
    /// [`Discretised::stopped_by`].
    #[must_use]
    pub fn stopped_by(self, stop: Stop<'a>) -> Self {
        Self { by: self.by.stopped_by(stop), ..self }
    }

    /// L_d⁺(q0, q1).
    pub fn modified_plus(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        self.lagrangian(q0, q1) + along_line(&self.base, q0, at_start(&self.by, q1))
    }

    /// L_d⁻(q0, q1).
    pub fn modified_minus(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        self.lagrangian(q0, q1) + along_line(&self.base, q1, at_end(&self.by, q0))
    }

    /// L_d′ = ½(L_d⁺ + L_d⁻).
    pub fn discrete_lagrangian(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        (self.modified_plus(q0, q1) + self.modified_minus(q0, q1)) * 0.5
    }

    /// R_d′ = ½(L_d⁺ − L_d⁻).
    pub fn discrete_rayleigh(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        (self.modified_plus(q0, q1) + self.modified_minus(q0, q1) * -1.0) * 0.5
    }

    /// Tests at `segments` whether the re-split exists.
    ///
    /// **Segments it needs.** Those of [`structure`](super::structure()), away from the base.
    ///
    /// # Errors
    /// [`SampleError`] if there is no segment, none that moves, or a force on a path is not finite.
    pub fn check(&self, segments: &[Pair<L::Scalar, N>]) -> Result<ResplitReport<N>, SampleError> {
        let structure = self.by.tested_structure(segments)?;
        let segments = &at_several_times(&self.by, segments)[..];
        let relative = Tolerance::rounding::<L::Scalar>();
        let (mut plus, mut minus, mut quadrature_error) = (None, None, 0.0_f64);
        for (index, segment) in segments.iter().enumerate() {
            let Pair { q0, q1 } = segment;
            let (straight, edges) = at_segment(&self.by, index, |by| {
                let (at_start, at_end) = (at_start(by, q1), at_end(by, q0));
                let straight = (along_line(&self.base, q0, &at_start), along_line(&self.base, q1, &at_end));
                let edges = (along_edges(&self.base, q0, &at_start), along_edges(&self.base, q1, &at_end));
                (straight, edges)
            })?;
            let gaps = (straight.0 + edges.0 * -1.0, straight.1 + edges.1 * -1.0);
            for (worst, gap) in [(&mut plus, gaps.0), (&mut minus, gaps.1)] {
                keep_worse_gap(worst, gap, relative, index, segment.widen())?;
            }
            quadrature_error = largest([quadrature_error, straight.0.error, straight.1.error]);
        }
        match (plus, minus) {
            (Some(plus), Some(minus)) => {
                Ok(ResplitReport { structure, plus, minus, quadrature_error, tolerance: relative })
            }
            _ => Err(SampleError::TooFew { given: 0, needed: 1 }),
        }
    }

    fn lagrangian(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        let value = self.by.objects(q0, q1).lagrangian().widen();
        Integral { value, error: L::Scalar::EPSILON.widen() * value.abs(), magnitude: value.abs() }
    }
}

/// s ↦ f_d⁻(s, q1).
fn at_start<L: Discrete<R, N>, R, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    q1: &SVector<L::Scalar, N>,
) -> impl Fn(&SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
    move |s| by.objects(s, q1).force().minus
}

/// s ↦ f_d⁺(q0, s).
fn at_end<L: Discrete<R, N>, R, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    q0: &SVector<L::Scalar, N>,
) -> impl Fn(&SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
    move |s| by.objects(q0, s).force().plus
}

impl<const N: usize> fmt::Display for ResplitReport<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.structure)?;
        let verdict =
            if self.exists() { "L_d⁺ and L_d⁻ exist" } else { "no L_d⁺ and L_d⁻ with these momenta" };
        writeln!(f, "re-split: {verdict}; quadrature error up to {:.1e}", self.quadrature_error)?;
        writeln!(f, "  L_d⁺ between two paths: {}", self.plus)?;
        writeln!(f, "  L_d⁻ between two paths: {}", self.minus)?;
        rounding_note(f, self.tolerance)
    }
}
