//! Discrete Hamilton–Jacobi theory, as printed and corrected.

mod caustics;
mod closedness;
mod conformal;
mod constants;
mod continuous_limit;
mod corrected;
mod example;
mod hamilton_equations;
mod printed_family;
mod printed_trajectory;
mod sections;
mod stationary;
