//! The program of the README, as it stands there: a particle in a ring potential with weak drag.
//!
//! ```text
//! cargo run --release --example readme
//! ```

include!("readme/program.rs");
