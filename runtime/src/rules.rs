//! Rules of discretisation: how L, R and f become L_d, R_d and f_d. One file each.

mod displacement;
mod gauss;
mod midpoint;
mod trapezoidal;

pub use displacement::{DisplacementRule, Node};
pub use gauss::{Gauss, StageHistory};
pub use midpoint::Midpoint;
pub use trapezoidal::Trapezoidal;
