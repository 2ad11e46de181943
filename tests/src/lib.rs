//! Systems that the tests share. Each claim is one file of `tests/`.

pub mod documented;
