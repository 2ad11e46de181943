//! The chapter "In C" of `docs/embedding.md`, with gcc and with clang.

use anyhow::{Result, ensure};
use xshell::{Shell, cmd};

use super::{commands, expect_line, move_home, script, show};
use crate::project;
use crate::tools::{self, NotChecked};

/// Follows the chapter. The compilers and tools that it and `cargo test -p dalembert-c` use are installed.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    install(&shell).map_err(|error| NotChecked::new("C", error))?;
    let blocks = commands("docs/embedding.md", Some("In C"), 3)?;
    cmd!(shell, "cargo fmt --manifest-path examples/c/Cargo.toml --check").run()?;

    let home = shell.create_temp_dir()?;
    move_home(&shell, home.path())?;
    // All build in one place: dalembert is compiled once.
    shell.set_var("CARGO_TARGET_DIR", project::target());
    for compiler in ["gcc", "clang"] {
        shell.remove_path("examples/c/control_loop")?;
        shell.remove_path("target/control-loop")?;
        // The copy differs in its place alone.
        for block in blocks.iter().filter(|block| compiler == "gcc" || !block.contains("cp -r")) {
            show(block);
            let said = script(&shell, block).env("CC", compiler).read()?;
            expect_line(&said, "rad from upright")?;
        }
    }
    Ok(())
}

fn install(shell: &Shell) -> Result<()> {
    let tools = ["gcc", "g++", "clang", "cmake", "make", "valgrind"].map(|tool| (tool, tool));
    tools::require(shell, &tools)?;
    if !has_sanitizers(shell) {
        // They are a package of clang's version.
        let version = cmd!(shell, "clang -dumpversion").quiet().read()?;
        let version = version.split('.').next().unwrap_or_default();
        tools::install(shell, &[&format!("libclang-rt-{version}-dev")])?;
    }
    ensure!(has_sanitizers(shell) && tools::is_there("clang++"), "the tools installed do not work");
    Ok(())
}

fn has_sanitizers(shell: &Shell) -> bool {
    let compile = cmd!(shell, "clang -x c -fsanitize=address,undefined -o /dev/null -");
    compile.stdin("int main(void) { return 0; }").quiet().ignore_stderr().run().is_ok()
}
