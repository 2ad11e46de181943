//! Mechanical systems, each written twice: for `#[rayleigh_system]`, and by hand
//! ([`ByHand`](crate::by_hand::ByHand)) with accelerations derived on paper. Masses are never 1, so that a
//! forgotten mass shows.

mod bead;
mod chain;
mod charge;
mod double_pendulum;
mod follower;
mod hoist;
mod pendulum;

pub use bead::Bead;
pub use chain::{Chain, SITES};
pub use charge::Charge;
pub use double_pendulum::DoublePendulum;
pub use follower::Follower;
pub use hoist::{Hoist, HoistByAngle, rope};
pub use pendulum::{FreePendulum, Pendulum, free_pendulum};
