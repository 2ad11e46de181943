//! Runs of steps: what they keep from one to the next, in what order substeps follow, how far they are from the motion.
//!
//! Uses rules and all below.

pub(crate) mod checkpoint;
pub(crate) mod composed_trajectory;
pub(crate) mod composition;
pub(crate) mod discretised;
pub(crate) mod memory;
pub(crate) mod splitting;
pub(crate) mod tolerance;
pub(crate) mod trajectory;
