//! One compile for each diagnostic of the macro and of the runtime's traits: what is said, where, and that it
//! is said once.
//!
//! rustc words its own part of a message anew from version to version, so the expected messages are held
//! against the version that they were written with; another one skips them, and says so, or fails where the
//! variable `CI` is set. `TRYBUILD=overwrite cargo test -p dalembert-diagnostics` writes
//! them anew. Read each one before committing.

use std::env;
use std::process::Command;

/// The compiler whose messages stand in `ui/*.stderr`.
const COMPILER: &str = "rustc 1.95.";

/// The flags under which trybuild has the mistakes compiled, but for those of single lints. On its own it
/// compiles the dependencies under others first, all of them a second time: half a minute.
const FLAGS: &str = "--cfg\u{1f}trybuild\u{1f}--verbose\u{1f}-A\u{1f}dead_code\u{1f}--diagnostic-width=140";

#[test]
fn mistakes_are_explained_where_they_are_made() {
    let compiler = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version = Command::new(compiler).arg("--version").output().expect("cargo runs with a compiler");
    let version = String::from_utf8_lossy(&version.stdout).into_owned();
    if !version.starts_with(COMPILER) {
        let skipped = format!("the messages are those of {COMPILER}x, this is {version}");
        assert!(env::var_os("CI").is_none(), "{skipped}");
        return eprintln!("skipped: {skipped}");
    }
    if env::var_os("CARGO_ENCODED_RUSTFLAGS").is_none_or(|flags| flags != FLAGS) {
        // Variables cannot be changed within a process without `unsafe`.
        let test = env::current_exe().expect("a test is a program");
        let ended =
            Command::new(test).args(env::args_os().skip(1)).env("CARGO_ENCODED_RUSTFLAGS", FLAGS).status();
        return assert!(ended.expect("it runs again").success(), "see above");
    }
    let cases = trybuild::TestCases::new();
    cases.compile_fail("ui/*.rs");
    if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
        cases.compile_fail("ui/x86/*.rs");
    }
}
