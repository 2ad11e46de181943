//! What the project says of itself that takes a compiler: `cargo xtask tidy` checks what takes none.

mod compiled;
