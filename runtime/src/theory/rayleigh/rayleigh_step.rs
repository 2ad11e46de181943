//! Which steps have an R_d: by the step's derivative alone, whatever made the step.

use core::fmt;

use nalgebra::SMatrix;

use crate::numbers::Scalar;
use crate::step::{Discretised, Flow, PhaseMatrix, State, StepError, invert};
use crate::theory::rayleigh::asked::{Unasked, ask, from_unasked};
use crate::theory::samples::STOPPED;
use crate::theory::verdict::{Finding, Tolerance};

/// Whether a step is a Rayleigh step: [`rayleigh_step`](crate::Discretised::rayleigh_step).
///
/// A step Φ: (q0, p0) ↦ (q1, p1) with the derivative A, its blocks a = ∂q1/∂q0, b = ∂q1/∂p0 and d = ∂p1/∂p0,
/// and det b ≠ 0, is a Rayleigh step if some L_d and R_d have
///
/// ```text
/// p0 = −D1(L_d + R_d),   p1 = D2(L_d − R_d)
/// ```
///
/// **Theorem.** Locally that is so if and only if a bᵀ and bᵀd are symmetric.
///
/// *Proof.* As functions of (q0, q1) the momenta have ∂p0/∂q0 = −b⁻¹a and ∂p1/∂q1 = d b⁻¹. A function with
/// gradient −p0 in q0, at every q1, exists iff the first is symmetric, one with gradient p1 in q1 iff the
/// second is: L_d⁺ and L_d⁻, and L_d, R_d = ½(L_d⁺ ± L_d⁻). Multiplied by b from the left and bᵀ from the
/// right the first is −a bᵀ; by bᵀ and b the second is bᵀd. ∎
///
/// On constraints it is asked on N = g⁻¹(0), of A between vectors tangent to N: coordinates of N add
/// symmetric terms alone.
///
/// For n = 1 every step is one. For n ≥ 2 no family of methods on (q, p) of order above 2 gives Rayleigh
/// steps for every damping: with C and K the matrices of damping and springs and M = I the exact motion has
/// the asymmetries ∓(h⁴/12) (CK − KC) at its ends, and no error of the method cancels both.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayleighStep {
    /// How many derivatives were looked at.
    pub samples: usize,
    /// Of a bᵀ, that is of ∂p0/∂q0 at fixed q1.
    pub at_start: Asymmetry,
    /// Of bᵀd, that is of ∂p1/∂q1 at fixed q0.
    pub at_end: Asymmetry,
}

/// The largest asymmetry of a matrix over some samples, in units of its tolerance; 0 for n = 1.
pub type Asymmetry = Finding<Entry>;

/// An entry of a matrix at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Row and column: the asymmetry is entry (i, j) less entry (j, i).
    pub entry: (usize, usize),
    /// The sample, from 0; those beyond the states given lie around the first of them.
    pub sample: usize,
}

/// Why it cannot be said of a step whether it is a Rayleigh step.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RayleighStepError {
    /// No sample was given.
    NoSamples,
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
    /// det b = 0, b = ∂q1/∂p0: the step is not told by its ends, as the theorem asks.
    Degenerate {
        /// The sample, from 0.
        sample: usize,
    },
    /// The caller has ended the check ([`stopped_by`](crate::Discretised::stopped_by)).
    Stopped,
}

from_unasked!(RayleighStepError);

/// The asymmetry of x yᵀ that is worst, of a sample.
fn asymmetry<S: Scalar, const N: usize>(
    sample: usize,
    (x, y): (&SMatrix<S, N, N>, &SMatrix<S, N, N>),
    relative: f64,
) -> Asymmetry {
    let product = |i: usize, j: usize| (0..N).map(move |k| x[(i, k)].widen() * y[(j, k)].widen());
    let found = |i: usize, j: usize| {
        let value = product(i, j).sum::<f64>() - product(j, i).sum::<f64>();
        let scale = product(i, j).chain(product(j, i)).map(f64::abs).sum();
        Finding::relative(value, Tolerance { relative, scale }, Entry { entry: (i, j), sample })
    };
    // None for n = 1.
    let mut worst = None;
    for i in 0..N {
        for j in 0..i {
            found(i, j).keep_if_worse(&mut worst, Finding::excess);
        }
    }
    worst.unwrap_or_else(|| {
        Finding::relative(0.0, Tolerance { relative, scale: 1.0 }, Entry { entry: (0, 0), sample })
    })
}

