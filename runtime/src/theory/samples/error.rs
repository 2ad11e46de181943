//! Why samples cannot be judged.

use core::fmt;

use super::Stopped;

/// Says that the caller has ended a check.
pub(crate) const STOPPED: &str = "the check was ended by its caller";

/// Why the samples given cannot be judged.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SampleError {
    /// Fewer samples than decide. Where they are held against each other, those count that lie apart.
    TooFew {
        /// Samples given, or those of them that lie apart.
        given: usize,
        /// The least number that decides.
        needed: usize,
    },
    /// A quantity is NaN or infinite at a sample.
    NonFinite {
        /// Number of the sample, from 0.
        index: usize,
    },
    /// No sample can tell yes from no: none moves by more than rounding, or the generator vanishes at all.
    Uninformative {
        /// Samples given.
        given: usize,
    },
    /// An end of a sample is off the constraints by more than rounding explains:
    /// [`on_constraints`](crate::Discretised::on_constraints) moves it there.
    OffConstraint {
        /// Number of the sample, from 0.
        index: usize,
        /// The constraint k, from 0.
        constraint: usize,
        /// gₖ(q).
        value: f64,
    },
    /// A generator leaves the constraints: its momentum map is none of the motion on them.
    LeavesConstraints {
        /// Number of the generator, from 0.
        generator: usize,
        /// Number of the sample, from 0.
        index: usize,
        /// The share of ξ along a normal, of its terms.
        share: f64,
    },
    /// A view that takes the time was asked at one time, which says nothing of others.
    OneTime,
    /// The step size is NaN, infinite, 0 or below the normal numbers.
    StepSize,
    /// The caller has ended the check ([`stopped_by`](crate::Discretised::stopped_by)).
    Stopped,
}

impl From<Stopped> for SampleError {
    fn from(Stopped: Stopped) -> Self {
        Self::Stopped
    }
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { given, needed } => {
                write!(
                    f,
                    "{given} samples given that lie apart, at least {needed} needed to decide; give more"
                )
            }
            Self::Uninformative { given } => write!(
                f,
                "none of the {given} samples can tell yes from no: they move by no more than rounding, or the generator \
                 vanishes there; give samples that move"
            ),
            Self::OffConstraint { index, constraint, value } => write!(
                f,
                "sample {index} is off constraint {constraint}, whose value there is {value:.3e}; `on_constraints` \
                 moves samples there, unless they are too far off"
            ),
            Self::LeavesConstraints { generator, index, share } => write!(
                f,
                "generator {generator} leaves the constraints at sample {index}, by {share:.1e} of its size; give one that is \
                 tangent to them"
            ),
            Self::OneTime => f.write_str(
                "this view takes the time, and one time says nothing of others; ask over a duration, as by `dissipation_over`",
            ),
            Self::Stopped => f.write_str(STOPPED),
            Self::StepSize => f.write_str("the step size is not a normal number; give a finite h ≠ 0"),
            Self::NonFinite { index } => write!(
                f,
                "NaN or infinite value at sample {index}; keep the samples where L, R, f, constraints and generators are smooth"
            ),
        }
    }
}

debug_by_display!(SampleError);

impl core::error::Error for SampleError {}
