//! Errors of the stationary equation, by the hypothesis that fails.

use core::fmt;

/// Why there is no stationary solution.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum StationaryError {
    /// c = 1: T is no contraction.
    NoFriction,
    /// c > 1: T moves functions apart.
    Growing {
        /// c.
        factor: f64,
    },
    /// c ≤ 0: T is no minimum of a discounted action.
    Overdamped {
        /// c.
        factor: f64,
    },
    /// L or R takes a time.
    Timed,
    /// The period is not positive and finite.
    Period {
        /// It.
        period: f64,
    },
    /// The grid has too few points.
    TooFewPoints {
        /// Points needed.
        needed: usize,
        /// Points given.
        found: usize,
    },
    /// G is not periodic: a period further, in both ends, it is another.
    NotPeriodic {
        /// The configuration.
        q: f64,
        /// G there less G a period further.
        change: f64,
    },
    /// G is not finite.
    NonFinite {
        /// Configuration at the start.
        q0: f64,
        /// Configuration at the end.
        q1: f64,
    },
    /// G does not grow with |q1 − q0|, so far as was looked: nothing says where its minimum is.
    Unbounded {
        /// How far that was, in periods.
        periods: usize,
    },
    /// S_k did not settle.
    NotConverged {
        /// How often T was applied.
        iterations: usize,
        /// Bound on |S_k − S*|.
        error: f64,
    },
}

impl fmt::Display for StationaryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoFriction => f.write_str(
                "c = 1, there is no friction: S = min [S + G] is no contraction; give R > 0, in proportion to the mass",
            ),
            Self::Growing { factor } => write!(
                f,
                "c = {factor:.6} > 1, the friction drives: S_k moves away from any S*; give R > 0 and h > 0"
            ),
            Self::Overdamped { factor } => write!(
                f,
                "c = {factor:.6} is not positive: a step turns the momentum around; take a smaller step"
            ),
            Self::Timed => {
                f.write_str("L or R takes a time, so that no S is stationary; carry S_k by `conformal_hamilton_jacobi`")
            }
            Self::Period { period } => write!(f, "the period is {period}: give a positive and finite one"),
            Self::TooFewPoints { needed, found } => {
                write!(f, "the grid has {found} points, {needed} are needed at least")
            }
            Self::NotPeriodic { q, change } => write!(
                f,
                "G is not periodic: at q = {q:.4} it changes by {change:.2e} over the period; give that of L and R"
            ),
            Self::NonFinite { q0, q1 } => write!(f, "G is not finite from q0 = {q0:.4} to q1 = {q1:.4}"),
            Self::Unbounded { periods } => write!(
                f,
                "G does not outgrow c sup|S| within {periods} periods of q1 − q0, so that its minimum may be anywhere; \
                 give a positive mass, or more friction"
            ),
            Self::NotConverged { iterations, error } => write!(
                f,
                "after {iterations} iterations S_k may still be {error:.1e} from S*; take more points"
            ),
        }
    }
}

debug_by_display!(StationaryError);

impl core::error::Error for StationaryError {}
