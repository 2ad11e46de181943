//! Whether a step that was taken solves its equations: every rule on 22 systems at random, in twice the
//! precision, by equations written down a second time.
//!
//! The example `verdicts` runs the study; `tests/hard/verdicts.rs` a part of it.

pub mod equations;
pub mod steps;
pub mod systems;
pub mod tableau;
