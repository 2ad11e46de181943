//! Why a system has no Routh reduction.

use core::fmt;

use crate::step::StepError;
use crate::theory::samples::{STOPPED, Stopped};

/// Why a coordinate cannot be left out, or a reduced step not be taken.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RouthError {
    /// There is no coordinate of this number.
    NoSuchCoordinate {
        /// The number given.
        cyclic: usize,
    },
    /// The segments say nothing: there are none, or θ has no momentum on them, or x moves alike on all, as
    /// far as a derivative resolves.
    Uninformative,
    /// The momenta change with time: a reduction has none.
    Timed {
        /// The segment, from 0.
        sample: usize,
        /// How many steps later a momentum is another.
        steps: usize,
    },
    /// A momentum or a derivative of one is not finite.
    NonFinite {
        /// The segment, from 0.
        sample: usize,
    },
    /// The momenta depend on θ itself, not on θ1 − θ0 alone.
    NotCyclic {
        /// The segment, from 0.
        sample: usize,
        /// ∂p/∂θ0 + ∂p/∂θ1 of the momentum where it was found.
        defect: f64,
    },
    /// p1_θ is no function of p0_θ: ∂_Δ L_d⁻ = g(∂_Δ L_d⁺) fails, as where friction on θ depends on the other
    /// coordinates otherwise than its inertia does.
    NotReducible {
        /// p0_θ.
        momentum: f64,
        /// p1_θ.
        found: f64,
        /// g(p0_θ), by the shapes of the first segment.
        expected: f64,
    },
    /// No Δ = θ1 − θ0 has the momentum, or ∂_Δ∂_Δ L_d⁺ = 0.
    NoAngle(StepError),
    /// The equation for the other coordinates has no solution.
    Step(StepError),
    /// The caller has ended the check ([`stopped_by`](crate::Discretised::stopped_by)).
    Stopped,
}

impl From<Stopped> for RouthError {
    fn from(Stopped: Stopped) -> Self {
        Self::Stopped
    }
}

impl fmt::Display for RouthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchCoordinate { cyclic } => write!(f, "there is no coordinate {cyclic}; they count from 0"),
            Self::Uninformative => f.write_str(
                "the segments say nothing of a reduction: give several, of several shapes, along which θ moves",
            ),
            Self::Timed { sample, steps } => write!(
                f,
                "a momentum of segment {sample} is another one {steps} steps later; reduce a system that does not change \
                 with time"
            ),
            Self::NonFinite { sample } => write!(f, "a momentum of segment {sample} is NaN or infinite"),
            Self::NotCyclic { sample, defect } => write!(
                f,
                "the coordinate is not cyclic: a momentum of segment {sample} changes with θ itself, by {defect:.3e}"
            ),
            Self::NotReducible { momentum, found, expected } => write!(
                f,
                "no reduction: at p_θ = {momentum:.6e} a step leaves p_θ = {found:.6e} here and {expected:.6e} at another \
                 shape; friction on θ must be a multiple of its inertia, or absent"
            ),
            Self::NoAngle(error) => write!(f, "no θ1 − θ0 has this momentum: {error}"),
            Self::Stopped => f.write_str(STOPPED),
            Self::Step(error) => write!(f, "the reduced step: {error}"),
        }
    }
}

debug_by_display!(RouthError);

impl core::error::Error for RouthError {}
