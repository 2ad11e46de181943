//! A guide for users, in nine chapters; every code block is a test.
//!
//! Read the first two chapters in order; the others stand alone.
//!
#![doc = include_str!("guide/chapters.md")]
//!
//! The scenes that the chapters name are programs: `cargo run --release --example ring` in a clone of the
//! repository. Each prints a table and writes a picture to `target/`.

#[doc = include_str!("guide/pictures/oscillator.link")]
#[doc = include_str!("guide/first_system.md")]
pub mod first_system {}

#[doc = include_str!("guide/pictures/long-run.link")]
#[doc = include_str!("guide/rule_and_step.md")]
pub mod rule_and_step {}

#[doc = include_str!("guide/pictures/cart-pole.link")]
#[doc = include_str!("guide/control.md")]
pub mod control {}

#[doc = include_str!("guide/control_loop.md")]
pub mod control_loop {}

#[doc = include_str!("guide/pictures/energy-ledger.link")]
#[doc = include_str!("guide/checkers.md")]
pub mod checkers {}

#[doc = include_str!("guide/own_rule.md")]
pub mod own_rule {}

#[doc = include_str!("guide/microcontrollers.md")]
pub mod microcontrollers {}

#[doc = include_str!("guide/pictures/escape.link")]
#[doc = include_str!("guide/many_members.md")]
pub mod many_members {}

#[doc = include_str!("guide/symbols.md")]
pub mod symbols {}
