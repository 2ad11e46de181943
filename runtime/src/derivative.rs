//! Derivatives of a step, by its state, its input and the parameters of the system.
//!
//! Uses rules and all below.

pub(crate) mod certificate;
pub(crate) mod linearization;
pub(crate) mod parameters;
pub(crate) mod second_order;
