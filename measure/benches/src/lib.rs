//! Benchmarks of dalembert: the steps of scenes by hand, and what measures them. See `benches/`.

pub mod by_hand;
pub mod candidates;
pub mod instructions;
pub mod interleaved;
pub mod stripped;
