//! Tests of the expanding engine: derivatives against num-dual, refusals.

mod factoring;
mod oracle;
mod refusals;
mod sizes;
