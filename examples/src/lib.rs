//! What the scenes share: the comparison methods, the controllers, the style of the pictures, the files of
//! results and of runs that go on, and the ring system written by hand.
//!
//! Each scene is one file of `examples/`.

pub mod baseline;
pub mod by_hand;
pub mod control;
pub mod picture;
pub mod results;
pub mod saved_run;
