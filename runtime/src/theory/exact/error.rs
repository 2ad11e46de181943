//! Why exact discrete objects do not exist, or could not be reached.

use core::fmt;

use crate::step::{Quantity, StepError};
use crate::theory::samples::STOPPED;

/// Why an exact discrete object was not computed.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ExactError {
    /// The step size is zero or not finite.
    StepSize {
        /// The step size given.
        h: f64,
    },
    /// A value given is NaN or infinite.
    NonFinite {
        /// Which value.
        quantity: Quantity,
        /// Its coordinate.
        index: usize,
    },
    /// ∂²L/∂v² is singular on the motion: accelerations are not determined.
    DegenerateLagrangian {
        /// The time on the segment, from 0 to h.
        time: f64,
        /// The coordinate whose pivot vanishes.
        column: usize,
    },
    /// ∂²L/∂v² is singular where the motion starts and regular beside it: the coordinates are singular there.
    SingularCoordinates {
        /// The coordinate whose pivot vanishes.
        column: usize,
    },
    /// The motion leaves the region where L, R and f are finite.
    MotionNotFinite {
        /// The time on the segment, from 0 to h.
        time: f64,
    },
    /// q0 and q1 are conjugate: ∂q(h)/∂v(0) is singular to half the digits, so that the motion from q0 to q1
    /// is either not unique or does not exist.
    ConjugatePoints {
        /// The step size at which the points are conjugate; below the one asked for if the motion could be
        /// followed so far.
        h: f64,
        /// How much larger a variation is inside the segment than at its end; infinite at a conjugate point.
        growth: f64,
    },
    /// Newton's method found no motion from q0 to q1, though no conjugate point was met.
    NoMotion {
        /// Largest step size for which the motion was found, by following it from small ones; 0 if none.
        reached: f64,
        /// Distance from q1 that the best trial ended at, largest coordinate.
        residual: f64,
    },
    /// More integration steps do not bring the motion closer to a limit: L, R or f is too rough.
    Unresolved {
        /// Integration steps.
        steps: usize,
        /// Relative difference to half as many steps.
        difference: f64,
    },
    /// Neither end of the motion tells the other: rounding of one is enlarged beyond
    /// 10⁻⁶ of the motion, as by damping seen backwards, which grows like e^{r|h|/m},
    /// or by an unstable equilibrium, like e^{√(k/m)|h|}.
    IllConditioned {
        /// The step size.
        h: f64,
        /// The error from one rounding, relative to the largest of the motion.
        error: f64,
    },
    /// All evaluations of L and f that one question may take, 2²², are spent.
    TooMuchWork {
        /// Evaluations made.
        evaluations: usize,
        /// The time on the segment that the last attempt got to.
        time: f64,
    },
    /// The rule has no discrete object that is finite at this step size, to be compared with the exact one.
    RuleNotFinite {
        /// The step size.
        h: f64,
    },
    /// The third derivatives of L, or the second ones of f, could not be had by differences of those given.
    NotDifferentiable {
        /// The coordinate along which they were sought.
        index: usize,
    },
    /// The caller has ended the question ([`Exact::stopped_by`](super::Exact::stopped_by)).
    Stopped,
}

impl ExactError {
    /// Converts the failure of a state's Legendre transform at the start of a motion.
    pub(super) fn at_start(error: StepError) -> Self {
        match error {
            StepError::NonFinite { quantity, index } => Self::NonFinite { quantity, index },
            StepError::DegenerateLagrangian { column } => Self::DegenerateLagrangian { time: 0.0, column },
            StepError::SingularCoordinates { column } => Self::SingularCoordinates { column },
            _ => Self::MotionNotFinite { time: 0.0 },
        }
    }
}

impl fmt::Display for ExactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepSize { h } => write!(f, "step size {h} is zero or not finite; give a finite h ≠ 0"),
            &Self::NonFinite { quantity, index } => StepError::NonFinite { quantity, index }.fmt(f),
            Self::DegenerateLagrangian { time, column } => write!(
                f,
                "∂²L/∂v² is singular at t = {time} (pivot of coordinate {column}): accelerations are not determined; \
                 give every coordinate a kinetic energy, or remove it"
            ),
            &Self::SingularCoordinates { column } => StepError::SingularCoordinates { column }.fmt(f),
            Self::MotionNotFinite { time: 0.0 } => f.write_str(
                "L, R or f is not finite where the motion starts; look at the fields of the system, and at roots, powers \
                 and logarithms in them",
            ),
            Self::MotionNotFinite { time } => write!(
                f,
                "the motion leaves the region where L, R and f are finite at t = {time}; try a smaller h"
            ),
            Self::ConjugatePoints { h, growth } => write!(
                f,
                "conjugate points at h = {h}: ∂q(h)/∂v(0) is singular (a variation grows {growth:.1e}-fold inside the \
                 segment), so the motion from q0 to q1 is not unique or does not exist; try a smaller h"
            ),
            Self::NoMotion { reached, residual } => write!(
                f,
                "no motion from q0 to q1 found: the best trial ends {residual:.3e} away, and the motion can be followed \
                 up to h = {reached}; try a smaller h, or give a guess of the initial velocity"
            ),
            Self::Unresolved { steps, difference } => write!(
                f,
                "the motion is not resolved by {steps} integration steps (difference to half as many {difference:.1e}); \
                 try a smaller h, or make L, R and f smooth"
            ),
            Self::IllConditioned { h, error } => write!(
                f,
                "the ends of the motion over h = {h} do not tell each other: one rounding of either makes {error:.1e} of the \
                 other; try a smaller h"
            ),
            Self::TooMuchWork { evaluations, time } => write!(
                f,
                "the {evaluations} evaluations of L and f that one question may take are spent, the last attempt at \
                 t = {time}; try a smaller h, or less stiff forces"
            ),
            Self::Stopped => f.write_str(STOPPED),
            Self::RuleNotFinite { h } => {
                write!(f, "the rule's discrete objects are not finite at h = {h}; give smaller step sizes")
            }
            Self::NotDifferentiable { index } => write!(
                f,
                "third derivatives along coordinate {index} cannot be had by differences: L, R or f is not smooth, or \
                 not finite, around the motion"
            ),
        }
    }
}

debug_by_display!(ExactError);

impl core::error::Error for ExactError {}
