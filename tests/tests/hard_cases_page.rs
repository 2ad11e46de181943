//! `docs/hard-cases.md` has what the program that writes it takes from a file, as it stands there.

use std::fs;
use std::path::Path;

#[test]
fn the_page_ends_with_what_was_tried_on_purpose() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("docs").join("hard-cases.md");
    let page = fs::read_to_string(page).unwrap();
    let text = include_str!("../examples/hard_cases/adversarial.md");
    assert!(text.contains("## Faults") && text.contains("## Random and broken input"));
    assert!(page.ends_with(text), "copy tests/examples/hard_cases/adversarial.md to the end of the page");
}
