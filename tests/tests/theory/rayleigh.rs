//! The Rayleigh structure of forced discrete systems.

mod classical_damping;
mod conformal;
mod dissipation;
mod equivalence;
mod manifold;
mod modified;
mod modified_ends;
mod modified_linear;
mod modified_range;
mod one_end;
mod order_four;
mod potential;
mod reciprocity;
mod resplit;
mod rigid_body;
mod routh;
mod steps;
mod structure;
