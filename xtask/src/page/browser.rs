//! The chapter "In a browser" of `docs/embedding.md`, and the page in headless Chromium: bits, curves,
//! sliders.

use std::ffi::OsString;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use std::{fs, thread};

use anyhow::{Context, Result, ensure};
use xshell::{Shell, cmd};

use super::{commands, script, show};
use crate::tools::{self, NotChecked};
use crate::{core_sources, project};

const TARGET: &str = "wasm32-unknown-unknown";

/// A server of files, which is stopped in the end.
struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Follows the chapter, holds the page against this machine's own runs, and writes its picture if that is
/// asked for.
pub fn run(picture: Option<PathBuf>) -> Result<()> {
    let shell = project::shell()?;
    let tools = tools::require(&shell, &[("python3", "python3"), ("chromium", "chromium")]);
    tools.map_err(|error| NotChecked::new("PAGE", error))?;
    // Where the firmware is built: what both depend on is compiled once, with the same variables.
    let target = core_sources::built();
    shell.set_var("CARGO_TARGET_DIR", &target);
    let of_the_module = if has_core(&shell)? {
        None
    } else {
        core_sources::provide(&shell).map_err(|error| NotChecked::new("PAGE", error))?;
        Some(("CARGO_UNSTABLE_BUILD_STD", "core"))
    };

    // The chapter's commands: rustup's, those that build the module, and the one that serves the page.
    let commands = commands("docs/embedding.md", Some("In a browser"), 1)?.concat();
    let (serve, rest): (Vec<_>, Vec<_>) = commands.lines().partition(|line| line.contains("http.server"));
    let build: Vec<_> = rest.into_iter().filter(|line| !line.starts_with("rustup ")).collect();
    ensure!(build.len() == 3 && serve.len() == 1, "the chapter has lost its commands");
    show(&commands);
    shell.remove_path("examples/browser/page/live.wasm")?;
    let build = build.join("\n").replace("cp target/", &format!("cp {}/", target.display()));
    script(&shell, &build).envs(of_the_module).run()?;

    shell.change_dir("examples/browser");
    cmd!(shell, "cargo fmt --check").run()?;
    let interface = cmd!(shell, "cargo run --quiet --release interface").output()?.stdout;
    let is_written = cmd!(shell, "diff - page/interface.js").stdin(interface).quiet().run();
    is_written.context("page/interface.js is not the module's: write it again")?;
    let work = shell.create_temp_dir()?;
    let runs = work.path().join("runs");
    fs::write(&runs, cmd!(shell, "cargo run --quiet --release runs").output()?.stdout)?;

    let (_server, port) = server(serve[0], &shell.current_dir())?;
    let page = format!("http://localhost:{port}");
    cmd!(shell, "python3 tests/page.py {page} {runs}").args(picture).run()?;
    Ok(())
}

/// Whether the toolchain has `core` for the module.
fn has_core(shell: &Shell) -> Result<bool> {
    let folder = cmd!(shell, "rustc --print target-libdir --target {TARGET}").quiet().read()?;
    let is_core = |name: OsString| name.to_string_lossy().starts_with("libcore-");
    Ok(fs::read_dir(folder).is_ok_and(|files| files.flatten().any(|file| is_core(file.file_name()))))
}

/// Starts the server of the chapter on a port that is free, whatever the page says.
fn server(command: &str, folder: &Path) -> Result<(Server, u16)> {
    let port = TcpListener::bind("localhost:0")?.local_addr()?.port();
    ensure!(command.contains(" 8000"), "the chapter's server has another port");
    // Bash makes way for it: what is killed in the end is the server.
    let command = format!("exec {}", command.replace(" 8000", &format!(" {port}")));
    let mut bash = Command::new("bash");
    bash.args(["-c", &command]).current_dir(folder).stdin(Stdio::null());
    let server = Server(bash.stdout(Stdio::null()).stderr(Stdio::null()).spawn()?);
    for _ in 0..50 {
        if TcpStream::connect(("localhost", port)).is_ok() {
            break;
        }
        thread::sleep(Duration::from_millis(100));
    }
    Ok((server, port))
}
