//! Motions at random with references that share nothing with the methods under test: closed forms where there
//! are some, and extrapolation in twice the digits elsewhere. What
//! [`tolerance`](dalembert::tolerance) promises is held against them.

mod collection;
mod measured;
mod reference;
mod systems;

pub use collection::{collection, driven, of_family};
pub use measured::{Cheapest, Clock, Motion, Outcome, Verdict};
pub use reference::extrapolated;
