//! Runs: memory, checkpoints, compositions, splittings, an error asked for.

mod anchors;
mod between;
mod close_pairs;
mod composition;
mod driven;
mod events;
mod found_by_breaking;
mod gauss_lanes;
mod kept;
mod kept_matrix;
mod lanes;
mod midpoint_lanes;
mod one_run;
mod period;
mod random_events;
mod saved_runs;
mod scaled_time;
mod slack;
mod splitting;
mod splitting_conditions;
mod timed_lanes;
mod timed_splitting;
mod tolerance;
mod touching;
mod trajectory;
mod until;
