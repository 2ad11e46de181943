//! The inputs that the fuzzer in `fuzz/` has kept, on any compiler.

use std::fs;
use std::path::Path;

#[path = "../../../fuzz/fuzz_targets/macro_tokens/answer.rs"]
mod answer;

#[test]
fn inputs_kept_by_the_fuzzer_are_answered() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("fuzz").join("corpus/macro_tokens");
    let (mut items, mut others) = (0, 0);
    for entry in fs::read_dir(folder).unwrap() {
        let text = fs::read_to_string(entry.unwrap().path()).unwrap_or_default();
        if answer::check(&text) { items += 1 } else { others += 1 }
    }
    assert!(items > 100 && others > 0, "{items} items and {others} other texts: this tests little");
}
