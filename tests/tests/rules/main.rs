//! What each rule of discretisation promises, and hard cases.

mod energy;
mod fitted;
mod fitted_stiffness;
mod fitted_structure;
mod gauss;
mod gauss_order;
mod gauss_segments;
mod gauss_structure;
mod hard;
mod knots;
mod one_sided;
mod order;
