//! The exact discrete objects.

mod cubic_drag;
mod derivatives;
mod existence;
mod failures;
mod flow;
mod order;
mod oscillator;
mod random;
mod units;
