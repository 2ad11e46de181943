//! The Rayleigh structure of forced discrete systems.

mod classical_damping;
mod conformal;
mod dissipation;
mod equation;
mod equivalence;
mod manifold;
mod modified;
mod modified_ends;
mod modified_linear;
mod modified_range;
mod one_end;
mod optimal_control;
mod order_four;
mod potential;
mod reciprocity;
mod resplit;
mod rigid_body;
mod routh;
mod small_friction;
mod steps;
mod structure;
