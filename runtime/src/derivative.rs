//! Derivatives of a step as data, and its [`Certificate`]: how well its equation was posed.
//!
//! Uses rules and all below; runs neither use it nor does it use them.

mod certificate;

pub use crate::step::{LegendreDerivatives, Linearization, PhaseMatrix, StateBy, StepHessian, StepTaken};
pub use certificate::Certificate;
