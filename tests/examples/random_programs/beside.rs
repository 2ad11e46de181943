//! Crates built by cargo beside the workspace, with its lock file.

use std::io::Result;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A crate in a folder of its own, whose packages are built in `target`.
pub struct Beside {
    pub folder: PathBuf,
    pub target: PathBuf,
}

impl Beside {
    /// Writes the manifest, and the lock file of the workspace where there is none yet.
    pub fn begin(&self, workspace: &Path, manifest: &str) -> Result<()> {
        std::fs::create_dir_all(self.folder.join("src"))?;
        write_if_changed(&self.folder.join("Cargo.toml"), manifest)?;
        let (lock, own) = (workspace.join("Cargo.lock"), self.folder.join("Cargo.lock"));
        if lock.exists() && !own.exists() {
            std::fs::copy(lock, own)?;
        }
        Ok(())
    }

    /// `cargo` with these arguments, without warnings.
    pub fn cargo(&self, arguments: &[&str]) -> Result<Output> {
        Command::new(env!("CARGO"))
            .args(arguments)
            .args(["--offline", "--quiet"])
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", &self.target)
            .env_remove("CARGO_PROFILE_DEV_DEBUG")
            .env("RUSTFLAGS", "-Awarnings")
            .output()
    }
}

/// Writes a file, unless that is what stands there: it would be built again.
fn write_if_changed(path: &Path, text: &str) -> Result<()> {
    if std::fs::read_to_string(path).is_ok_and(|old| old == text) {
        Ok(())
    } else {
        std::fs::write(path, text)
    }
}
