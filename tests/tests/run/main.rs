//! Runs: memory, checkpoints, compositions, splittings, an error asked for.

mod close_pairs;
mod random_events;
mod saved_runs;
mod splitting;
mod tolerance;

// None of these holds a test that is long unoptimised.
#[cfg(not(feature = "only-long-tests"))]
mod anchors;
#[cfg(not(feature = "only-long-tests"))]
mod between;
#[cfg(not(feature = "only-long-tests"))]
mod composition;
#[cfg(not(feature = "only-long-tests"))]
mod driven;
#[cfg(not(feature = "only-long-tests"))]
mod events;
#[cfg(not(feature = "only-long-tests"))]
mod gauss_lanes;
#[cfg(not(feature = "only-long-tests"))]
mod kept;
#[cfg(not(feature = "only-long-tests"))]
mod kept_matrix;
#[cfg(not(feature = "only-long-tests"))]
mod lanes;
#[cfg(not(feature = "only-long-tests"))]
mod midpoint_lanes;
#[cfg(not(feature = "only-long-tests"))]
mod one_run;
#[cfg(not(feature = "only-long-tests"))]
mod scaled_time;
#[cfg(not(feature = "only-long-tests"))]
mod slack;
#[cfg(not(feature = "only-long-tests"))]
mod splitting_conditions;
#[cfg(not(feature = "only-long-tests"))]
mod timed_lanes;
#[cfg(not(feature = "only-long-tests"))]
mod timed_splitting;
#[cfg(not(feature = "only-long-tests"))]
mod trajectory;
