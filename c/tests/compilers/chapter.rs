//! The chapter "In C" of `docs/embedding.md` shows the code of the template. `c/run` follows its commands.

use std::fs;
use std::path::Path;

/// The blocks of a language in the chapter.
fn blocks<'a>(chapter: &'a str, language: &str) -> Vec<&'a str> {
    let opening = format!("```{language}\n");
    chapter.split(&opening).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn the_chapter_shows_the_template() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = fs::read_to_string(root.join("docs/embedding.md")).expect("the page");
    let chapter = page.split("\n## In C\n").nth(1).expect("the chapter");
    let chapter = chapter.split("\n## ").next().expect("up to the next");
    for (language, file, count) in [("rust", "src/lib.rs", 2), ("c", "main.c", 3)] {
        let source = fs::read_to_string(root.join("examples/c").join(file)).expect("the template");
        let blocks = blocks(chapter, language);
        assert_eq!(blocks.len(), count, "{language}");
        for block in blocks {
            assert!(source.contains(block), "{file} has no\n{block}");
        }
    }
}
