//! Memories of runs: the values kept from one step to the next.

mod drift;
mod explicit;
pub(crate) mod in_lanes;
mod kept_matrix;

pub use drift::{DriftMemory, ExplicitDriftMemory};
pub(super) use explicit::verify_explicit;
pub use explicit::{Explicit, ExplicitMemory};
pub use kept_matrix::KeptMatrix;

pub use crate::step::VelocityHistory;
