use core::fmt;

use crate::numbers::Scalar;
use crate::step::{Discrete, DiscreteForceDerivatives, Discretised};
use crate::theory::{
    restriction::at_segment_on_constraints,
    samples::{
        Pair, SampleError, Tolerance, at_several_times, require_informative, require_step_size, worst,
    },
    verdict::{Finding, largest, scales},
};

/// One of the three conditions, over the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition<const N: usize> {
    /// The asymmetry furthest above its tolerance.
    pub worst: Finding<Pair<f64, N>>,
    /// Its row and column.
    pub entry: (usize, usize),
}

impl<const N: usize> Condition<N> {
    /// Whether the condition is fulfilled to rounding at every sample.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.worst.vanishes()
    }
}

/// Whether f_d is Rayleigh, over a set of segments. See [`structure`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayleighStructure<const N: usize> {
    /// The step size.
    pub h: f64,
    /// Number of segments looked at.
    pub samples: usize,
    /// D1 f_d⁻ − (D1 f_d⁻)ᵀ; empty for n = 1.
    pub minus: Condition<N>,
    /// D2 f_d⁺ − (D2 f_d⁺)ᵀ; empty for n = 1.
    pub plus: Condition<N>,
    /// D1 f_d⁺ + (D2 f_d⁻)ᵀ, the condition that the paper prints.
    pub mixed: Condition<N>,
    /// Rounding allowed, relative to the terms.
    pub tolerance: f64,
}

impl<const N: usize> RayleighStructure<N> {
    /// Whether f_d⁻ = D1 R_d and f_d⁺ = −D2 R_d for a function R_d, in a simply connected region like that
    /// sampled.
    #[must_use]
    pub fn is_rayleigh(&self) -> bool {
        self.allows_resplit() && self.mixed.holds()
    }

    /// Whether L_d^± with −D1 L_d⁺ = p0 and D2 L_d⁻ = p1 exist; see [`Resplit`](super::Resplit).
    #[must_use]
    pub fn allows_resplit(&self) -> bool {
        self.minus.holds() && self.plus.holds()
    }
}

/// Tests the three conditions for R_d to exist, on `segments`.
///
/// They say that the matrix ∂(f_d⁻, −f_d⁺)/∂(q0, q1), which would be the matrix of second derivatives of R_d,
/// is symmetric; on holonomic constraints, on vectors tangent to them: whether f_d restricted to N×N is
/// Rayleigh. Segments have to be on them then: [`on_constraints`](crate::Discretised::on_constraints).
/// Entries are compared with 1024 ε (|Hᵢⱼ| + |Hⱼᵢ| + √|Hᵢᵢ Hⱼⱼ|), at their sample or as half of the samples
/// exceed it: a scale that follows the units of the coordinates.
///
/// **Segments it needs.** One that moves by more than rounding. Each is judged by itself, so that the
/// answer is about the segments given: spread them over a region, away from symmetric places. Fewer than
/// three of a view are asked again at later times.
///
/// # Errors
/// [`SampleError`] if there is no segment, none that moves, or a derivative is not finite.
pub fn structure<L, R, const N: usize>(
    system: &L,
    _rule: R,
    h: L::Scalar,
    segments: &[Pair<L::Scalar, N>],
) -> Result<RayleighStructure<N>, SampleError>
where
    L: Discrete<R, N>,
{
    const { Discretised::<L, R, N>::require_holonomic() };
    Discretised::<L, R, N>::new(system, h).tested_structure(segments)
}

