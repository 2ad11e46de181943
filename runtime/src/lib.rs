#![cfg_attr(feature = "std", doc = include_str!("../README.md"))]
#![cfg_attr(not(feature = "std"), no_std)]

extern crate self as dalembert;

mod derivatives;
mod discrete;
mod error;
mod fields;
mod linear;
mod newton;
mod rules;
mod scalar;
mod state;
mod system;
mod trajectory;

#[cfg(feature = "std")]
pub mod dual;

pub use dalembert_macros::rayleigh_system;
pub use nalgebra;

pub use derivatives::{CovectorDerivatives, Derivatives, Direction, Gradient, Variations};
pub use discrete::{
    Discrete, DiscreteForce, DiscreteForceDerivatives, DiscreteRayleigh, Momenta, Outgoing, Report, Step,
    StepKernel,
};
pub use error::{Quantity, StepError};
pub use fields::{ScalarField, VectorField};
pub use rules::{DisplacementRule, Midpoint, Node, Trapezoidal};
pub use scalar::Scalar;
pub use state::State;
pub use system::{Force, Lagrangian, Rayleigh};
pub use trajectory::{Sample, Samples, Trajectory};
