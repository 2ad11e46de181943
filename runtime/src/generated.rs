//! Names in the code that the attributes write: all of them, and nothing else. Users find them in the root
//! of the crate, and in [`system`](crate::system), [`step`](crate::step) and the other modules.

pub use crate::described;
#[cfg(feature = "std")]
pub use crate::numbers::dual;
pub use crate::system::{missing, verification};

#[doc(no_inline)]
pub use crate::numbers::{
    Angle, Banded, CancellingTerms, CovectorDerivatives, Curve, Derivatives, Direction, Elementary, Gradient,
    Hessian, LaneVector, Lanes, Mask, MemberVector, Members, Reciprocal, Variations,
};
#[doc(no_inline)]
pub use crate::rules::{
    BothEnds, DisplacementRule, Fitted, FittedTrapezoidal, Fused, Gauss, JointRule, Midpoint, OneSided,
    Proximal, Trapezoidal,
};
#[doc(no_inline)]
pub use crate::run::tolerance::{OffersMethods, WithGauss, WithSplittings};
#[doc(no_inline)]
pub use crate::run::{
    DriftMemory, Explicit, ExplicitDriftMemory, ExplicitInLanes, ExplicitMemory, KeptMatrix, VelocityHistory,
};
#[doc(no_inline)]
pub use crate::step::{
    Constraints, DiscreteInLanes, Free, Friction, Momenta, Segment, StepKernel, massless_velocity,
};
#[doc(no_inline)]
pub use crate::system::{
    ActingForce, Constrained, ConstrainedParameters, ConstraintsBy, CyclicCoordinate, Damping, Driven,
    DryFriction, DryFrictionParameters, Engine, EventFunctions, Force, ForcedLagrangian,
    ForcedLagrangianInLanes, Function, Gathered, GeneratedDiffers, GradientBy, Input, Lagrangian,
    NewtonStructure, NoDerivative, Normals, OfSlice, Operation, OutputFunctions, Parameters, Place, Plain,
    PlainFields, Quantity, Rayleigh, Refusal, ScalarField, SecondOrder, SliceMethods, Slips, SlipsBy,
    SmoothRayleigh, Stages, Structure, TimeScale, VectorField, Violation, Written, first_rows, last_rows,
    normals, violation,
};

/// Implements [`Described`](crate::system::Described), and makes a macro of the system's name, which hands
/// `input`, `time` and `constraints`, as far as the system has them, to another macro: which functions of C
/// there are and how many arguments they have is text, which no trait can give.
#[doc(hidden)]
#[macro_export]
macro_rules! described {
    (
        $system:ident $([$view:ident $function:ident])?: $scalar:ident, $n:expr
        $(, input $u:ident $inputs:expr)? $(, time $time:ident)? $(, constraints $constraints:expr)?
        $(, events $events:expr)? $(, outputs $outputs:expr, [$($told:expr),*])?
        $(, parameters [$($parameter:literal),+])?;
        $words:ident $dollar:tt
    ) => {
        #[automatically_derived]
        impl $crate::system::Described<{ $n }> for $system {
            type Scalar = $scalar;
            type Input = $crate::generated::described!(@or () $(; [$scalar; $inputs])?);
            type Parameters = $crate::generated::described!(@or () $(; [&'static str; [$($parameter),+].len()])?);
            type Multipliers = $crate::generated::described!(@or () $(; [$scalar; $constraints])?);
            type Events = $crate::generated::described!(@or () $(; [$scalar; $events])?);
            type Outputs = $crate::generated::described!(@or () $(; [$scalar; $outputs])?);
            type View<'a> = $crate::generated::described!(@or Self $(; $view<'a>)?);

            const INPUTS: usize = 0 $(+ $inputs)?;
            const TAKES_TIME: bool = [$(stringify!($time),)? ""].len() == 2;
            const CONSTRAINTS: usize = 0 $(+ $constraints)?;
            const EVENTS: usize = 0 $(+ $events)?;
            const OUTPUTS: usize = 0 $(+ $outputs)?;
            const OUTPUTS_TOLD: &'static [&'static str] = &[$($($told),*)?];
            const PARAMETERS: &'static [&'static str] = &[$($($parameter),+)?];

            #[inline]
            #[allow(unused_variables)]
            fn view(&self, itself: Self, u: Self::Input, t: $scalar) -> Self::View<'_> {
                $crate::generated::described!(@view itself self $([$function])?, $([$u u])? $([$time t])?)
            }
        }

        #[doc(hidden)]
        #[allow(unused_macros)]
        macro_rules! $words {
            ($dollar then:path { $dollar($dollar before:tt)* }) => {
                $dollar then! { $dollar($dollar before)* $(input $u)? $(time $time)? $(constraints $constraints)? }
            };
        }
        #[doc(hidden)]
        #[allow(unused_imports)]
        pub(crate) use $words as $system;
    };
    (@view $itself:ident $system:ident, ) => { $itself };
    (@view $itself:ident $system:ident [$function:ident], $([$name:ident $value:ident])+) => {
        $system.$function($($value),+)
    };
    (@or $other:tt) => { $other };
    (@or $other:tt; $($own:tt)+) => { $($own)+ };
}
