//! Sliders: coupled masses on springs, with elements of dry friction on the ground and on belts, and a second
//! program for their motion. That one goes from event to event: between them the motion is linear, and a
//! Taylor series has it to rounding. Nothing of it is the runtime's.

mod drawn;
mod events;
mod sets;
mod system;

pub use drawn::Drawn;
pub use events::{Motion, Sliding};
pub use sets::Problem;
pub use system::{ELEMENTS, MASSES, Sliders};
