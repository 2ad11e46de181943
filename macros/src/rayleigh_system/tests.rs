//! Tests of the pipeline: what it writes, what it refuses.

mod oracle;
mod refusals;
mod snapshots;
