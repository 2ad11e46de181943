use core::fmt;
use std::borrow::Cow;

use nalgebra::SVector;

use super::quadrature::{along_line, between};
use super::residual::{keep_worse, keep_worse_gap, rounding_note};
use super::{Integral, SegmentFinding};
use crate::numbers::Scalar;
use crate::step::stop::Stop;
use crate::step::{Discrete, DiscreteForce, Discretised};
use crate::theory::objects::del_residual;
use crate::theory::{
    samples::{
        Pair, SampleError, Stopped, Tolerance, at_segment, at_several_times, at_time_of, require_informative,
        require_step_size,
    },
    verdict::scales,
};

/// Two systems side by side: have they the same forced discrete Euler–Lagrange equations, and by which gauge?
///
/// With φ = L̃_d − L_d and χ = R̃_d − R_d (the latter from the forces), the equations are the same iff
///
/// ```text
/// φ = ψ(q0) + φ1(q1) + φ0(q0) − ψ(q1)
/// χ = ψ(q0) + φ1(q1) − φ0(q0) + ψ(q1)
/// ```
///
/// (paper, proposition of section 3.3, with the signs of χ corrected). Momenta then differ by p̃ − p = −2 dψ.
/// The three functions are determined up to constants; here ψ(a) = 0 and χ(a, a) = 0 at the base a:
///
/// ```text
/// ψ(q) = −½ ∫ₐ^q (p̃0 − p0)(s, a)·ds,   φ1(q) = ½(φ + χ)(a, q),   φ0(q) = ½(φ − χ)(q, a)
/// ```
///
/// Where the systems take the time, so do the three functions, and ψ(q1) is that of t + h.
pub struct Comparison<'a, L, R, M, T, const N: usize>
where
    L: Discrete<R, N>,
    M: Discrete<T, N, Scalar = L::Scalar>,
{
    ours: Discretised<'a, L, R, N>,
    theirs: Discretised<'a, M, T, N>,
    base: SVector<L::Scalar, N>,
}

/// Whether two systems are equivalent, over a set of segments. See [`Comparison::check`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Equivalence<const N: usize> {
    /// The step size.
    pub h: f64,
    /// Number of segments looked at.
    pub samples: usize,
    /// Difference of the forced discrete Euler–Lagrange equations.
    pub equations: SegmentFinding<N>,
    /// φ less its expression by ψ, φ0 and φ1.
    pub lagrangian: SegmentFinding<N>,
    /// χ less its expression by ψ, φ0 and φ1.
    pub rayleigh: SegmentFinding<N>,
    /// Rounding allowed, relative to the terms.
    pub tolerance: f64,
}

impl<const N: usize> Equivalence<N> {
    /// Whether the forced discrete Euler–Lagrange equations are the same.
    #[must_use]
    pub fn has_same_equations(&self) -> bool {
        self.equations.vanishes()
    }

    /// Whether ψ, φ0 and φ1 account for the difference of L_d and of f_d.
    ///
    /// Equal equations without a gauge mean that L_d differs by a φ with D1 D2 φ ≠ 0 that the forces undo,
    /// which two Rayleigh systems cannot do.
    #[must_use]
    pub fn is_gauge(&self) -> bool {
        self.has_same_equations() && self.lagrangian.vanishes() && self.rayleigh.vanishes()
    }
}

