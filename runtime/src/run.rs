//! Runs of steps: what they keep from one to the next, in what order substeps follow, how far they are from the motion.
//!
//! Uses rules and all below.

mod checkpoint;
mod composed_trajectory;
mod composition;
mod discretise;
mod memory;
mod splitting;
mod tolerance;
mod trajectory;

pub use checkpoint::Checkpoint;
pub(crate) use checkpoint::Course;
pub use composed_trajectory::{ComposedStep, ComposedTrajectory};
pub use composition::{Composition, Substeps};
pub use discretise::Discretise;
pub use memory::{DriftMemory, Explicit, ExplicitDriftMemory, ExplicitMemory, KeptMatrix, VelocityHistory};
pub use splitting::{Kicks, Splitting};
pub use tolerance::{
    Breach, Choice, Composed, GaussOr, GuardedTrajectory, Method, MethodStep, Methods, OffersMethods,
    Request, SplitOr, Stagewise, Taken, TimedRequest, ToleranceError, Trial, WithGauss, WithSplittings,
};
pub use trajectory::{Parted, Sample, Samples, Trajectory};
