//! The macros' pipeline called as plain code: what it writes, and that nothing makes it panic.

mod corpus;
mod odd_input;
mod snapshots;

/// The pipeline of the macro crate.
#[path = "../../../macros/src"]
#[allow(dead_code, reason = "the macro crate's own tests look further inside")]
mod pipeline {
    pub mod rayleigh_system;
}
