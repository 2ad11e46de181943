//! Pairs (L_d, R_d) with D1D2R_d = κ D1D2L_d: what makes their steps conformally symplectic.

use core::fmt;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{Discrete, DiscreteRayleigh, Discretised};
use crate::theory::samples::{
    Pair, SampleError, Sizes, Tolerance, around, at_segment, different, require_informative,
    require_step_size,
};
use crate::theory::verdict::{Finding, largest};

/// Whether R_d is a multiple of L_d up to functions of one end:
/// [`proportion`](crate::Discretised::proportion).
///
/// ```text
/// D1D2R_d = κ D1D2L_d,  κ constant     iff, on a product of regions,     R_d = κL_d + α(q0) + β(q1)
/// ```
///
/// The step of a regular pair, det D1D2L_d⁺ ≠ 0, is conformally symplectic, AᵀΩA = cΩ, if and only if that is
/// so, and then c = (1 − κ)/(1 + κ).
///
/// *Proof.* In the coordinates (q0, q1) the symplectic forms at both ends are
///
/// ```text
/// dq0 ∧ dp0 = −(D1D2L_d⁺)ᵢⱼ dq0ⁱ ∧ dq1ʲ,     dq1 ∧ dp1 = −(D1D2L_d⁻)ᵢⱼ dq0ⁱ ∧ dq1ʲ
/// ```
///
/// so that the second is c times the first iff D1D2(L_d − R_d) = c D1D2(L_d + R_d). ∎
///
/// For n = 1 some function κ(q0, q1) always exists: there only its constancy over the segments is looked at,
/// so that two at least are needed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Proportion<const N: usize> {
    /// How many segments were looked at.
    pub samples: usize,
    /// The κ that was tried, by least squares.
    pub kappa: f64,
    /// D1D2R_d − κ D1D2L_d where it is furthest above its tolerance.
    pub defect: Finding<Pair<f64, N>>,
    /// Its row and column.
    pub entry: (usize, usize),
}

impl<const N: usize> Proportion<N> {
    /// Whether D1D2R_d = κ D1D2L_d with one κ on all segments.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.defect.vanishes() && self.kappa.is_finite()
    }

    /// c = (1 − κ)/(1 + κ); infinite for κ = −1, where L_d⁺ is degenerate.
    #[must_use]
    pub fn factor(&self) -> f64 {
        (1.0 - self.kappa) / (1.0 + self.kappa)
    }
}

/// Why nothing can be said of D1D2R_d and D1D2L_d.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ProportionError {
    /// The segments cannot be judged.
    Samples(SampleError),
    /// The step feels a force beside R: its R_d is not all of f_d.
    OtherForce {
        /// Number of the segment, from 0.
        index: usize,
    },
    /// D1D2L_d = 0: L_d is degenerate, and κ is not determined.
    Degenerate,
}

impl From<SampleError> for ProportionError {
    fn from(error: SampleError) -> Self {
        Self::Samples(error)
    }
}

/// The parts of R_d = κL_d + α(q0) + β(q1), and the generating function of its step.
///
/// With ρ = R_d − κL_d and a base point a,
///
/// ```text
/// α(q0) = ρ(q0, a),     β(q1) = ρ(a, q1) − ρ(a, a)
/// G = (1 − κ)L_d + cα(q0) − β(q1),     p1 = D2G,   c p0 = −D1G,     c = (1 − κ)/(1 + κ)
/// ```
///
/// No quadrature: α and β are determined up to a constant, which is set by α(a) = ρ(a, a), β(a) = 0. Far from
/// a, at distances ≫ h|v|, the kinetic terms of ρ cancel and leave their rounding.
///
/// *Proof.* p1 = D2(L_d − R_d) = D2((1 − κ)L_d − β), and c p0 = −c D1(L_d + R_d), which is −D1((1 − κ)L_d +
/// cα) since c(1 + κ) = 1 − κ. ∎
#[derive(Debug)]
pub struct ProportionalSplit<'a, L, R, const N: usize>
where
    L: Discrete<R, N>,
{
    pub(in crate::theory) by: Discretised<'a, L, R, N>,
    kappa: L::Scalar,
    base: SVector<L::Scalar, N>,
}

