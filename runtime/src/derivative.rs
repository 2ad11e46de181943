//! Derivatives of a step by state, input and parameters, and its [`Certificate`]: how well its equation was
//! posed.
//!
//! Uses rules and all below; runs neither use it nor does it use them.

mod certificate;
mod driven;
mod linearization;
mod parameters;
mod second_order;

pub use crate::step::{LegendreDerivatives, Linearization, PhaseMatrix, StateBy, StepHessian};
pub use certificate::Certificate;