impl<'a, L, R, M, T, const N: usize> Comparison<'a, L, R, M, T, N>
where
    L: Discrete<R, N>,
    M: Discrete<T, N, Scalar = L::Scalar>,
{
    /// `system` by `rule` and `other` by `other_rule` at the same step size; `base` is the point a.
    pub fn new(
        (system, _rule): (&'a L, R),
        (other, _other_rule): (&'a M, T),
        h: L::Scalar,
        base: impl Into<SVector<L::Scalar, N>>,
    ) -> Self {
        const { Discretised::<L, R, N>::require_unconstrained() };
        const { Discretised::<M, T, N>::require_unconstrained() };
        Self { ours: Discretised::new(system, h), theirs: Discretised::new(other, h), base: base.into() }
    }

    /// Ends [`check`](Self::check) as soon as `stop` is asked to end:
    /// [`Discretised::stopped_by`].
    #[must_use]
    pub fn stopped_by(self, stop: Stop<'a>) -> Self {
        Self { ours: self.ours.stopped_by(stop), ..self }
    }

    /// ψ(q) − ψ(a).
    pub fn psi(&self, q: &SVector<L::Scalar, N>) -> Integral {
        let Self { ours, theirs, base } = self;
        let difference = |s: &SVector<L::Scalar, N>| {
            theirs.objects(s, base).momenta().p0 - ours.objects(s, base).momenta().p0
        };
        along_line(base, q, difference) * -0.5
    }

    /// φ0(q), a function of the earlier configuration alone.
    pub fn phi0(&self, q: &SVector<L::Scalar, N>) -> Integral {
        (self.phi(q, &self.base) + self.chi(q, &self.base) * -1.0) * 0.5
    }

    /// φ1(q), a function of the later configuration alone.
    pub fn phi1(&self, q: &SVector<L::Scalar, N>) -> Integral {
        (self.phi(&self.base, q) + self.chi(&self.base, q)) * 0.5
    }

    /// `evaluate` of both systems at the start of the k-th segment.
    fn at_segment<U>(
        &self,
        k: usize,
        evaluate: impl FnOnce(&Comparison<'_, L, R, M, T, N>) -> U,
    ) -> Result<U, Stopped> {
        at_segment(&self.ours, k, |ours| {
            at_time_of(&self.theirs, k, |theirs| {
                evaluate(&Comparison { ours: *ours, theirs: *theirs, base: self.base })
            })
        })
    }

    /// Compares the equations at (q0, q1, q1 + the next segment's displacement), and the gauge at (q0, q1).
    ///
    /// **Segments it needs.** One that moves by more than rounding. Each is judged by itself: the answer is
    /// about the segments given. Fewer than three of a view are asked again at later times.
    ///
    /// # Errors
    /// [`SampleError`] if there is no segment, none that moves, or a value is not finite.
    pub fn check(&self, segments: &[Pair<L::Scalar, N>]) -> Result<Equivalence<N>, SampleError> {
        require_step_size(self.ours.h)?;
        require_informative(segments, Pair::moves)?;
        let segments = &match at_several_times(&self.ours, segments) {
            Cow::Borrowed(segments) => at_several_times(&self.theirs, segments),
            repeated => repeated,
        }[..];
        let relative = Tolerance::rounding::<L::Scalar>();
        let third = |index: usize| {
            let next = &segments[(index + 1) % segments.len()];
            segments[index].q1 + (next.q1 - next.q0)
        };
        let sizes: Vec<SVector<f64, N>> = segments
            .iter()
            .enumerate()
            .map(|(k, segment)| {
                let first = self.at_segment(k, |both| both.momentum_sizes(&segment.q0, &segment.q1))?;
                let second = self.at_segment(k + 1, |both| both.momentum_sizes(&segment.q1, &third(k)))?;
                Ok(first + second)
            })
            .collect::<Result<_, Stopped>>()?;
        let scales: [Vec<f64>; N] =
            core::array::from_fn(|i| scales(&sizes.iter().map(|size| size[i]).collect::<Vec<_>>()));
        let (mut equations, mut lagrangian, mut rayleigh) = (None, None, None);
        for (index, segment) in segments.iter().enumerate() {
            let Pair { q0, q1 } = segment;
            let at = segment.widen();
            let (difference, [psi0, phi0, phi1, phi, chi]) = self.at_segment(index, |both| {
                let parts = [both.psi(q0), both.phi0(q0), both.phi1(q1), both.phi(q0, q1), both.chi(q0, q1)];
                (both.difference(q0, q1, &third(index)), parts)
            })?;
            let psi1 = self.at_segment(index + 1, |both| both.psi(q1))?;
            for (entry, scales) in difference.iter().zip(&scales) {
                let (entry, scale) = (entry.widen(), scales[index]);
                if !(entry.is_finite() && scale.is_finite()) {
                    return Err(SampleError::NonFinite { index });
                }
                keep_worse(&mut equations, entry, relative * scale, scale, at);
            }
            let phi = phi + (psi0 + phi1 + phi0 + psi1 * -1.0) * -1.0;
            let chi = chi + (psi0 + phi1 + phi0 * -1.0 + psi1) * -1.0;
            for (worst, gap) in [(&mut lagrangian, phi), (&mut rayleigh, chi)] {
                keep_worse_gap(worst, gap, relative, index, at)?;
            }
        }
        match (equations, lagrangian, rayleigh) {
            (Some(equations), Some(lagrangian), Some(rayleigh)) => Ok(Equivalence {
                h: self.ours.h.widen(),
                samples: segments.len(),
                equations,
                lagrangian,
                rayleigh,
                tolerance: relative,
            }),
            _ => Err(SampleError::TooFew { given: 0, needed: 1 }),
        }
    }

    /// φ = L̃_d − L_d.
    fn phi(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        let theirs = self.theirs.objects(q0, q1).lagrangian();
        let ours = self.ours.objects(q0, q1).lagrangian();
        let magnitude = theirs.widen().abs() + ours.widen().abs();
        Integral { value: (theirs - ours).widen(), error: L::Scalar::EPSILON.widen() * magnitude, magnitude }
    }

    /// χ = R̃_d − R_d, 0 at (a, a).
    fn chi(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> Integral {
        let (start, end) = (Pair { q0: self.base, q1: self.base }, Pair { q0: *q0, q1: *q1 });
        between(&start, &end, |q0, q1| {
            let theirs = self.theirs.objects(q0, q1).force();
            let ours = self.ours.objects(q0, q1).force();
            DiscreteForce { minus: theirs.minus - ours.minus, plus: theirs.plus - ours.plus }
        })
    }

    /// Of the forced discrete Euler–Lagrange equations.
    fn difference(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        q2: &SVector<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        let Self { ours, theirs, .. } = self;
        del_residual(theirs, q0, q1, q2) - del_residual(ours, q0, q1, q2)
    }

    /// The sizes of all momenta on a segment, coordinate by coordinate: the terms of the equations.
    fn momentum_sizes(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> SVector<f64, N> {
        let Self { ours, theirs, .. } = self;
        let (ours, theirs) = (ours.objects(q0, q1).momenta(), theirs.objects(q0, q1).momenta());
        (ours.p0.abs() + ours.p1.abs() + theirs.p0.abs() + theirs.p1.abs()).map(Scalar::widen)
    }
}

impl<const N: usize> fmt::Display for Equivalence<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match (self.has_same_equations(), self.is_gauge()) {
            (true, true) => "equivalent: the same equations, by a gauge ψ, φ0, φ1",
            (true, false) => "the same equations, but L_d and f_d differ by more than a gauge",
            (false, _) => "not equivalent: the equations differ",
        };
        writeln!(f, "{verdict} ({} segments, h = {})", self.samples, self.h)?;
        writeln!(f, "  difference of the equations:               {}", self.equations)?;
        writeln!(f, "  φ − [ψ(q0) + φ1(q1) + φ0(q0) − ψ(q1)]:      {}", self.lagrangian)?;
        writeln!(f, "  χ − [ψ(q0) + φ1(q1) − φ0(q0) + ψ(q1)]:      {}", self.rayleigh)?;
        rounding_note(f, self.tolerance)
    }
}
