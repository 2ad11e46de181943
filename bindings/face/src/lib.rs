//! A system as other languages see it: its fields by name and number, and its steps by a rule.
//!
//! `#[rayleigh_system]` describes a system ([`Described`]), and [`fields!`] the struct of its fields. Of the
//! two [`By`] makes what the bindings to C, FMI and Python step: each stands on this crate, none on another.

#![no_std]

#[doc(hidden)]
pub use dalembert;
pub use dalembert::system::Described;

mod columns;
mod constraints;
mod fields;
mod interface;
mod layout;
mod mass;
mod number;
mod of_block;
mod points;
mod wrong_points;

pub use columns::{ByInput, ByParameters, Column, by_state};
pub use constraints::{Holding, Multipliers, Reacting, StepMade};
pub use fields::{Field, FieldType, Fields};
pub use interface::{By, Input, Interface, coordinates, start};
pub use layout::layout;
pub use number::Number;
pub use of_block::{Events, Outputs};
pub use points::Points;
pub use wrong_points::{PointsError, WrongPoints, interpolation_number};
