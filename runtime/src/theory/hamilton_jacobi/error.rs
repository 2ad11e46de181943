//! Errors in the evaluation of an object of the theory.

use core::fmt;

use crate::step::StepError;
use crate::theory::rayleigh::{ConformalStep, ConformalStepError};
use crate::theory::samples::{STOPPED, Stopped};

/// Why a Hamilton–Jacobi object could not be evaluated.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum HamiltonJacobiError {
    /// An implicit equation has no solution in reach, or its matrix is singular.
    Implicit {
        /// The equation.
        equation: ImplicitEquation,
        /// The step k at which it was asked for; 0 for an object of one segment alone.
        step: usize,
        /// The solver's error.
        cause: StepError,
    },
    /// The points given are too few.
    TooFewPoints {
        /// Points needed.
        needed: usize,
        /// Points given.
        found: usize,
    },
    /// The family S_k, γ_k or F_k has another length than the points ask for.
    FamilyLength {
        /// Members needed.
        needed: usize,
        /// Members given.
        found: usize,
    },
    /// The states given do not tell whether the step is conformally symplectic.
    States(ConformalStepError),
    /// The step is not conformally symplectic: no G, and for n ≥ 2 not every section stays closed.
    NotConformal {
        /// The step k of a characteristic; `None` at the states given.
        step: Option<usize>,
        /// By how much, and where.
        report: ConformalStep,
    },
    /// c is 0, or no larger than what counts as 0 beside the terms of AᵀΩA: the step forgets momenta, and
    /// c^{−k} is none.
    VanishingFactor,
    /// det ∂²S_0/∂q∂λ = 0 at the label: the parameters and their constants do not tell the motions apart.
    DegenerateFamily,
    /// det Q_k = 0: at a caustic S_k has no derivative by q.
    Caustic {
        /// The step k.
        step: usize,
    },
    /// Differences of S_k by λ do not settle: a caustic is too near for them.
    Unsettled {
        /// The step k.
        step: usize,
        /// The change that the best halving of their spacing still made.
        error: f64,
    },
    /// No label was found whose characteristic is where it is asked for.
    NoLabel {
        /// The step k.
        step: usize,
        /// The last correction of the label.
        distance: f64,
    },
    /// The caller has ended the check ([`stopped_by`](crate::Discretised::stopped_by)).
    Stopped,
}

impl From<Stopped> for HamiltonJacobiError {
    fn from(Stopped: Stopped) -> Self {
        Self::Stopped
    }
}

/// An implicit equation of the theory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImplicitEquation {
    /// 𝔽⁻(q0, q1) = (q0, p0) for q1: the step.
    Step,
    /// 𝔽⁺(q0, q1) = (q1, p1) for q1, which H_d⁺ is a function through.
    RightHamiltonian,
    /// 𝔽⁻(q0, q1) = (q0, p0) for q0, which H_d⁻ is a function through.
    LeftHamiltonian,
    /// 𝔽⁺(q0, q1) = (q1, p1) for q0: the step backwards.
    BackwardStep,
    /// The lemma's definition of 𝓕⁺.
    LemmaFlowPlus,
    /// The lemma's definition of 𝓕⁻.
    LemmaFlowMinus,
    /// γ⁺ = 𝔽⁺, that is DS_{k+1}(q1) = D2 L_d(q0, q1), for q1.
    RightCharacteristic,
    /// A matrix of derivatives, ∂p/∂q or DF_k, that is to be inverted.
    Derivative,
}

impl HamiltonJacobiError {
    /// This error at step k: objects of one segment do not know which one they are, reports along a
    /// trajectory do.
    pub(super) fn at_step(self, k: usize) -> Self {
        match self {
            Self::Implicit { equation, cause, .. } => Self::Implicit { equation, step: k, cause },
            other => other,
        }
    }
}

impl ImplicitEquation {
    pub(super) fn at(self, step: usize) -> impl Fn(StepError) -> HamiltonJacobiError {
        move |cause| HamiltonJacobiError::Implicit { equation: self, step, cause }
    }
}

impl fmt::Display for ImplicitEquation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Step => "𝔽⁻(q0, q1) = (q0, p0) for q1",
            Self::RightHamiltonian => "𝔽⁺(q0, q1) = (q1, p1) for q1 (H_d⁺)",
            Self::LeftHamiltonian => "𝔽⁻(q0, q1) = (q0, p0) for q0 (H_d⁻)",
            Self::BackwardStep => "𝔽⁺(q0, q1) = (q1, p1) for q0 (backward step)",
            Self::LemmaFlowPlus => "the lemma's 𝓕⁺",
            Self::LemmaFlowMinus => "the lemma's 𝓕⁻",
            Self::RightCharacteristic => "γ⁺ = 𝔽⁺ for q1",
            Self::Derivative => "inverse of a matrix of derivatives",
        })
    }
}

impl fmt::Display for HamiltonJacobiError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Implicit { equation, step, cause } => {
                write!(f, "{equation} has no solution at k = {step}: {cause}")
            }
            Self::TooFewPoints { needed, found } => {
                write!(f, "{found} points given, {needed} needed; give a longer sequence of configurations")
            }
            Self::FamilyLength { needed, found } => {
                write!(f, "{found} members of the family given, {needed} needed: one for each k")
            }
            Self::Stopped => f.write_str(STOPPED),
            Self::States(error) => error.fmt(f),
            Self::NotConformal { step: Some(k), report } => {
                let ConformalStep { factor, defect, .. } = report;
                write!(
                    f,
                    "AᵀΩA = cΩ with c = {factor:.6} fails at step {k} by {:.2e}; the theory needs one c for all",
                    defect.value
                )
            }
            Self::NotConformal { step: None, report } => {
                write!(f, "the theory needs a step with AᵀΩA = cΩ, such as Trapezoidal with C = 2aM: {report}")
            }
            Self::VanishingFactor => f.write_str("AᵀΩA = 0 to rounding: the step forgets momenta; take another h"),
            Self::DegenerateFamily => f.write_str(
                "det ∂²S_0/∂q∂λ = 0 at the label: this family does not integrate the motion; take one whose λ moves \
                 ∂S_0/∂q in every direction",
            ),
            Self::Caustic { step } => {
                write!(f, "det Q_k = 0 at k = {step}, a caustic: S_k has no derivative by q there")
            }
            Self::Unsettled { step, error } => write!(
                f,
                "∂S_k/∂λ at k = {step} does not settle ({error:.1e}): a caustic is near; take a smaller width of λ"
            ),
            Self::NoLabel { step, distance } => write!(
                f,
                "no characteristic was found that is there at k = {step} (last correction {distance:.1e}); start nearer"
            ),
        }
    }
}

debug_by_display!(HamiltonJacobiError);

impl core::error::Error for HamiltonJacobiError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Implicit { cause, .. } => Some(cause),
            Self::States(error) => Some(error),
            _ => None,
        }
    }
}
