//! The Rayleigh structure of forced discrete systems.

mod dissipation;
mod equivalence;
mod potential;
mod resplit;
mod steps;
mod structure;
