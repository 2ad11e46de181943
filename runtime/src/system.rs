//! The system as the user states it, in continuous time: L, R and f with their derivatives, and what is known of their form.
//!
//! Uses numbers.

mod continuous;
mod driven;
mod error;
mod fields;
mod forced;
mod parameters;
mod second_order;
mod structure;
pub mod verification;

pub use continuous::{Force, Lagrangian, Rayleigh};
pub use driven::{Driven, Input};
pub use error::{Function, GeneratedDiffers};
pub use fields::{ScalarField, VectorField};
pub use forced::{ForcedLagrangian, Stages};
pub use parameters::{GradientBy, Parameters};
pub use second_order::SecondOrder;
pub use structure::{CyclicCoordinate, Damping, Engine, NewtonStructure, Refusal, Structure};
