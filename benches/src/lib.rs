//! Benchmarks of dalembert: scenes, the same steps by hand, and what measures them. See `benches/`.

pub mod by_hand;
pub mod candidates;
pub mod instructions;
pub mod interleaved;
pub mod scenes;
pub mod stripped;
