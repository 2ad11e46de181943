//! The chapter "As a functional mock-up unit" of `docs/embedding.md` shows the code of the template.
//! `cargo xtask page fmu` follows its commands.

use std::fs;
use std::path::Path;

#[test]
fn the_chapter_shows_the_template() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = fs::read_to_string(root.join("docs/embedding.md")).expect("the page");
    let chapter = page.split("\n## ").find_map(|part| part.strip_prefix("As a functional mock-up unit\n"));
    let chapter = chapter.expect("the chapter");
    let template = fs::read_to_string(root.join("examples/fmu/src/lib.rs")).expect("the template");
    let blocks: Vec<_> =
        chapter.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(blocks.len(), 2);
    for block in blocks {
        assert!(template.contains(block), "the template has no\n{block}");
    }
}
