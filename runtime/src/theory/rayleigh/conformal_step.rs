//! Conformally symplectic steps: by the step's derivative alone, whatever made the step.

use core::fmt;

use crate::numbers::Scalar;
use crate::step::{Discretised, Flow, PhaseMatrix, State, StepError};
use crate::theory::rayleigh::asked::{Unasked, ask, from_unasked};
use crate::theory::rayleigh::rayleigh_step::Entry;
use crate::theory::samples::STOPPED;
use crate::theory::verdict::{Finding, Tolerance, Verdict};

/// Whether a step multiplies the symplectic form by a constant:
/// [`conformal_step`](crate::Discretised::conformal_step).
///
/// ```text
/// AᵀΩA = cΩ,     Ω = [[0, I], [−I, 0]]
/// ```
///
/// with one c at all samples. In the blocks a, b, c′, d of A that is: aᵀc′ and bᵀd symmetric, aᵀd − c′ᵀb =
/// cI.
///
/// For n ≥ 2 a factor that is a function on a connected region is a constant, since d(cΩ) = dc ∧ Ω = 0. For n
/// = 1 AᵀΩA = det A Ω whatever A is: there only the constancy of det A over the samples is looked at, so that
/// two at least are needed.
///
/// | C = 2aM, any V | c |
/// |---|---|
/// | [`Trapezoidal`](crate::Trapezoidal) | (1 − ah)/(1 + ah) |
/// | [`FittedTrapezoidal`](crate::FittedTrapezoidal), [`Splitting`](crate::Splitting)s | e^{−2ah} |
///
/// A composition has the product of its steps' factors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ConformalStep {
    /// How many derivatives were looked at.
    pub samples: usize,
    /// The c that was tried: (1/n) tr(aᵀd − c′ᵀb) where that is known best.
    pub factor: f64,
    /// AᵀΩA − cΩ, where it is furthest above its tolerance; rows and columns 0 … 2n − 1, q before p. It
    /// cannot tell where some tolerance is as large as c.
    pub defect: Finding<Entry>,
}

/// Why it cannot be said of a step whether it is conformally symplectic.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ConformalStepError {
    /// Fewer samples than decide, of those that lie apart.
    TooFewSamples {
        /// Derivatives given, or states that lie apart by more than a derivative resolves.
        given: usize,
        /// 1, or 2 for n = 1, where each alone fulfils the condition.
        needed: usize,
    },
    /// The step moves no state by more than a derivative resolves, so that A is 1 to rounding: a much
    /// longer one tells.
    AtRest,
    /// A step could not be taken or differentiated.
    Step {
        /// The sample, from 0.
        sample: usize,
        /// Why.
        error: StepError,
    },
    /// An entry of A is not finite.
    NonFinite {
        /// The sample, from 0.
        sample: usize,
    },
    /// The caller has ended the check ([`stopped_by`](crate::Discretised::stopped_by)).
    Stopped,
}

from_unasked!(ConformalStepError);

/// AᵀΩA, with the size of the terms that each of its entries is a sum of.
struct PulledBack<'a, S, const N: usize>(&'a PhaseMatrix<S, N>);

impl<S: Scalar, const N: usize> PulledBack<'_, S, N> {
    fn column(&self, j: usize) -> impl Fn(usize) -> (f64, f64) + '_ {
        let Self(a) = *self;
        let (q, p) = if j < N { (&a.q_by_q, &a.p_by_q) } else { (&a.q_by_p, &a.p_by_p) };
        move |row| (q[(row, j % N)].widen(), p[(row, j % N)].widen())
    }

    /// ω(A eᵢ, A eⱼ), and its terms.
    fn entry(&self, i: usize, j: usize) -> (f64, f64) {
        let (left, right) = (self.column(i), self.column(j));
        (0..N).fold((0.0, 0.0), |(value, terms), row| {
            let ((q, p), (q_right, p_right)) = (left(row), right(row));
            let (plus, minus) = (q * p_right, p * q_right);
            (value + (plus - minus), terms + plus.abs() + minus.abs())
        })
    }

    /// The mean over the pairs (qᵢ, pᵢ), and its terms.
    fn factor(&self) -> (f64, f64) {
        let (value, terms) = (0..N)
            .map(|i| self.entry(i, N + i))
            .fold((0.0, 0.0), |sum, (value, terms)| (sum.0 + value, sum.1 + terms));
        (value / N as f64, terms / N as f64)
    }

    /// AᵀΩA − cΩ where it is worst. A tolerance as large as c tells nothing of it.
    fn defect(&self, c: f64, relative: f64, sample: usize) -> Option<Finding<Entry>> {
        let mut worst = None;
        for j in 0..2 * N {
            for i in 0..j {
                let (value, terms) = self.entry(i, j);
                let expected = if j == i + N { c } else { 0.0 };
                let tolerance = Tolerance { relative, scale: terms + expected.abs() };
                Finding::relative(value - expected, tolerance, Entry { entry: (i, j), sample })
                    .beside(c)
                    .keep_if_worse(&mut worst, Finding::excess_or_silence);
            }
        }
        worst
    }
}

