use core::fmt;

use crate::samples::{SampleError, Segment, Tolerance, Worst};
use crate::{Discrete, DiscreteForceDerivatives, Scalar};

/// One of the three conditions, over the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition<const N: usize> {
    /// The asymmetry furthest above its tolerance.
    pub worst: Worst<N>,
    /// Its row and column.
    pub entry: (usize, usize),
    /// What counts as zero for that entry.
    pub tolerance: Tolerance,
}

impl<const N: usize> Condition<N> {
    /// Whether the condition is fulfilled to rounding at every sample.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.tolerance.covers(self.worst.value)
    }
}

/// Whether f_d is Rayleigh, over a set of segments. See [`structure`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Structure<const N: usize> {
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
}

impl<const N: usize> Structure<N> {
    /// Whether f_d⁻ = D1 R_d and f_d⁺ = −D2 R_d for a function R_d, in a simply connected region like that sampled.
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
/// They say that the matrix ∂(f_d⁻, −f_d⁺)/∂(q0, q1), which would be the matrix of second derivatives of R_d, is symmetric.
/// Entries are compared with 1024 ε (|Hᵢⱼ| + |Hⱼᵢ| + √|Hᵢᵢ Hⱼⱼ|), the largest over the samples: a scale that follows the
/// units of the coordinates.
///
/// # Errors
/// [`SampleError`] if there is no segment or a derivative is not finite.
pub fn structure<L, R, const N: usize>(
    system: &L,
    _rule: R,
    h: L::Scalar,
    segments: &[Segment<L::Scalar, N>],
) -> Result<Structure<N>, SampleError>
where
    L: Discrete<R, N>,
{
    structure_of::<L, R, N>(system, h, segments)
}

/// [`structure`] for a rule that only the type names.
pub(super) fn structure_of<L, R, const N: usize>(
    system: &L,
    h: L::Scalar,
    segments: &[Segment<L::Scalar, N>],
) -> Result<Structure<N>, SampleError>
where
    L: Discrete<R, N>,
{
    let hessians: Vec<_> = segments
        .iter()
        .map(|segment| system.discrete_force_derivatives(&segment.q0, &segment.q1, h))
        .collect();
    // Rows and columns 0..N belong to q0, N..2N to q1.
    let condition = |rows: usize, columns: usize| {
        let mut worst: Option<Condition<N>> = None;
        for i in 0..N {
            for j in 0..N {
                let (a, b) = (rows * N + i, columns * N + j);
                let candidate = compare(segments, &hessians, a, b)?;
                let ratio = |condition: &Condition<N>| match condition.worst.value {
                    0.0 => 0.0,
                    value => value.abs() / condition.tolerance.bound(),
                };
                if worst.is_none_or(|worst| ratio(&candidate) > ratio(&worst)) {
                    worst = Some(Condition { entry: (i, j), ..candidate });
                }
            }
        }
        worst.ok_or(SampleError::TooFew { given: 0, needed: 1 })
    };
    Ok(Structure {
        h: h.widen(),
        samples: segments.len(),
        minus: condition(0, 0)?,
        plus: condition(1, 1)?,
        mixed: condition(1, 0)?,
    })
}

/// Entry (a, b) of ∂(f⁻, −f⁺)/∂(q0, q1).
fn entry<S: Scalar, const N: usize>(f: &DiscreteForceDerivatives<S, N>, a: usize, b: usize) -> f64 {
    let (covector, sign) = if a < N { (&f.minus, 1.0) } else { (&f.plus, -1.0) };
    let block = if b < N { &covector.d1 } else { &covector.d2 };
    sign * block[(a % N, b % N)].widen()
}

fn compare<S: Scalar, const N: usize>(
    segments: &[Segment<S, N>],
    hessians: &[DiscreteForceDerivatives<S, N>],
    a: usize,
    b: usize,
) -> Result<Condition<N>, SampleError> {
    let scale = hessians
        .iter()
        .map(|f| {
            let diagonal = (entry(f, a, a) * entry(f, b, b)).abs().sqrt();
            entry(f, a, b).abs() + entry(f, b, a).abs() + diagonal
        })
        .fold(0.0, f64::max);
    let worst =
        Worst::of(segments, |index, _| entry(&hessians[index], b, a) - entry(&hessians[index], a, b))?;
    let tolerance = Tolerance { relative: Tolerance::rounding::<S>(), scale };
    Ok(Condition { worst, entry: (a % N, b % N), tolerance })
}

impl<const N: usize> fmt::Display for Structure<N> {
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
                condition.worst.value, condition.tolerance
            )?;
            if !condition.holds() {
                write!(f, "\n      at {}", condition.worst.at)?;
            }
        }
        Ok(())
    }
}
