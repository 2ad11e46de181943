//! Runs: memory, checkpoints, compositions, splittings, an error asked for.

mod composition;
mod driven;
mod gauss_lanes;
mod kept;
mod kept_matrix;
mod lanes;
mod one_run;
mod saved_runs;
mod slack;
mod splitting;
mod splitting_conditions;
mod tolerance;
mod trajectory;
