//! What is asked of a step beside where it leads: its derivatives by state, input and parameters, and how
//! well it was posed.
//!
//! Uses rules and all below; runs neither use it nor does it use them.

mod certificate;
mod driven;
mod linearization;
mod parameters;
mod second_order;

pub use crate::step::{LegendreDerivatives, Linearization, PhaseMatrix, StateBy, StepHessian};
pub use certificate::Certificate;
