//! The systems that the firmware steps, written once for the host and for every microcontroller.

#![no_std]
#![forbid(unsafe_code)]

pub mod language;
mod scenes;

pub use scenes::{double, single};
