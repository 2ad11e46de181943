//! The modified system, on whose motion the steps of a method lie: backward error analysis under friction.
//!
//! ```text
//! linear systems, any method        M̃, C̃ and K̃ from log A, exactly                ModifiedLinearSystem
//! ½vᵀMv − V(q), ½vᵀCv, midpoint
//! and trapezoidal rule              L̃ and R̃, to O(h⁴)                              ModifiedSystem
//! ```
//!
//! Where the modified system has a Rayleigh function R̃, the run loses its modified energy at the rate 2R̃,
//! as the motion loses E at the rate 2R: energy is lost as friction takes it.

mod branch;
mod criterion;
mod displacement;
mod error;
mod linear;
mod linear_steps;
mod logarithm;
mod scaled;
mod schur;

pub use displacement::ModifiedSystem;
pub use error::{ModifiedLinearSystemError, ModifiedSystemError};
pub use linear::ModifiedLinearSystem;
