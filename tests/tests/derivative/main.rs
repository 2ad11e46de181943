//! Derivatives of the step.

mod gauss_derivatives;
mod linearization;
mod sensitivities;
mod step_matrix;
