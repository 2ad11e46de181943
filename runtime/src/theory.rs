//! The theory's claims, checked on a system: symmetries, structure, Hamilton–Jacobi equations, the exact
//! discrete system.
//!
//! The highest floor: it uses all others, and none uses it.

mod energy;
#[cfg(feature = "theory")]
pub mod exact;
#[cfg(feature = "theory")]
pub mod hamilton_jacobi;
#[cfg(feature = "theory")]
mod legendre;
#[cfg(feature = "theory")]
pub mod noether;
#[cfg(feature = "theory")]
mod objects;
#[cfg(feature = "theory")]
pub mod rayleigh;
#[cfg(feature = "theory")]
mod restriction;
#[cfg(feature = "theory")]
pub mod samples;
#[cfg(feature = "theory")]
mod verdict;

pub use energy::{EnergyEntries, EnergyLedger};
