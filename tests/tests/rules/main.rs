//! What each rule of discretisation promises, and hard cases.

mod energy;
mod gauss_order;
mod hard;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod fitted;
#[cfg(not(feature = "only-long-tests"))]
mod fitted_stiffness;
#[cfg(not(feature = "only-long-tests"))]
mod fitted_structure;
#[cfg(not(feature = "only-long-tests"))]
mod gauss;
#[cfg(not(feature = "only-long-tests"))]
mod gauss_segments;
#[cfg(not(feature = "only-long-tests"))]
mod gauss_structure;
#[cfg(not(feature = "only-long-tests"))]
mod order;
