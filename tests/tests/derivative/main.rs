//! Derivatives of the step.

mod at_rest;
mod gauss_derivatives;
mod linearization;
mod sensitivities;
mod step_matrix;
