//! What C and C++ compilers make of the headers, and that programs in C have the bits of the run in Rust.
//!
//! gcc has to be there; clang and valgrind are used where they are, and where the variable CI is set they
//! have to be.

#[allow(dead_code)]
mod systems;
mod compilers {
    mod chapter;
    mod constrained;
    mod programs;
    mod standards;
    mod tables;
}

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const WARNINGS: [&str; 5] = ["-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror"];

/// Of `tools` those that this machine has, and on CI all of them.
fn there(tools: &[&'static str]) -> Vec<&'static str> {
    those_that(tools, "are installed", |tool| Command::new(tool).arg("--version").output().is_ok())
}

fn those_that(tools: &[&'static str], what: &str, does: impl Fn(&str) -> bool) -> Vec<&'static str> {
    let found: Vec<_> = tools.iter().copied().filter(|tool| does(tool)).collect();
    if found.len() < tools.len() {
        eprintln!("of {tools:?} only {found:?} {what}: nothing is said of the others");
        assert!(std::env::var_os("CI").is_none(), "of {tools:?} only {found:?} {what}");
    }
    found
}

/// A folder of this test's own with all headers.
fn folder(name: &str) -> PathBuf {
    use systems::constrained::{rods, skate, spherical};
    use systems::tables::{bead, rocket};
    use systems::{cart_pole, ring, swing, winch};
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("a folder beside the build");
    let of_free = [cart_pole::HEADER, ring::HEADER, swing::HEADER, winch::HEADER];
    let others = [spherical::HEADER, rods::HEADER, skate::HEADER, rocket::HEADER, bead::HEADER];
    for header in of_free.into_iter().chain(others) {
        fs::write(folder.join(header.prefix).with_extension("h"), header.to_string()).expect("a header");
    }
    folder
}

/// The library of `examples/systems.rs`, which is built with the tests.
fn library() -> PathBuf {
    let test = std::env::current_exe().expect("a test");
    let library = test.ancestors().nth(2).expect("deps/ is in a folder").join("examples/libsystems.a");
    assert!(library.exists(), "build it: cargo build -p dalembert-c --example systems");
    library
}

/// Runs `command`, which says something only where it fails.
fn output(command: &mut Command) -> Output {
    command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"))
}

/// The program `source` of `tests/programs/`, built in `folder` by `compiler` with `flags`.
fn program(folder: &Path, compiler: &str, source: &str, flags: &[&str]) -> PathBuf {
    let program =
        folder.join(format!("{compiler}-{}-{}", source.replace('.', "-"), flags.join("").replace('/', "-")));
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs").join(source);
    let mut command = Command::new(compiler);
    command.args(WARNINGS).args(flags).arg("-I").arg(folder).arg("-o").arg(&program).arg(source);
    let built = output(command.arg(library()).args(["-lpthread", "-ldl", "-lm"]));
    assert!(built.status.success(), "{command:?}: {}", String::from_utf8_lossy(&built.stderr));
    program
}
