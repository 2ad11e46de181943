//! The theory's claims, checked on a system: symmetries, structure, Hamilton–Jacobi equations, the exact discrete system.
//!
//! The highest floor: it uses all others, and none uses it.

mod energy;
#[cfg(feature = "std")]
pub mod exact;
#[cfg(feature = "std")]
pub mod hamilton_jacobi;
#[cfg(feature = "std")]
pub mod noether;
#[cfg(feature = "std")]
pub mod rayleigh;
#[cfg(feature = "std")]
pub mod samples;
#[cfg(feature = "std")]
mod verdict;

pub use energy::EnergyLedger;
