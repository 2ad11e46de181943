//! Whether the exact discrete force is Rayleigh: the paper's existence criterion, for any number of degrees
//! of freedom.
//!
//! The paper (section 3.4, remark) asks D1 f_d⁺ = −D2 f_d⁻ and writes it, for the exact force and n = 1, as
//!
//! ```text
//! ∫₀ʰ [2 f_q ∂q/∂q0 ∂q/∂q1 + f_v ∂v/∂q0 ∂q/∂q1 + f_v ∂q/∂q0 ∂v/∂q1 + 2 f ∂²q/∂q0∂q1] dt = 0
//! ```
//!
//! For n > 1 the 1-form f_d⁻dq0 − f_d⁺dq1 = dR_d is closed iff three conditions hold, of which the printed
//! one, with a transpose, is the first:
//!
//! ```text
//! D1 f_d⁺ + (D2 f_d⁻)ᵀ = 0,   D1 f_d⁻ symmetric,   D2 f_d⁺ symmetric
//! ```

use core::fmt;

use nalgebra::SMatrix;

use super::second::SecondDerivatives;
use super::segment::ExactSegment;
use crate::theory::verdict::{Finding, largest};

/// How far the exact discrete force is from being Rayleigh at (q0, q1, h).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Existence<const N: usize> {
    /// D1 f_d^ex+ + (D2 f_d^ex−)ᵀ, shape N×N; the integral of the paper for N = 1.
    pub mixed: SMatrix<f64, N, N>,
    /// D1 f_d^ex− − (D1 f_d^ex−)ᵀ, shape N×N; 0 for N = 1.
    pub minus: SMatrix<f64, N, N>,
    /// D2 f_d^ex+ − (D2 f_d^ex+)ᵀ, shape N×N; 0 for N = 1.
    pub plus: SMatrix<f64, N, N>,
    /// The largest entry that counts as 0: ten times the error estimate of the Jacobians. One as large as the
    /// Jacobians themselves says nothing, and none of the conditions holds.
    pub tolerance: f64,
    /// The largest entry of the Jacobians D f_d^ex±.
    pub terms: f64,
    /// The step size.
    pub h: f64,
}

/// The verdict of the criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ExistenceVerdict {
    /// All three conditions hold to the tolerance at this point.
    Holds,
    /// f_d⁻ dq0 − f_d⁺ dq1 is not closed in the mixed block: no R_d, whatever n.
    MixedFails,
    /// The mixed condition holds, but D1 f_d⁻ or D2 f_d⁺ is not symmetric: no R_d, though the printed
    /// condition holds.
    SymmetryFails,
}

impl<const N: usize> Existence<N> {
    /// The largest entry of the three obstructions.
    #[must_use]
    pub fn largest(&self) -> f64 {
        largest([size(&self.mixed), size(&self.minus), size(&self.plus)])
    }

    fn holds(&self, obstruction: &SMatrix<f64, N, N>) -> bool {
        Finding::bounded(size(obstruction), self.tolerance, self.terms, ()).vanishes()
    }

    /// Which conditions hold.
    #[must_use]
    pub fn verdict(&self) -> ExistenceVerdict {
        match (self.holds(&self.mixed), self.holds(&self.minus) && self.holds(&self.plus)) {
            (true, true) => ExistenceVerdict::Holds,
            (true, false) => ExistenceVerdict::SymmetryFails,
            (false, _) => ExistenceVerdict::MixedFails,
        }
    }
}

impl<const N: usize> fmt::Display for Existence<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "is f_d^ex Rayleigh at this point? h = {}, tolerance {:.1e}", self.h, self.tolerance)?;
        for (name, obstruction) in [
            ("D1 f⁺ + (D2 f⁻)ᵀ      ", &self.mixed),
            ("D1 f⁻ − (D1 f⁻)ᵀ      ", &self.minus),
            ("D2 f⁺ − (D2 f⁺)ᵀ      ", &self.plus),
        ] {
            let verdict = if self.holds(obstruction) { "holds" } else { "fails" };
            writeln!(f, "  {name} {:.8e}  {verdict}", size(obstruction))?;
        }
        f.write_str(match self.verdict() {
            ExistenceVerdict::Holds => "  yes: all three conditions hold",
            ExistenceVerdict::MixedFails => "  no: there is no R_d",
            ExistenceVerdict::SymmetryFails => "  no: the mixed condition alone does not suffice",
        })
    }
}

/// The largest entry, NaN if one is.
fn size<const N: usize>(matrix: &SMatrix<f64, N, N>) -> f64 {
    largest(matrix.iter().copied())
}

pub(super) fn of<const N: usize>(segment: &ExactSegment<N>, second: &SecondDerivatives<N>) -> Existence<N> {
    let force = &second.force;
    Existence {
        mixed: force.plus.d1 + force.minus.d2.transpose(),
        minus: force.minus.d1 - force.minus.d1.transpose(),
        plus: force.plus.d2 - force.plus.d2.transpose(),
        tolerance: 10.0 * second.force_error,
        terms: largest([&force.minus.d1, &force.minus.d2, &force.plus.d1, &force.plus.d2].map(size)),
        h: segment.h,
    }
}
