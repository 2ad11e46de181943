//! The checkers: exact objects, Noether, Rayleigh, Hamilton and Jacobi.

mod conjecture;
mod constraints;
mod energy;
mod exact;
mod hamilton_jacobi;
mod noether;
mod principle;
mod rayleigh;
mod verdicts;
