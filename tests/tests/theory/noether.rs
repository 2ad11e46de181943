//! Momentum maps, symmetries and their balance.

mod angular_momentum;
mod balance;
mod cancellation;
mod identity;
mod radial_friction;
mod subalgebra;
mod translation;