/// The least number of samples: with one coordinate each alone fulfils the condition.
fn needed<const N: usize>() -> usize {
    if N == 1 { 2 } else { 1 }
}

impl ConformalStep {
    /// Of steps with these derivatives, such as one written by hand, at states that lie apart. A defect
    /// counts as zero within `relative` of the terms it is the sum of, or 1024 ε unless said.
    ///
    /// # Errors
    /// A [`ConformalStepError`].
    pub fn of<S: Scalar, const N: usize>(
        derivatives: &[PhaseMatrix<S, N>],
        relative: Option<f64>,
    ) -> Result<Self, ConformalStepError> {
        let needed = needed::<N>();
        let too_few = ConformalStepError::TooFewSamples { given: derivatives.len(), needed };
        if derivatives.len() < needed {
            return Err(too_few);
        }
        let mut best = (f64::NAN, f64::INFINITY);
        for (sample, a) in derivatives.iter().enumerate() {
            let blocks = [&a.q_by_q, &a.q_by_p, &a.p_by_q, &a.p_by_p];
            if !blocks.iter().all(|block| block.iter().all(|entry| entry.widen().is_finite())) {
                return Err(ConformalStepError::NonFinite { sample });
            }
            let (factor, terms) = PulledBack(a).factor();
            if terms < best.1 {
                best = (factor, terms);
            }
        }
        Self::held_against(best.0, derivatives, relative).ok_or(too_few)
    }

    /// [`of`](Self::of) with the `factor` c given; `None` without a derivative.
    pub(crate) fn held_against<S: Scalar, const N: usize>(
        factor: f64,
        derivatives: &[PhaseMatrix<S, N>],
        relative: Option<f64>,
    ) -> Option<Self> {
        let relative = relative.unwrap_or_else(Tolerance::rounding::<S>);
        let mut worst = None;
        for (sample, a) in derivatives.iter().enumerate() {
            if let Some(found) = PulledBack(a).defect(factor, relative, sample) {
                found.keep_if_worse(&mut worst, Finding::excess_or_silence);
            }
        }
        worst.map(|defect| Self { samples: derivatives.len(), factor, defect })
    }

    /// Whether AᵀΩA = cΩ with one c at all samples.
    #[must_use]
    pub fn is_conformal(&self) -> bool {
        self.verdict() == Verdict::Yes
    }

    /// Whether that is so, or cannot be told: where c is no larger than what counts as zero.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        if self.factor.is_finite() { self.defect.verdict() } else { Verdict::CannotTell }
    }

    /// κ = (1 − c)/(1 + c): what D1D2R_d = κ D1D2L_d then has ([`Proportion`](crate::rayleigh::Proportion)).
    /// Infinite for c = −1, where L_d is degenerate.
    #[must_use]
    pub fn kappa(&self) -> f64 {
        (1.0 - self.factor) / (1.0 + self.factor)
    }
}

