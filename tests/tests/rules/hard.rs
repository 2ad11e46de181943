//! Hard cases, quick versions; `docs/hard-cases.md` has the long ones.
//!
//! Where a rule is exact, or keeps something exactly, that is asked for to rounding. Where it fails, it must
//! say so by a named `StepError`, and leave the last good state.

mod chaotic;
mod methods;
mod rounding;
mod stiff;
mod verdicts;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod damping;
#[cfg(not(feature = "only-long-tests"))]
mod faults;
#[cfg(not(feature = "only-long-tests"))]
mod first_guess;
#[cfg(not(feature = "only-long-tests"))]
mod kepler;
#[cfg(not(feature = "only-long-tests"))]
mod scales;
#[cfg(not(feature = "only-long-tests"))]
mod singular;
