//! One step: the discrete system, its states, and the solver of its equation.
//!
//! Uses numbers and systems. What the rules are, it does not know.

pub(crate) mod discrete;
pub(crate) mod error;
pub(crate) mod newton;
pub(crate) mod state;
pub mod verification;
