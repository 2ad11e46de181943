//! Any text, as an annotated item: the macros never panic, and answer an item with items.
//!
//! Inputs are Rust source, beginning with the attribute. Most mutations change the syntax tree, so that what
//! comes out is an item again and gets past the parser.

#![no_main]

mod answer;
mod fragments;
mod mutation;

/// The pipeline of the macro crate, as its own tests include it.
#[path = "../../../../macros/src"]
#[allow(dead_code, reason = "the macro crate's own tests look further inside")]
mod pipeline {
    pub mod rayleigh_system;
}

// Its files name one another from the root of their crate.
use pipeline::rayleigh_system;

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};

fuzz_target!(|data: &[u8]| -> Corpus {
    let Ok(text) = std::str::from_utf8(data) else { return Corpus::Reject };
    answer::check(text);
    Corpus::Keep
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutation::mutated(data, size, max_size, seed)
});
