//! Names in the code that the attributes write: all of them, and nothing else. Users find them in the root
//! of the crate, and in [`system`](crate::system), [`step`](crate::step) and the other modules.

pub use crate::described;
#[cfg(feature = "std")]
pub use crate::numbers::dual;
pub use crate::system::{missing, verification};

#[doc(no_inline)]
pub use crate::numbers::{
    Angle, Banded, CancellingTerms, CovectorDerivatives, Derivatives, Direction, Elementary, Gradient,
    Hessian, LaneVector, Lanes, Mask, MemberVector, Members, Reciprocal, Variations,
};
#[doc(no_inline)]
pub use crate::rules::{
    DisplacementRule, Fitted, FittedTrapezoidal, Fused, Gauss, JointRule, Midpoint, OneSided, Trapezoidal,
};
#[doc(no_inline)]
pub use crate::run::tolerance::{OffersMethods, WithGauss, WithSplittings};
#[doc(no_inline)]
pub use crate::run::{
    DriftMemory, Explicit, ExplicitDriftMemory, ExplicitInLanes, ExplicitMemory, KeptMatrix, VelocityHistory,
};
#[doc(no_inline)]
pub use crate::step::{DiscreteInLanes, Momenta, Segment, StepKernel};
#[doc(no_inline)]
pub use crate::system::{
    ActingForce, CyclicCoordinate, Damping, Driven, Engine, Force, ForcedLagrangian, ForcedLagrangianInLanes,
    Function, GeneratedDiffers, GradientBy, Input, Lagrangian, NewtonStructure, NoDerivative, OfSlice,
    Operation, Parameters, Place, Plain, PlainFields, Quantity, Rayleigh, Refusal, ScalarField, SecondOrder,
    SliceMethods, Stages, Structure, TimeScale, VectorField, Written,
};
