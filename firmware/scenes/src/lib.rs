//! The systems that the firmware steps, written once for the host and for every microcontroller.

#![no_std]
// What `dalembert_c::parameters!` writes says that a struct holds numbers alone: the one thing unsafe.
#![deny(unsafe_code)]

pub mod language;
mod scenes;

pub use scenes::{Stepped, double, single};

use dalembert::State;
use dalembert::system::Scalar;

/// How many steps each scene takes.
pub const STEPS: u32 = 200;

/// Joins the bits of a state to a digest of those before (FNV-1a over words).
#[must_use]
pub fn digest<S: Scalar, const N: usize>(before: u64, state: &State<S, N>) -> u64 {
    let numbers = state.q.iter().chain(state.p.iter());
    numbers.fold(before, |hash, number| (hash ^ number.widen().to_bits()).wrapping_mul(0x100_0000_01b3))
}
