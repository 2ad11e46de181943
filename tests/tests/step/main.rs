//! The step: its equation, its solver, its errors, its certificate.

mod certificates;
mod random_systems;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod allocation;
#[cfg(not(feature = "only-long-tests"))]
mod condition;
#[cfg(not(feature = "only-long-tests"))]
mod degenerate;
#[cfg(not(feature = "only-long-tests"))]
mod equivalence;
#[cfg(not(feature = "only-long-tests"))]
mod f32;
#[cfg(not(feature = "only-long-tests"))]
mod gauss_solver;
#[cfg(not(feature = "only-long-tests"))]
mod inputs;
#[cfg(not(feature = "only-long-tests"))]
mod legendre;
#[cfg(not(feature = "only-long-tests"))]
mod oscillator_flow;
#[cfg(not(feature = "only-long-tests"))]
mod solver;
#[cfg(not(feature = "only-long-tests"))]
mod special_steps;
