//! No checker says yes to nonsense, and all of them follow the time.

mod poisoned;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod poisoned_sections;
#[cfg(not(feature = "only-long-tests"))]
mod poisoned_steps;
#[cfg(not(feature = "only-long-tests"))]
mod register;
#[cfg(not(feature = "only-long-tests"))]
mod time;
