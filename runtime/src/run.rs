//! Runs of steps: what they keep from one to the next, in what order substeps follow, how far they are from
//! the motion.
//!
//! Uses rules and all below.

pub mod between;
mod checkpoint;
mod composition;
mod discretise;
mod display;
mod driven;
pub mod events;
mod held_input;
mod lanes;
mod last_step;
mod memory;
mod pace;
mod parted;
mod present;
mod sample;
mod scaled_time;
mod splitting;
pub mod stick_slip;
pub mod tolerance;
mod trajectory;

pub use crate::step::in_lanes::LaneRuns;
pub use crate::step::stop::Stop;
pub use checkpoint::Checkpoint;
pub(crate) use checkpoint::Course;
pub use composition::Composition;
pub use discretise::Discretise;
pub use driven::DrivenTrajectory;
pub(crate) use driven::TakenUntil;
pub use held_input::{Carried, HeldInput, InPeriod, Period, Sensitivities};
pub use lanes::{ExplicitInLanes, ToldRun};
pub use memory::{DriftMemory, Explicit, ExplicitDriftMemory, ExplicitMemory, KeptMatrix, VelocityHistory};
pub use sample::{Run, Sample, Samples};
pub use splitting::{CompensatedSums, PlainSums, Splitting, Sums};
pub use trajectory::Trajectory;