impl RayleighStep {
    /// Of steps with these derivatives, such as one written by hand. An asymmetry counts as zero within
    /// `relative` of the terms it is the sum of, or 1024 ε unless said.
    ///
    /// # Errors
    /// A [`RayleighStepError`] that says which hypothesis fails.
    pub fn of<S: Scalar, const N: usize>(
        derivatives: &[PhaseMatrix<S, N>],
        relative: Option<f64>,
    ) -> Result<Self, RayleighStepError> {
        let relative = relative.unwrap_or_else(Tolerance::rounding::<S>);
        let (mut at_start, mut at_end) = (None, None);
        for (sample, derivative) in derivatives.iter().enumerate() {
            let PhaseMatrix { q_by_q: a, q_by_p: b, p_by_q, p_by_p: d } = derivative;
            if ![a, b, p_by_q, d].iter().all(|block| block.iter().all(|entry| entry.widen().is_finite())) {
                return Err(RayleighStepError::NonFinite { sample });
            }
            invert(b).map_err(|_| RayleighStepError::Degenerate { sample })?;
            asymmetry(sample, (a, b), relative).keep_if_worse(&mut at_start, Finding::excess);
            let transposed = (&b.transpose(), &d.transpose());
            asymmetry(sample, transposed, relative).keep_if_worse(&mut at_end, Finding::excess);
        }
        match (at_start, at_end) {
            (Some(at_start), Some(at_end)) => Ok(Self { samples: derivatives.len(), at_start, at_end }),
            _ => Err(RayleighStepError::NoSamples),
        }
    }

    /// Whether there are L_d and R_d with p0 = −D1(L_d + R_d) and p1 = D2(L_d − R_d), in a simply connected
    /// region like that sampled.
    #[must_use]
    pub fn is_rayleigh(&self) -> bool {
        self.at_start.vanishes() && self.at_end.vanishes()
    }
}

/// Rayleigh steps.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Whether the step is a Rayleigh step, by its derivative at the `states`: of a rule, a composition or a
    /// splitting alike. See [`RayleighStep`](crate::rayleigh::RayleighStep).
    ///
    /// **States it needs.** One. It is asked at 2n more, each of which differs from the first in one
    /// coordinate, towards another of the states given, or by its own size: an equilibrium does not speak
    /// for the motion. The k-th of all is asked k h after the time of a view. The answer is about these.
    ///
    /// **On holonomic constraints** it is asked of the step restricted to N = g⁻¹(0), on vectors tangent to
    /// N: whether the step has an L_d and an R_d there. States have to be on the constraints, as steps ask.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Composition, Discretise, Midpoint, State, rayleigh_system};
    ///
    /// /// Friction of one coordinate, springs that couple it to the other: CK ≠ KC.
    /// #[rayleigh_system]
    /// fn pair(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    ///     let potential = q[0] * q[0] + q[0] * q[1] + q[1] * q[1];
    ///     (0.5 * (v[0] * v[0] + v[1] * v[1] - potential), 0.5 * r * v[0] * v[0])
    /// }
    /// let pair = Pair { r: 0.5 };
    /// let states = [State { q: vector![0.3, -0.2], p: vector![0.1, 0.4] }];
    /// assert!(pair.by(Midpoint, 0.5).rayleigh_step(&states)?.is_rayleigh());
    ///
    /// let six = pair.by(Composition::kahan_li_6(Midpoint), 0.5).rayleigh_step(&states)?;
    /// assert!(!six.is_rayleigh()); // of order above 2 in (q, p)
    /// println!("{six}");
    /// # Ok::<(), dalembert::rayleigh::RayleighStepError>(())
    /// ```
    ///
    /// # Errors
    /// A [`RayleighStepError`](crate::rayleigh::RayleighStepError) that says which hypothesis fails.
    pub fn rayleigh_step(&self, states: &[State<L::Scalar, N>]) -> Result<RayleighStep, RayleighStepError> {
        const { Self::require_holonomic() };
        let asked = ask(self, states)?;
        if !states.is_empty() && !asked.moves {
            return Err(RayleighStepError::AtRest);
        }
        let (given, beside) = asked.derivatives.split_at(states.len());
        // Beside the states given the ends may not tell the step.
        let beside = beside.iter().filter(|a| invert(&a.q_by_p).is_ok());
        RayleighStep::of(&given.iter().chain(beside).copied().collect::<Vec<_>>(), None)
    }
}

impl fmt::Display for RayleighStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.is_rayleigh() { "a Rayleigh step" } else { "no R_d for any L_d" };
        writeln!(f, "{verdict}, by its derivative at states: {}", self.samples)?;
        let answer = |finding: &Asymmetry| if finding.vanishes() { "yes" } else { "no" };
        writeln!(f, "  a bᵀ is symmetric at the start   {}: {}", answer(&self.at_start), self.at_start)?;
        write!(f, "  bᵀd is symmetric at the end      {}: {}", answer(&self.at_end), self.at_end)
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (i, j) = self.entry;
        write!(f, "({i}, {j}) of sample {}", self.sample)
    }
}

impl fmt::Display for RayleighStepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSamples => f.write_str("no step was given to look at"),
            Self::AtRest => f.write_str(
                "the step moves no state by more than its derivative resolves; take a longer step, or states that move",
            ),
            Self::Stopped => f.write_str(STOPPED),
            Self::Step { sample, error } => write!(f, "the step of sample {sample}: {error}"),
            Self::NonFinite { sample } => write!(f, "the derivative of sample {sample} is not finite"),
            Self::Degenerate { sample } => write!(
                f,
                "∂q1/∂p0 of sample {sample} is singular: its ends do not tell the step; take another h or state"
            ),
        }
    }
}

debug_by_display!(RayleighStepError);

impl core::error::Error for RayleighStepError {}
