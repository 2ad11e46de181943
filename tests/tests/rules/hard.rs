//! Hard cases, quick versions; `docs/hard-cases.md` has the long ones.
//!
//! Where a rule is exact, or keeps something exactly, that is asked for to rounding. Where it fails, it must
//! say so by a named `StepError`, and leave the last good state.

mod chaotic;
mod damping;
mod faults;
mod first_guess;
mod kepler;
mod methods;
mod rounding;
mod scales;
mod singular;
mod stiff;
mod verdicts;
