//! Why there is no modified system.

use core::fmt;

use crate::step::StepError;
use crate::system::Damping;
use crate::theory::rayleigh::asked::{Unasked, from_unasked};
use crate::theory::samples::STOPPED;

/// Why a linear step has no modified system: which hypothesis of
/// [`ModifiedLinearSystem`](crate::rayleigh::modified::ModifiedLinearSystem) fails.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ModifiedLinearSystemError {
    /// Fewer than two states were given that lie apart by more than a derivative resolves: nothing says
    /// that the system is linear.
    TooFewStates,
    /// The step moves no state by more than a derivative resolves: a much longer one tells.
    AtRest,
    /// A step could not be taken or differentiated.
    Step {
        /// The state, from 0.
        sample: usize,
        /// Why.
        error: StepError,
    },
    /// The step size is zero or not finite.
    StepSize {
        /// The step size given.
        h: f64,
    },
    /// An entry of A is not finite.
    NonFinite {
        /// The state, from 0.
        sample: usize,
    },
    /// The step is another one at a later time: its springs, its friction or a push change.
    Timed {
        /// How many steps later.
        steps: usize,
        /// The largest difference to the step at the time given, of A in units of A or of the end in units
        /// of it.
        difference: f64,
    },
    /// A is another matrix at another state: the system is not linear.
    NotLinear {
        /// The state, from 0; those beyond the states given lie around the first of them.
        sample: usize,
        /// The largest difference to A at the first, in units of A.
        difference: f64,
    },
    /// A has the eigenvalue 0: it has no logarithm.
    ZeroEigenvalue,
    /// A has an eigenvalue on the negative real axis, as where a step rings: it has no real logarithm.
    NegativeEigenvalue {
        /// The eigenvalue.
        eigenvalue: f64,
    },
    /// A motion turns by more than π in a step: the principal logarithm is not the one that is near the
    /// system.
    AnotherBranch {
        /// The angle.
        angle: f64,
    },
    /// ∂q̇/∂p of the logarithm is singular: its motions are not those of an equation of second order in q.
    Degenerate,
    /// The eigenvalues of A, or its roots, were not found: its entries are of too different sizes.
    NotConverged,
    /// The caller has ended the check ([`stopped_by`](crate::Discretised::stopped_by)).
    Stopped,
}

from_unasked!(ModifiedLinearSystemError);

impl fmt::Display for ModifiedLinearSystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewStates => f.write_str(
                "two states that lie apart are needed to see that a system is linear; give states that differ by more \
                 than rounding",
            ),
            Self::AtRest => f.write_str(
                "the step moves no state by more than its derivative resolves; take a longer step, or states that move",
            ),
            Self::Stopped => f.write_str(STOPPED),
            Self::Step { sample, error } => write!(f, "the step of state {sample}: {error}"),
            Self::StepSize { h } => write!(f, "step size {h} is zero or not finite; give a finite h ≠ 0"),
            Self::NonFinite { sample } => write!(f, "the derivative at state {sample} is not finite"),
            Self::Timed { steps, difference } => write!(
                f,
                "the step is another one {steps} steps later (by {difference:.1e}): the system changes with time; give \
                 ModifiedLinearSystem::of the derivative at one time"
            ),
            Self::NotLinear { sample, difference } => write!(
                f,
                "the step's derivative at state {sample} is not that at state 0 (by {difference:.1e}): the system is \
                 not linear; give ModifiedLinearSystem::of the derivative at an equilibrium"
            ),
            Self::ZeroEigenvalue => {
                f.write_str("the step's derivative has the eigenvalue 0 and no logarithm; take another step size")
            }
            Self::NegativeEigenvalue { eigenvalue } => write!(
                f,
                "the step's derivative has the eigenvalue {eigenvalue:.3e} and no real logarithm: the step rings; \
                 take a smaller step"
            ),
            Self::AnotherBranch { angle } => write!(
                f,
                "a motion turns by {angle:.3} > π in a step, which its end does not tell; take a smaller step"
            ),
            Self::Degenerate => f.write_str(
                "∂q̇/∂p of log A/h is singular: the steps lie on no motion of an equation of second order in q",
            ),
            Self::NotConverged => {
                f.write_str("the logarithm of the step's derivative was not found; scale the coordinates")
            }
        }
    }
}

debug_by_display!(ModifiedLinearSystemError);

impl core::error::Error for ModifiedLinearSystemError {}

/// Why the rule has no [`ModifiedSystem`](crate::rayleigh::modified::ModifiedSystem) here: the
/// formulas are those of L = ½vᵀMv − V(q) and R = ½vᵀCv.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ModifiedSystemError {
    /// The step size is zero or not finite.
    StepSize {
        /// The step size given.
        h: f64,
    },
    /// L is not known to be ½vᵀMv − V(q) with constant M.
    Lagrangian,
    /// R is not known to be ½vᵀCv with constant C.
    Friction {
        /// The kind of force that R makes.
        damping: Damping,
    },
    /// R has a term linear in v: a constant force, which belongs in V.
    Thrust,
    /// There is a general force.
    GeneralForce,
    /// L or R takes the time.
    Timed,
    /// M is not positive definite.
    Mass(StepError),
    /// M̃(q) is singular: the step is too long there.
    Singular,
    /// R is not ≥ 0, so that no step size makes R̃ so.
    NotDissipative,
    /// V″, or the state given, is not finite.
    NonFinite,
}

impl fmt::Display for ModifiedSystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepSize { h } => write!(f, "step size {h} is zero or not finite; give a finite h ≠ 0"),
            Self::Lagrangian => f.write_str(
                "L is not known to be ½vᵀMv − V(q) with constant M; a system written by hand says so in its STRUCTURE",
            ),
            Self::Friction { damping } => {
                write!(f, "R is not known to be ½vᵀCv with constant C: its damping is {damping:?}")
            }
            Self::Thrust => f.write_str("R has a term c·v; write it into L as −c·q"),
            Self::GeneralForce => f.write_str("there is a general force; the formulas are of L and R alone"),
            Self::Timed => f.write_str("L or R takes the time; the formulas are of systems without"),
            Self::Mass(error) => write!(f, "the mass matrix M: {error}"),
            Self::Singular => f.write_str("the modified mass matrix is singular; take a smaller step"),
            Self::NotDissipative => {
                f.write_str("R takes negative values: no step size makes the modified one ≥ 0")
            }
            Self::NonFinite => f.write_str("V″ or the state given is NaN or infinite; look at q and p"),
        }
    }
}

debug_by_display!(ModifiedSystemError);

impl core::error::Error for ModifiedSystemError {}