/// Conformally symplectic steps.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Whether the step multiplies the symplectic form by a constant, by its derivative at the `states`: of a
    /// rule, a composition or a splitting alike. See [`ConformalStep`](crate::rayleigh::ConformalStep).
    ///
    /// **States it needs.** One, or for n = 1 two that lie apart ([`samples`](crate::samples)). It is asked
    /// at 2n more, each of which differs from the first in one coordinate: towards another of the states
    /// given, or by its own size. The k-th of all is asked k h after the time of a view. The answer is
    /// about these.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
    ///
    /// /// C = 2aM, and a potential that couples both coordinates.
    /// #[rayleigh_system(rule = [midpoint, trapezoidal])]
    /// fn well(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
    ///     let kinetic = 0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1]);
    ///     (kinetic - (q[0] * q[1]).sin() - q[0].powi(4) - q[1] * q[1], 2.0 * a * kinetic)
    /// }
    /// let (a, h) = (0.3, 0.2);
    /// let well = Well { a };
    /// let states = [State { q: vector![0.3, -0.2], p: vector![0.1, 0.4] }];
    ///
    /// let found = well.by(Trapezoidal, h).conformal_step(&states)?;
    /// assert!(found.is_conformal() && (found.factor - (1.0 - a * h) / (1.0 + a * h)).abs() < 1e-15);
    /// assert!((found.kappa() - a * h).abs() < 1e-15);
    /// let none = well.by(Midpoint, h).conformal_step(&states)?;
    /// assert!(!none.is_conformal());
    /// println!("{none}"); // by how much, and where
    /// # Ok::<(), dalembert::rayleigh::ConformalStepError>(())
    /// ```
    ///
    /// # Errors
    /// A [`ConformalStepError`](crate::rayleigh::ConformalStepError).
    pub fn conformal_step(
        &self,
        states: &[State<L::Scalar, N>],
    ) -> Result<ConformalStep, ConformalStepError> {
        const { Self::require_unconstrained() };
        let asked = ask(self, states)?;
        let (given, needed) = (asked.different, needed::<N>());
        if given < needed {
            return Err(ConformalStepError::TooFewSamples { given, needed });
        }
        if !asked.moves {
            return Err(ConformalStepError::AtRest);
        }
        let (given, beside) = asked.derivatives.split_at(states.len());
        let factor = ConformalStep::of(given, None)?.factor;
        // Beside the states given a step may be so stiff that it tells nothing.
        let tells = |a: &&PhaseMatrix<L::Scalar, N>| {
            ConformalStep::held_against(factor, &[**a], None)
                .is_some_and(|found| found.verdict() != Verdict::CannotTell)
        };
        let all: Vec<_> = given.iter().chain(beside.iter().filter(tells)).copied().collect();
        ConformalStep::of(&all, None)
    }
}

impl fmt::Display for ConformalStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { samples, factor, defect } = self;
        if self.is_conformal() {
            writeln!(f, "conformally symplectic, c = {factor:.15}, by its derivative at states: {samples}")?;
            write!(f, "  AᵀΩA = cΩ   yes: {defect}")
        } else {
            let (verdict, answer) = match self.verdict() {
                Verdict::CannotTell => ("whether conformally symplectic cannot be told", Verdict::CannotTell),
                _ => ("not conformally symplectic", Verdict::No),
            };
            writeln!(f, "{verdict}, by its derivative at states: {samples}")?;
            write!(
                f,
                "  AᵀΩA = cΩ   {answer}: {defect} with c = {factor:.6}, which comes nearest at one state"
            )
        }
    }
}

impl fmt::Display for ConformalStepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewSamples { given, needed } => {
                write!(f, "{given} steps given to look at that lie apart, {needed} needed; give more states")?;
                if *needed > 1 {
                    f.write_str(": with one coordinate every single A has AᵀΩA = det A Ω")?;
                }
                Ok(())
            }
            Self::AtRest => f.write_str(
                "the step moves no state by more than its derivative resolves; take a longer step, or states that move",
            ),
            Self::Stopped => f.write_str(STOPPED),
            Self::Step { sample, error } => write!(f, "the step of sample {sample}: {error}"),
            Self::NonFinite { sample } => write!(f, "the derivative of sample {sample} is not finite"),
        }
    }
}

debug_by_display!(ConformalStepError);

impl core::error::Error for ConformalStepError {}
