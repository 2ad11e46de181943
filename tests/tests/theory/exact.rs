//! The exact discrete objects.

mod derivatives;
mod failures;
mod random;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod cubic_drag;
#[cfg(not(feature = "only-long-tests"))]
mod existence;
#[cfg(not(feature = "only-long-tests"))]
mod flow;
#[cfg(not(feature = "only-long-tests"))]
mod order;
#[cfg(not(feature = "only-long-tests"))]
mod oscillator;
#[cfg(not(feature = "only-long-tests"))]
mod units;
