//! Runs of steps: what they keep from one to the next, in what order substeps follow, how far they are from
//! the motion.
//!
//! Uses rules and all below.

mod checkpoint;
mod composed_trajectory;
mod composition;
mod discretise;
mod memory;
mod splitting;
pub mod tolerance;
mod trajectory;

pub use checkpoint::Checkpoint;
pub(crate) use checkpoint::Course;
pub use composed_trajectory::{ComposedStep, ComposedTrajectory};
pub use composition::Composition;
pub(crate) use composition::Substeps;
pub use discretise::Discretise;
pub use memory::{DriftMemory, Explicit, ExplicitDriftMemory, ExplicitMemory, KeptMatrix, VelocityHistory};
pub(crate) use splitting::Kicks;
pub use splitting::Splitting;
pub use trajectory::{Sample, Samples, Trajectory};
