//! The inputs that the fuzzer in `tests/fuzz/` has kept, on any compiler.

use std::fs;
use std::path::Path;

use crate as pipeline;

#[path = "../../../tests/fuzz/fuzz_targets/macro_tokens/answer.rs"]
mod answer;

#[test]
fn inputs_kept_by_the_fuzzer_are_answered() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("tests").join("fuzz/corpus/macro_tokens.txt");
    let (mut items, mut others) = (0, 0);
    let every = if cfg!(debug_assertions) { 4 } else { 1 };
    // Past a loop of 400 turns, which takes half of all the time.
    for line in fs::read_to_string(path).unwrap().lines().skip(every / 2).step_by(every) {
        // Hexadecimal digits, one input a line.
        let byte = |at| u8::from_str_radix(&line[at..at + 2], 16).unwrap();
        let text = String::from_utf8((0..line.len()).step_by(2).map(byte).collect()).unwrap_or_default();
        if answer::check(&text) { items += 1 } else { others += 1 }
    }
    assert!(items > 100 / every && others > 0, "{items} items and {others} other texts: this tests little");
}
