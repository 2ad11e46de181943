//! Momentum maps, symmetries and their balance.

mod angular_momentum;
mod balance;
mod cancellation;
mod identity;
mod interior_points;
mod radial_friction;
mod subalgebra;
mod translation;