impl<S, L, R, const N: usize> ProportionalSplit<'_, L, R, N>
where
    S: Scalar,
    L: DiscreteRayleigh<R, N, Scalar = S>,
{
    /// κ.
    pub fn kappa(&self) -> S {
        self.kappa
    }

    /// c = (1 − κ)/(1 + κ).
    pub fn factor(&self) -> S {
        (S::one() - self.kappa) / (S::one() + self.kappa)
    }

    /// α(q0) = ρ(q0, a).
    pub fn alpha(&self, q0: &SVector<S, N>) -> S {
        self.remainder(q0, &self.base)
    }

    /// β(q1) = ρ(a, q1) − ρ(a, a).
    pub fn beta(&self, q1: &SVector<S, N>) -> S {
        self.remainder(&self.base, q1) - self.remainder(&self.base, &self.base)
    }

    /// G(q0, q1), with p1 = D2G and c p0 = −D1G.
    pub fn generating_function(&self, q0: &SVector<S, N>, q1: &SVector<S, N>) -> S {
        let lagrangian = self.by.discrete_lagrangian(q0, q1);
        (S::one() - self.kappa) * lagrangian + self.factor() * self.alpha(q0) - self.beta(q1)
    }

    /// ρ = R_d − κL_d.
    fn remainder(&self, q0: &SVector<S, N>, q1: &SVector<S, N>) -> S {
        let segment = self.by.between(q0, q1);
        self.by.system.discrete_rayleigh(&segment) - self.kappa * self.by.system.discrete_lagrangian(&segment)
    }
}

