//! Runs in lanes: every member's state is bit by bit that of its own run, whatever runs beside it, in
//! however many lanes, at once or in parts; and a member that fails has none.

mod alone;
mod explicit;
mod refilled;
mod splitting;
mod systems;
mod told;

pub use alone::{agree, agree_in_all, agree_in_two, bits, damping, forward, members, refilled, start};
pub use systems::Chain;
