//! Tests of the expanding engine: derivatives against num-dual, refusals.

mod oracle;
mod refusals;
