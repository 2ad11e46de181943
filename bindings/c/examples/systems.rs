//! The systems of the tests as a library for C, which `tests/compilers.rs` links programs against.

#[path = "../tests/systems/mod.rs"]
pub mod systems;
