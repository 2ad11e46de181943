//! The repository: where it is, and what files it has.

use std::path::{Path, PathBuf};
use std::{env, fs};

use anyhow::{Context, Result};
use xshell::{Shell, cmd};

/// The repository's folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a package in a folder of the repository")
}

/// A shell that stands in the repository's folder.
pub fn shell() -> Result<Shell> {
    let shell = Shell::new()?;
    shell.change_dir(root());
    Ok(shell)
}

/// The folder that cargo builds in, if `CARGO_TARGET_DIR` names no other.
pub fn target() -> PathBuf {
    root().join(env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()))
}

/// The files that are committed or may be, with this ending, by their paths from the root.
pub fn files(shell: &Shell, ending: &str) -> Result<Vec<String>> {
    let pattern = format!("*{ending}");
    let listed = cmd!(shell, "git ls-files --cached --others --exclude-standard --deduplicate -- {pattern}");
    let listed = listed.quiet().read().context("the repository's files")?;
    // One that is deleted is listed until that is committed.
    Ok(listed.lines().filter(|path| root().join(path).is_file()).map(str::to_owned).collect())
}

/// The text of a file of the repository.
pub fn text(path: impl AsRef<Path>) -> Result<String> {
    let path = root().join(path);
    fs::read_to_string(&path).with_context(|| path.display().to_string())
}

/// The Rust files below `directory`, but for those that cargo builds: their paths from `from`, and their
/// texts.
pub fn sources(from: &Path, directory: &Path) -> Result<Vec<(String, String)>> {
    let mut files = Vec::new();
    let entries = fs::read_dir(directory).with_context(|| directory.display().to_string())?;
    for entry in entries {
        let path = entry?.path();
        if path.is_dir() {
            if path.file_name().is_some_and(|name| name == "target") {
                continue;
            }
            files.extend(sources(from, &path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(from)?.display().to_string().replace('\\', "/");
            files.push((name, text(&path)?));
        }
    }
    files.sort();
    Ok(files)
}
