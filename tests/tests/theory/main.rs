//! The checkers: exact objects, Noether, Rayleigh, Hamilton and Jacobi.

mod conjecture;
mod exact;
mod hamilton_jacobi;
mod verdicts;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod energy;
#[cfg(not(feature = "only-long-tests"))]
mod noether;
#[cfg(not(feature = "only-long-tests"))]
mod principle;
#[cfg(not(feature = "only-long-tests"))]
mod rayleigh;
