//! Tests of the pipeline, called as plain code: derivatives against num-dual, refusals, what it writes, and
//! that nothing makes it panic.

mod cancelling;
mod corpus;
mod deep;
mod factoring;
mod fusing;
mod hygiene;
mod odd_input;
mod oracle;
mod refusals;
mod sizes;
mod snapshots;
mod tape;
