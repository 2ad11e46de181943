//! One compile for each diagnostic of the macro and of the runtime's traits: what is said, where, and that it
//! is said once.
//!
//! rustc words its own part of a message anew from version to version, so the expected messages are held
//! against the version that they were written with; another one skips them, and says so, or fails where the
//! variable `CI` is set. `TRYBUILD=overwrite cargo test -p dalembert-diagnostics` writes
//! them anew. Read each one before committing.

use std::process::Command;

/// The compiler whose messages stand in `ui/*.stderr`.
const COMPILER: &str = "rustc 1.95.";

#[test]
fn mistakes_are_explained_where_they_are_made() {
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version = Command::new(compiler).arg("--version").output().expect("cargo runs with a compiler");
    let version = String::from_utf8_lossy(&version.stdout).into_owned();
    if !version.starts_with(COMPILER) {
        let skipped = format!("the messages are those of {COMPILER}x, this is {version}");
        assert!(std::env::var_os("CI").is_none(), "{skipped}");
        return eprintln!("skipped: {skipped}");
    }
    trybuild::TestCases::new().compile_fail("ui/*.rs");
}
