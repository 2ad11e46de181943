//! Residuals held against the rounding of the terms that they are the difference of.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::HamiltonJacobiError;
use crate::numbers::Scalar;
use crate::step::LegendreDerivatives;
use crate::theory::verdict::{Finding, is_zero, largest, tells};

/// Residual of an equation, where it is worst among the places where it was evaluated.
///
/// ```text
/// tolerance = relative · magnitude,    magnitude = sum of the sizes of the terms, in the unit of the residual
/// ```
///
/// For momenta the magnitude is |p| + Σ |∂p/∂q||q|, so that the rounding of q0 and q1 themselves is covered;
/// for configurations it is |q| + |∂q/∂p| · (magnitude of p). "Worst" is the largest residual in units of its
/// tolerance.
///
/// A place tells something where the tolerance is less than the terms themselves: not on a caustic, where the
/// slope of a section makes the rounding of q larger than the momenta, nor where all terms are 0.
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
    /// Number of places that tell something.
    pub telling: usize,
    /// Number of steps k at none of whose places the tolerance leaves anything to be told.
    pub silent: usize,
}

/// An equation's residual, or why it could not be evaluated.
pub type Outcome<const N: usize> = Result<Residual<N>, HamiltonJacobiError>;

impl<const N: usize> Residual<N> {
    /// Whether the equation holds to rounding wherever it was evaluated, one place at least telling
    /// something, and no step silent.
    #[must_use]
    pub fn holds(&self) -> bool {
        is_zero(self.size, self.tolerance) && self.tells()
    }

    fn tells(&self) -> bool {
        self.telling > 0 && self.silent == 0
    }
}

impl<const N: usize> fmt::Display for Residual<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match (is_zero(self.size, self.tolerance), self.tells()) {
            (true, false) => "SAYS NOTHING",
            (true, true) => "holds",
            (false, _) => "FAILS",
        };
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
    /// The step and q.
    worst: Option<Finding<(usize, SVector<f64, N>)>>,
    places: usize,
    telling: usize,
    silent: usize,
    /// The step of the last place, and whether its places tell something, or leave nothing to be told.
    latest: Option<(usize, bool, bool)>,
    failed: Option<HamiltonJacobiError>,
}

impl<const N: usize> Worst<N> {
    pub(super) fn new(relative: f64) -> Self {
        Self { relative, worst: None, places: 0, telling: 0, silent: 0, latest: None, failed: None }
    }

    /// Takes in a covector or a point, component by component: `terms` are the sizes of the terms,
    /// `magnitude` those with the rounding of what they are evaluated at.
    pub(super) fn vector<S: Scalar>(
        &mut self,
        step: usize,
        q: &SVector<S, N>,
        residual: &SVector<S, N>,
        terms: &SVector<S, N>,
        magnitude: &SVector<S, N>,
    ) {
        self.places += 1;
        let tells = |i: usize| self.tells(terms[i].widen(), magnitude[i].widen());
        let forgives = |i: usize| self.relative * magnitude[i].widen() != 0.0;
        self.place(step, (0..N).any(tells), (0..N).any(forgives));
        for i in 0..N {
            self.consider(step, q, residual[i].widen().abs(), magnitude[i].widen());
        }
    }

    /// Takes in M − Mᵀ; `magnitude` holds the sizes of the entries of M. That a matrix of zeros is symmetric
    /// tells something.
    pub(super) fn antisymmetric_part<S: Scalar>(
        &mut self,
        step: usize,
        q: &SVector<S, N>,
        matrix: &SMatrix<S, N, N>,
        magnitude: &SMatrix<S, N, N>,
    ) {
        self.places += 1;
        let entries = magnitude.iter().chain(matrix.iter()).map(|entry| entry.widen());
        let tells = largest(entries).is_finite() && tells(self.relative, 1.0);
        self.place(step, tells, true);
        for i in 0..N {
            for j in 0..=i {
                // An entry on the diagonal is its own opposite, unless it is not finite.
                let size = (matrix[(i, j)] - matrix[(j, i)]).widen().abs();
                self.consider(step, q, size, (magnitude[(i, j)] + magnitude[(j, i)]).widen());
            }
        }
    }

    /// Takes in a number; `terms` and `magnitude` as for [`vector`](Self::vector).
    pub(super) fn number<S: Scalar>(
        &mut self,
        step: usize,
        q: &SVector<S, N>,
        residual: S,
        terms: S,
        magnitude: S,
    ) {
        self.places += 1;
        let tells = self.tells(terms.widen(), magnitude.widen());
        self.place(step, tells, self.relative * magnitude.widen() != 0.0);
        self.consider(step, q, residual.widen().abs(), magnitude.widen());
    }

    /// Counts a place of a step: whether it tells something, and whether there is anything that it forgives.
    fn place(&mut self, step: usize, tells: bool, forgives: bool) {
        self.telling += usize::from(tells);
        self.latest = match self.latest {
            Some((latest, told, forgave)) if latest == step => {
                Some((step, told || tells, forgave || forgives))
            }
            _ => {
                self.silent += self.is_silent();
                Some((step, tells, forgives))
            }
        };
    }

    /// 1 if the latest step has told nothing, and forgiven all.
    fn is_silent(&self) -> usize {
        usize::from(matches!(self.latest, Some((_, false, true))))
    }

    /// Whether the tolerance leaves something of the terms, which are there.
    fn tells(&self, terms: f64, magnitude: f64) -> bool {
        terms > 0.0 && tells(self.relative * magnitude, terms)
    }

    /// Takes in an evaluation that failed; the first failure is the outcome.
    pub(super) fn failure(&mut self, error: HamiltonJacobiError) {
        self.failed.get_or_insert(error);
    }

    fn consider<S: Scalar>(&mut self, step: usize, q: &SVector<S, N>, size: f64, magnitude: f64) {
        let tolerance = self.relative * magnitude;
        let at = (step, q.map(|entry| entry.widen()));
        Finding::bounded(size, tolerance, magnitude, at).keep_if_worse(&mut self.worst, Finding::excess);
    }

    pub(super) fn outcome(self) -> Outcome<N> {
        match (self.failed, self.worst) {
            (Some(error), _) => Err(error),
            (None, Some(Finding { value: size, tolerance, at: (step, q), .. })) => Ok(Residual {
                size,
                tolerance,
                step,
                q,
                places: self.places,
                telling: self.telling,
                silent: self.silent + self.is_silent(),
            }),
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
