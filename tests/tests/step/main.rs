//! The step: its equation, its solver, its errors, its certificate.

mod allocation;
mod certificates;
mod condition;
mod constraints;
mod dashpots;
mod degenerate;
mod equivalence;
mod f32;
mod friction;
mod gauss_solver;
mod inputs;
mod legendre;
mod massless;
mod mechanisms;
mod no_numbers;
mod oscillator_flow;
mod printed;
mod random_systems;
mod rest;
mod rest_by_gauss;
mod singular_coordinates;
mod solver;
mod special_steps;
mod without_derivative;
