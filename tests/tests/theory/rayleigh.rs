//! The Rayleigh structure of forced discrete systems.

mod classical_damping;
mod conformal;
mod dissipation;
mod equivalence;
mod potential;
mod reciprocity;
mod resplit;
mod steps;
mod structure;