/// Conformal pairs.
impl<'a, S, L, R, const N: usize> Discretised<'a, L, R, N>
where
    S: Scalar,
    L: DiscreteRayleigh<R, N, Scalar = S>,
{
    /// Whether D1D2R_d = κ D1D2L_d on the `segments`, with one κ. See
    /// [`Proportion`](crate::rayleigh::Proportion).
    ///
    /// **Segments it needs.** One that moves by more than rounding, or for n = 1 two that lie apart
    /// ([`samples`](crate::samples)). It is asked at 2n more, each of which differs from the first in one
    /// coordinate of q0 or of q1 − q0: towards another of the segments given, or by its own size. The k-th
    /// of all is asked k h after the time of a view. The answer is about these.
    ///
    /// # Errors
    /// A [`ProportionError`](crate::rayleigh::ProportionError).
    pub fn proportion(&self, segments: &[Pair<S, N>]) -> Result<Proportion<N>, ProportionError> {
        const { Self::require_unconstrained() };
        require_step_size(self.h)?;
        require_informative(segments, Pair::moves)?;
        let needed = if N == 1 { 2 } else { 1 };
        let sizes = Sizes::of(segments.iter().copied());
        let mut blocks = Vec::new();
        let beside = around(segments, &sizes, [1.0, self.h.widen().abs()]);
        let mut asked = Vec::new();
        for (index, segment) in segments.iter().chain(&beside).enumerate() {
            let Pair { q0, q1 } = segment;
            // Beside the segments given a system may end.
            let is_given = index < segments.len();
            let (l, r, f) = at_segment(self, index, |by| {
                let (system, segment) = (by.system, &by.between(q0, q1));
                (
                    system.discrete_lagrangian_derivatives(segment),
                    system.discrete_rayleigh_derivatives(segment),
                    system.discrete_force(segment),
                )
            })
            .map_err(SampleError::from)?;
            let entries = l.d12.iter().chain(r.d12.iter()).chain(f.minus.iter()).chain(f.plus.iter());
            if !largest(entries.map(|entry| entry.widen())).is_finite() {
                if is_given {
                    return Err(SampleError::NonFinite { index }.into());
                }
                continue;
            }
            let other = (f.minus - r.d1).amax().max((f.plus + r.d2).amax()).widen();
            let size = r.d1.amax().max(r.d2.amax()).widen();
            if other > Tolerance::rounding::<S>() * size {
                return Err(ProportionError::OtherForce { index });
            }
            blocks.push((l.d12.map(Scalar::widen), r.d12.map(Scalar::widen)));
            asked.push(*segment);
        }
        let given = different(segments, &sizes, needed);
        if given < needed {
            return Err(SampleError::TooFew { given, needed }.into());
        }
        let (products, squares) =
            blocks.iter().fold((0.0, 0.0), |sum, (l, r)| (sum.0 + l.dot(r), sum.1 + l.norm_squared()));
        if squares == 0.0 {
            return Err(ProportionError::Degenerate);
        }
        let (kappa, relative) = (products / squares, Tolerance::rounding::<S>());
        let mut worst: Option<Finding<(usize, (usize, usize))>> = None;
        for (index, (l, r)) in blocks.iter().enumerate() {
            let size = (l * kappa).abs() + r.abs();
            for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
                // Entries off the diagonal are rounded like those that they stand between.
                let scale = size[(i, j)] + size[(i, i)].sqrt() * size[(j, j)].sqrt();
                let value = r[(i, j)] - kappa * l[(i, j)];
                Finding::relative(value, Tolerance { relative, scale }, (index, (i, j)))
                    .keep_if_worse(&mut worst, Finding::excess);
            }
        }
        let worst = worst.ok_or(SampleError::TooFew { given: 0, needed })?;
        let (index, entry) = worst.at;
        let tolerance = Tolerance { relative, scale: worst.terms };
        let defect = Finding::relative(worst.value, tolerance, asked[index].widen());
        Ok(Proportion { samples: asked.len(), kappa, defect, entry })
    }

    /// α, β and G of a pair with this `proportion`, from the `base` point a; `None` where κ is not constant,
    /// or −1.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Trapezoidal, rayleigh_system, samples};
    ///
    /// #[rayleigh_system(rule = trapezoidal)]
    /// fn well(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
    ///     let kinetic = 0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1]);
    ///     (kinetic - (q[0] * q[1]).sin() - q[0].powi(4), 2.0 * a * kinetic)
    /// }
    /// let (a, h) = (0.3, 0.2);
    /// let well = Well { a };
    /// let by = well.by(Trapezoidal, h);
    /// let proportion = by.proportion(&samples::segments([-1.0; 2], [1.0; 2], [0.3; 2], 20))?;
    /// assert!((proportion.kappa - a * h).abs() < 1e-15);
    ///
    /// // α = β = κ(h/2)V up to constants; V(0) = 0.
    /// let split = by.proportional_split(&proportion, [0.0, 0.0]).unwrap();
    /// let q = vector![0.5, 0.4];
    /// let potential = 0.2_f64.sin() + 0.5_f64.powi(4);
    /// assert!((split.alpha(&q) - a * h * h / 2.0 * potential).abs() < 1e-15);
    /// assert!((split.beta(&q) - split.alpha(&q)).abs() < 1e-15);
    /// # Ok::<(), dalembert::rayleigh::ProportionError>(())
    /// ```
    #[must_use]
    pub fn proportional_split(
        &self,
        proportion: &Proportion<N>,
        base: impl Into<SVector<S, N>>,
    ) -> Option<ProportionalSplit<'a, L, R, N>> {
        let kappa = S::constant(proportion.kappa);
        let regular = proportion.is_constant() && kappa != -S::one();
        regular.then(|| ProportionalSplit { by: *self, kappa, base: base.into() })
    }
}

impl<const N: usize> fmt::Display for Proportion<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { samples, kappa, defect, entry: (i, j) } = self;
        if self.is_constant() {
            let c = self.factor();
            writeln!(f, "R_d = κL_d + α(q0) + β(q1), κ = {kappa:.15}, c = {c:.15}; segments: {samples}")?;
        } else {
            writeln!(f, "R_d is no multiple of L_d up to functions of one end; segments: {samples}")?;
        }
        let answer = if self.is_constant() { "yes" } else { "no" };
        write!(f, "  D1D2R_d = κ D1D2L_d   {answer}: {defect}, entry ({i}, {j}), κ = {kappa:.6}")
    }
}

impl fmt::Display for ProportionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Samples(error) => error.fmt(f),
            Self::OtherForce { index } => write!(
                f,
                "segment {index} feels a force that is not of R, so that R_d is not all of f_d; see `structure` and \
                 `Resplit`, or ask the step itself, `conformal_step`"
            ),
            Self::Degenerate => f.write_str("D1D2L_d = 0: L_d is degenerate, no κ is determined"),
        }
    }
}

debug_by_display!(ProportionError);

impl core::error::Error for ProportionError {}
