//! The chapters on C and on the browser of `docs/embedding.md` show the code of their templates.
//! `cargo xtask` follows their commands: `page c`, `firmware`, `page browser`.

use std::fs;
use std::path::Path;

/// The program of a test, which has the lines on tables.
const TABLES: &str = "../../bindings/c/tests/programs/tables.c";

/// The blocks of a language in the chapter.
fn blocks<'a>(chapter: &'a str, language: &str) -> Vec<&'a str> {
    let opening = format!("```{language}\n");
    chapter.split(&opening).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// Holds the blocks of a chapter, so many of each language, against files of its template.
fn shows(chapter: &str, template: &str, languages: &[(&str, &[&str], usize)]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = fs::read_to_string(root.join("docs/embedding.md")).expect("the page");
    let text = page.split(&format!("\n## {chapter}\n")).nth(1).expect("the chapter");
    let text = text.split("\n## ").next().expect("up to the next");
    for (language, files, count) in languages {
        let source = |file| fs::read_to_string(root.join(template).join(file)).expect("the template");
        let sources: Vec<_> = files.iter().map(source).collect();
        let blocks = blocks(text, language);
        assert_eq!(blocks.len(), *count, "{language}");
        for block in blocks {
            assert!(sources.iter().any(|source| source.contains(block)), "{files:?} have no\n{block}");
        }
    }
}

#[test]
fn the_chapters_show_the_templates() {
    shows("In C", "examples/c", &[("rust", &["src/lib.rs"], 2), ("c", &["main.c", TABLES], 4)]);
    shows("On a microcontroller, from C", "examples/firmware-c", &[("rust", &["src/lib.rs"], 2)]);
    let scripts: &[&str] = &["page/module.js", "page/runs.js"];
    shows("In a browser", "examples/browser", &[("rust", &["src/lib.rs"], 1), ("js", scripts, 2)]);
}
