//! Numbers: scalars, numbers side by side and numbers that carry derivatives; elementary functions, derivatives as data, matrices.
//!
//! The lowest floor: it uses nothing else of this crate.

pub(crate) mod derivatives;
pub(crate) mod elementary;
pub(crate) mod lanes;
pub(crate) mod linear;
pub(crate) mod scalar;

#[cfg(feature = "std")]
pub mod dual;
