//! Arithmetic and functions of arrays of `f64` or `f32`, in vector instructions: what a scalar type brings
//! for lanes.

mod functions;
mod vectors;

pub use functions::Functions;
pub(crate) use functions::product_plus;
pub use vectors::Vectors;
