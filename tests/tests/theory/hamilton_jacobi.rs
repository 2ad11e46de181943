//! Discrete Hamilton–Jacobi theory, as printed and corrected.

mod caustics;
mod conformal;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod closedness;
#[cfg(not(feature = "only-long-tests"))]
mod constants;
#[cfg(not(feature = "only-long-tests"))]
mod corrected;
#[cfg(not(feature = "only-long-tests"))]
mod example;
#[cfg(not(feature = "only-long-tests"))]
mod hamilton_equations;
#[cfg(not(feature = "only-long-tests"))]
mod printed_family;
#[cfg(not(feature = "only-long-tests"))]
mod printed_trajectory;
#[cfg(not(feature = "only-long-tests"))]
mod sections;
