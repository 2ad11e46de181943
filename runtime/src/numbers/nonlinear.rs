//! Nonlinear equations p0(q, v, h) = p for v, solved at length: by the damped method, from rest, in parts of
//! h.
//!
//! Where a step leaves the few iterations that nearly every step needs, nothing depends on speed any more,
//! but whatever has the number of coordinates in its type is compiled in every program that has a system, for
//! each of its systems. So everything here works on slices, asks the equation through pointers
//! ([`Evaluate`]), and is compiled once for each scalar type, with this crate ([`AtLength`]). Its vectors are
//! the caller's ([`Room`]); it neither allocates nor panics.

mod careful;
mod continuation;
mod equations;
mod noise;
mod rounding;
mod start;
mod twice;
mod vectors;
mod verdict;

pub(crate) use careful::shorter;
pub use continuation::AtLength;
pub(crate) use continuation::ITERATIONS;
pub use equations::{Equations, Evaluate, Matrix, Root, Solved, Unsolved, Way};
pub use noise::Left;
pub(crate) use noise::{AROUND, WITHIN_NOISE, shift};
pub(crate) use rounding::{
    AT_FLOOR, PLACES, SLOW, SMALL, add_finite_part, held, held_one_by_one, in_units_of, is_sensible,
};
pub use vectors::Room;
pub(in crate::numbers) use vectors::copy;
pub(crate) use vectors::{MEASURES_NOISE, VECTORS, largest};
