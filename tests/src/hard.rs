//! Hard cases: systems on which codes break, with what is known of their motions in closed form.
//!
//! `tests/rules/hard/` holds their quick versions; `cargo study hard_cases` runs the long
//! ones and writes `docs/hard-cases.md`.

mod chaotic;
mod dissipative;
mod drive;
mod gyroscopic;
mod kepler;
mod scales;
mod singular;
mod stiff;

pub use chaotic::{HenonHeiles, TwoPendulums, henon_heiles, two_pendulums};
pub use dissipative::{
    Block, Cancelling, CubicDrag, DampedMass, Oscillator, Overflowing, VanDerPol, block, cancelling,
    cubic_drag, damped_mass, oscillator, overflowing, van_der_pol,
};
pub use drive::{Effort, Progress, drive, drive_composed};
pub use gyroscopic::{UniformField, uniform_field};
pub use kepler::{EccentricKepler, Kepler, KeplerOfEnergy, kepler, kepler_of_energy};
pub use scales::{Scaled, UNITS};
pub use singular::{
    Arm, Drag, FirstOrder, MathewsLakshmanan, Roots, arm, drag, first_order, mathews_lakshmanan, roots,
};
pub use stiff::{FERMI, Fermi, SpringPendulum, fermi, spring_pendulum};
