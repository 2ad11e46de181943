//! Residuals held against the rounding of the terms that they are the difference of.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::HamiltonJacobiError;
use crate::{LegendreDerivatives, Scalar};

/// Residual of an equation, where it is worst among the places where it was evaluated.
///
/// ```text
/// tolerance = relative · magnitude,    magnitude = sum of the sizes of the terms, in the unit of the residual
/// ```
///
/// For momenta the magnitude is |p| + Σ |∂p/∂q||q|, so that the rounding of q0 and q1 themselves is covered; for
/// configurations it is |q| + |∂q/∂p| · (magnitude of p). "Worst" is the largest residual in units of its tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual<const N: usize> {
    /// Size of the residual at the worst place: its component that exceeds its tolerance most.
    pub size: f64,
    /// The tolerance there.
    pub tolerance: f64,
    /// The step k of the worst place.
    pub step: usize,
    /// q_k at the worst place.
    pub q: SVector<f64, N>,
    /// Number of places where the equation was evaluated.
    pub places: usize,
}

/// An equation's residual, or why it could not be evaluated.
pub type Outcome<const N: usize> = Result<Residual<N>, HamiltonJacobiError>;

impl<const N: usize> Residual<N> {
    /// Whether the equation holds to rounding wherever it was evaluated. A NaN does not hold.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.size <= self.tolerance
    }

    fn units(&self) -> f64 {
        units(self.size, self.tolerance)
    }
}

fn units(size: f64, tolerance: f64) -> f64 {
    if size == 0.0 {
        0.0
    } else if size.is_nan() || tolerance.is_nan() {
        f64::INFINITY
    } else {
        size / tolerance
    }
}

impl<const N: usize> fmt::Display for Residual<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.holds() { "holds" } else { "FAILS" };
        write!(
            f,
            "{verdict}  {:9.2e} (tolerance {:.1e}) at k = {}, q =",
            self.size, self.tolerance, self.step
        )?;
        for entry in &self.q {
            write!(f, " {entry:.4}")?;
        }
        Ok(())
    }
}

/// One line of a report: the equation and how it fares.
pub(super) fn line<const N: usize>(
    f: &mut fmt::Formatter<'_>,
    equation: &str,
    outcome: &Outcome<N>,
) -> fmt::Result {
    // Combining marks take no column.
    let width = equation.chars().filter(|c| !matches!(c, '\u{0300}'..='\u{036f}')).count();
    write!(f, "  {equation}{:pad$}", "", pad = 58_usize.saturating_sub(width))?;
    match outcome {
        Ok(residual) => writeln!(f, "  {residual}"),
        Err(error) => writeln!(f, "  not evaluated: {error}"),
    }
}

/// Says which tolerance a report used, and why.
pub(super) fn tolerance_line(f: &mut fmt::Formatter<'_>, relative: f64) -> fmt::Result {
    writeln!(
        f,
        "  tolerance: {relative:.1e} × size of the terms of each equation (what rounding leaves of their difference)"
    )
}

/// Finds the worst residual of one equation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worst<const N: usize> {
    relative: f64,
    worst: Option<Residual<N>>,
    places: usize,
    failed: Option<HamiltonJacobiError>,
}

impl<const N: usize> Worst<N> {
    pub(super) fn new(relative: f64) -> Self {
        Self { relative, worst: None, places: 0, failed: None }
    }

    /// Takes in a covector or a point, component by component.
    pub(super) fn vector<S: Scalar>(
        &mut self,
        step: usize,
        q: &SVector<S, N>,
        residual: &SVector<S, N>,
        magnitude: &SVector<S, N>,
    ) {
        self.places += 1;
        for i in 0..N {
            self.consider(step, q, residual[i].widen().abs(), magnitude[i].widen());
        }
    }

    /// Takes in M − Mᵀ; `magnitude` holds the sizes of the entries of M.
    pub(super) fn antisymmetric_part<S: Scalar>(
        &mut self,
        step: usize,
        q: &SVector<S, N>,
        matrix: &SMatrix<S, N, N>,
        magnitude: &SMatrix<S, N, N>,
    ) {
        self.places += 1;
        for i in 0..N {
            for j in 0..=i {
                let size = (matrix[(i, j)] - matrix[(j, i)]).widen().abs();
                self.consider(step, q, size, (magnitude[(i, j)] + magnitude[(j, i)]).widen());
            }
        }
    }

    /// Takes in a number.
    pub(super) fn number<S: Scalar>(&mut self, step: usize, q: &SVector<S, N>, residual: S, magnitude: S) {
        self.places += 1;
        self.consider(step, q, residual.widen().abs(), magnitude.widen());
    }

    /// Takes in an evaluation that failed; the first failure is the outcome.
    pub(super) fn failure(&mut self, error: HamiltonJacobiError) {
        self.failed.get_or_insert(error);
    }

    fn consider<S: Scalar>(&mut self, step: usize, q: &SVector<S, N>, size: f64, magnitude: f64) {
        let tolerance = self.relative * magnitude;
        if self.worst.is_none_or(|worst| units(size, tolerance) > worst.units()) {
            self.worst = Some(Residual { size, tolerance, step, q: q.map(|entry| entry.widen()), places: 0 });
        }
    }

    pub(super) fn outcome(self) -> Outcome<N> {
        match (self.failed, self.worst) {
            (Some(error), _) => Err(error),
            (None, Some(worst)) => Ok(Residual { places: self.places, ..worst }),
            (None, None) => Err(HamiltonJacobiError::TooFewPoints { needed: 1, found: 0 }),
        }
    }
}

/// The sizes of p0 and p1 with what the rounding of q0 and q1 makes of them.
pub(super) struct MomentumMagnitudes<S, const N: usize> {
    pub(super) p0: SVector<S, N>,
    pub(super) p1: SVector<S, N>,
}

impl<S: Scalar, const N: usize> MomentumMagnitudes<S, N> {
    pub(super) fn of(k: &LegendreDerivatives<S, N>, q0: &SVector<S, N>, q1: &SVector<S, N>) -> Self {
        let (q0, q1) = (q0.abs(), q1.abs());
        Self {
            p0: k.momenta.p0.abs() + k.p0_by_q0.abs() * q0 + k.p0_by_q1.abs() * q1,
            p1: k.momenta.p1.abs() + k.p1_by_q0.abs() * q0 + k.p1_by_q1.abs() * q1,
        }
    }
}
