//! The system as the user states it, in continuous time: L, R and f with their derivatives, and what is known
//! of their form.
//!
//! `#[rayleigh_system]` implements what is here. A system written by hand implements [`Lagrangian`], and
//! [`Rayleigh`] and [`Force`] where it has them, and [`ActingForce`], which hands them on; then
//! [`Discrete`](crate::Discrete) with the data of [`step`](crate::step), or for Gauss rules
//! [`ForcedLagrangian`] alone.
//!
//! Uses numbers, of which those that it speaks in are shown here.

mod acting_force;
mod constrained;
mod continuous;
mod described;
mod driven;
mod dry_friction;
mod error;
mod event_functions;
mod fields;
mod forced;
mod gathered;
pub mod missing;
mod no_derivative;
mod normals;
mod operation;
mod output_functions;
mod parameters;
mod plain;
mod quantity;
mod sampled;
mod second_order;
mod structure;
mod time_scale;
pub mod verification;
mod violation;

pub use crate::numbers::{
    Blank, CancellingTerms, CovectorDerivatives, Curve, Derivatives, Direction, Gradient, Hessian,
    Interpolation, LaneVector, Lanes, Mask, Scalar, Table, TableError, TableSlice, Variations,
};
pub use acting_force::ActingForce;
pub(crate) use acting_force::force_of_rayleigh;
pub use constrained::{
    Constrained, ConstrainedParameters, ConstraintsBy, first_rows, last_rows, normals, violation,
};
pub(crate) use constrained::{lost, off, sizes};
pub use continuous::{Force, Lagrangian, Rayleigh};
pub(crate) use continuous::{derivatives_apart, is_timed};
pub use described::Described;
pub use driven::{Driven, Input};
pub use dry_friction::{DryFriction, DryFrictionParameters, Slips, SlipsBy, SmoothRayleigh};
pub use error::{Compared, Function, GeneratedDiffers};
pub use event_functions::EventFunctions;
pub use fields::{ScalarField, VectorField};
pub use forced::{ForcedLagrangian, ForcedLagrangianInLanes, Stages};
pub use gathered::Gathered;
pub use no_derivative::NoDerivative;
pub use normals::Normals;
pub use operation::{Operation, Place, Written};
pub use output_functions::OutputFunctions;
pub use parameters::{GradientBy, Parameters};
pub use plain::{OfSlice, Plain, PlainFields, SliceMethods};
pub use quantity::Quantity;
pub use sampled::sampled_forces;
pub use second_order::SecondOrder;
pub use structure::{CyclicCoordinate, Damping, Engine, NewtonStructure, Refusal, Structure};
pub use time_scale::TimeScale;
pub use violation::Violation;
