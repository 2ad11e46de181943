//! The system as the user states it, in continuous time: L, R and f with their derivatives, and what is known of their form.
//!
//! Uses numbers.

pub(crate) mod continuous;
pub(crate) mod driven;
pub(crate) mod fields;
pub(crate) mod forced;
pub(crate) mod structure;
