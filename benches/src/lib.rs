//! Benchmarks of dalembert. See `benches/`.