/// Rayleigh forces.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// Tests the three conditions for R_d to exist, on `segments`:
    /// [`rayleigh::structure`](crate::rayleigh::structure()) of this system by this rule.
    ///
    /// # Errors
    /// Those of [`rayleigh::structure`](crate::rayleigh::structure()); [`SampleError::Stopped`].
    pub fn rayleigh_structure(
        &self,
        segments: &[Pair<L::Scalar, N>],
    ) -> Result<RayleighStructure<N>, SampleError> {
        const { Self::require_holonomic() };
        self.tested_structure(segments)
    }

    /// [`rayleigh_structure`](Self::rayleigh_structure) of whoever says itself which constraints it takes.
    pub(super) fn tested_structure(
        &self,
        segments: &[Pair<L::Scalar, N>],
    ) -> Result<RayleighStructure<N>, SampleError> {
        require_step_size(self.h)?;
        require_informative(segments, Pair::moves)?;
        let segments = &at_several_times(self, segments)[..];
        let derivatives = |(k, segment): (usize, &Pair<L::Scalar, N>)| {
            at_segment_on_constraints(self, k, segment, |by, ends| {
                let f = by.objects(&segment.q0, &segment.q1).force_derivatives();
                ends.map_or([f; 2], |ends| ends.restricted_force(&f))
            })
        };
        let hessians: Vec<_> = segments.iter().enumerate().map(derivatives).collect::<Result<_, _>>()?;
        // An asymmetry of derivatives that are not finite may still be 0.
        for (index, [f, _]) in hessians.iter().enumerate() {
            let entries = (0..2 * N).flat_map(|a| (0..2 * N).map(move |b| entry(f, a, b)));
            if !largest(entries).is_finite() {
                return Err(SampleError::NonFinite { index });
            }
        }
        // Rows and columns 0..N belong to q0, N..2N to q1.
        let condition = |rows: usize, columns: usize| {
            let mut worst: Option<Condition<N>> = None;
            for i in 0..N {
                for j in 0..N {
                    let (a, b) = (rows * N + i, columns * N + j);
                    let candidate = compare(segments, &hessians, a, b)?;
                    if worst.is_none_or(|known| candidate.excess() > known.worst.excess()) {
                        worst = Some(Condition { worst: candidate, entry: (i, j) });
                    }
                }
            }
            worst.ok_or(SampleError::TooFew { given: 0, needed: 1 })
        };
        Ok(RayleighStructure {
            h: self.h.widen(),
            samples: segments.len(),
            minus: condition(0, 0)?,
            plus: condition(1, 1)?,
            mixed: condition(1, 0)?,
            tolerance: Tolerance::rounding::<L::Scalar>(),
        })
    }
}

/// Entry (a, b) of ∂(f⁻, −f⁺)/∂(q0, q1).
fn entry<S: Scalar, const N: usize>(f: &DiscreteForceDerivatives<S, N>, a: usize, b: usize) -> f64 {
    let (covector, sign) = if a < N { (&f.minus, 1.0) } else { (&f.plus, -1.0) };
    let block = if b < N { &covector.d1 } else { &covector.d2 };
    sign * block[(a % N, b % N)].widen()
}

/// Entry (a, b) against (b, a), by derivatives and the sizes of their terms.
fn compare<S: Scalar, const N: usize>(
    segments: &[Pair<S, N>],
    hessians: &[[DiscreteForceDerivatives<S, N>; 2]],
    a: usize,
    b: usize,
) -> Result<Finding<Pair<f64, N>>, SampleError> {
    let size = |[_, f]: &[DiscreteForceDerivatives<S, N>; 2]| {
        // Roots first: a product of entries may overflow.
        let diagonal = entry(f, a, a).abs().sqrt() * entry(f, b, b).abs().sqrt();
        entry(f, a, b).abs() + entry(f, b, a).abs() + diagonal
    };
    let sizes: Vec<f64> = hessians.iter().map(size).collect();
    worst(segments, Tolerance::rounding::<S>(), &scales(&sizes), |index| {
        entry(&hessians[index][0], b, a) - entry(&hessians[index][0], a, b)
    })
}

impl<const N: usize> fmt::Display for RayleighStructure<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match (self.is_rayleigh(), self.allows_resplit()) {
            (true, _) => "f_d is Rayleigh",
            (false, true) => "f_d is not Rayleigh, but can be re-split into L_d⁺ and L_d⁻",
            (false, false) => "f_d is not Rayleigh, and no L_d⁺, L_d⁻ exist",
        };
        write!(f, "{verdict} ({} segments, h = {})", self.samples, self.h)?;
        for (name, condition) in [
            ("D1 f⁻ symmetric        ", &self.minus),
            ("D2 f⁺ symmetric        ", &self.plus),
            ("D1 f⁺ = −(D2 f⁻)ᵀ      ", &self.mixed),
        ] {
            let (i, j) = condition.entry;
            let verdict = if condition.holds() { "holds" } else { "FAILS" };
            write!(
                f,
                "\n  {name} {verdict}: {:+.2e} in entry ({i}, {j}), zero below {}",
                condition.worst.value,
                Tolerance { relative: self.tolerance, scale: condition.worst.terms }
            )?;
            if !condition.holds() {
                write!(f, "\n      at {}", condition.worst.at)?;
            }
        }
        Ok(())
    }
}
