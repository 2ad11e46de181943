//! Momentum maps, symmetries and their balance.

mod affine;
mod angular_momentum;
mod balance;
mod cancellation;
mod finite_actions;
mod identity;
mod interior_points;
mod polar_example;
mod polar_potential;
mod radial_friction;
mod subalgebra;
mod translation;
