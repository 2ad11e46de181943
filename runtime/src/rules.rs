//! Rules of discretisation: how L, R and f become L_d, R_d and f_d. One file each.

mod by_drift;
mod closed_form;
mod damped_drift;
mod displacement;
mod fitted;
mod fitted_trapezoidal;
mod force_work;
mod gauss;
mod joint;
mod midpoint;
mod one_sided;
mod parts;
mod proximal;
mod quadrature;
mod self_adjoint;
mod trapezoidal;

pub use crate::step::{Fused, SolvedForVelocity};
pub(crate) use damped_drift::{ByDrift, DampedDrift, Drift, modes, require_positive_definite};
pub use displacement::{DisplacementRule, Node};
pub use fitted::Fitted;
pub use fitted_trapezoidal::FittedTrapezoidal;
pub use gauss::{Gauss, StageHistory};
pub(crate) use gauss::{SLACK, Solver, steps_until};
pub(crate) use joint::JointRayleighRule;
pub use joint::JointRule;
pub use midpoint::Midpoint;
pub use one_sided::{BothEnds, OneSided};
pub use proximal::Proximal;
pub use quadrature::Quadrature;
pub use self_adjoint::SelfAdjoint;
pub use trapezoidal::Trapezoidal;
