//! The headers in every standard that they are written for, without a warning.

use std::fs;
use std::process::Command;

use crate::{WARNINGS, folder, output, there};

/// What the compiler says of `source`, or nothing.
fn complaint(compiler: &str, standard: &str, folder: &std::path::Path, source: &str) -> Option<String> {
    let language = if standard.contains("++") { "c++" } else { "c" };
    let file = folder.join(format!("{}{standard}.{language}", compiler.replace('+', "p")));
    fs::write(&file, source).expect("a source file");
    let mut command = Command::new(compiler);
    command.args(["-x", language, "-fsyntax-only"]).arg(format!("-std={standard}")).args(WARNINGS);
    let said = output(command.arg("-I").arg(folder).arg(file));
    (!said.status.success()).then(|| String::from_utf8_lossy(&said.stderr).into_owned())
}

const STANDARDS: [&str; 5] = ["c99", "c11", "c17", "c++17", "c++20"];

#[test]
fn every_header_alone_and_all_together_compile_without_a_warning() {
    let folder = folder("standards");
    let names = ["cart_pole", "ring", "swing", "winch", "spherical", "rods", "skate", "rocket", "bead"];
    let all = names.map(|name| format!("#include \"{name}.h\"\n"));
    let sources: Vec<_> = all.iter().cloned().chain([all.concat() + &all.concat()]).collect();
    for compiler in there(&["gcc", "clang"]) {
        for standard in STANDARDS {
            for source in &sources {
                let source = format!("{source}int main(void);\nint main(void) {{ return 0; }}\n");
                let source = if standard.contains("++") { source.replace("(void)", "()") } else { source };
                assert_eq!(complaint(compiler, standard, &folder, &source), None, "{compiler} {standard}");
            }
        }
    }
}

#[test]
fn another_layout_and_another_version_are_refused_when_c_is_compiled() {
    let folder = folder("layouts");
    let header = fs::read_to_string(folder.join("ring.h")).expect("a header");
    let narrower = header.replace("float weights[2][3];", "float weights[2][2];");
    let moved = header.replace("uint8_t name;", "").replace("float k;", "float k; uint8_t name;");
    let later = format!("#define DALEMBERT_VERSION 1234\n{header}");
    for compiler in there(&["gcc", "clang"]) {
        for standard in STANDARDS {
            for source in [&narrower, &moved, &later] {
                assert!(*source != header, "the control changes something");
                let said = complaint(compiler, standard, &folder, source);
                let said = said.unwrap_or_else(|| panic!("{compiler} {standard} compiles it"));
                let reasons = ["laid out as in the library", "dalembert_asserted", "different versions"];
                assert!(reasons.iter().any(|reason| said.contains(reason)), "{said}");
            }
        }
    }
}

#[test]
fn the_template_s_header_is_that_of_its_model() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/c/include/cart_pole.h");
    let written = crate::systems::cart_pole::HEADER.to_string();
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        fs::write(path, &written).expect("a header");
    }
    let committed = fs::read_to_string(path).expect("a header");
    assert!(committed == written, "with UPDATE_SNAPSHOTS=1 this test writes it anew");
}

#[test]
fn documentation_of_the_source_stands_in_the_header_and_ends_no_comment() {
    let header = crate::systems::ring::HEADER.to_string();
    assert!(header.contains("    /** Drag. */\n    float k;"), "{header}");
    assert!(header.contains(" * A comment * / that would end C's."), "{header}");
    assert!(header.contains("float by_parameters[4][1]; /**< by k */"), "{header}");
}
