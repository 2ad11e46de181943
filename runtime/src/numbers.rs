//! Numbers: scalars, numbers side by side and numbers that carry derivatives; elementary functions,
//! derivatives as data, matrices, nonlinear equations at length, comparisons of two ways to one quantity.
//!
//! The lowest floor: it uses nothing else of this crate.

mod anchors;
mod arrays;
pub(crate) mod comparison;
mod compensated;
mod curve;
pub(crate) mod derivatives;
#[cfg(feature = "std")]
pub mod dual;
mod elementary;
pub(crate) mod lanes;
pub(crate) mod linear;
pub(crate) mod members;
pub(crate) mod nonlinear;
mod precision;
pub(crate) mod random;
mod scalar;
mod singular;
pub(crate) mod slices;
mod table;

pub use anchors::{Angle, Reciprocal};
pub(crate) use arrays::{Functions, Vectors, product_plus};
pub(crate) use compensated::{Compensated, CompensatedMembers};
pub use curve::Curve;
pub use derivatives::{
    CancellingTerms, CovectorDerivatives, Derivatives, Direction, Gradient, Hessian, Variations,
};
pub use elementary::Elementary;
pub(crate) use elementary::functions::{functions, names, one_by_one};
pub use lanes::{LaneVector, Lanes, Mask};
pub use linear::{Banded, EntriesOfMembers, Factored, MatricesOfMembers, NewtonMatrix};
pub(crate) use linear::{Pivoted, determinant_sign, dot};
pub use members::{Blank, MemberVector, Members};
pub(crate) use precision::Precision;
pub use scalar::Scalar;
pub use singular::Singular;
pub use table::{Interpolation, Table, TableError, TableSlice};
