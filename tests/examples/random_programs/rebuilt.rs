//! The study itself, built with another source of the macro: with a mistake put back, for instance.

use std::path::{Path, PathBuf};

use super::beside::Beside;
use super::run::{folder, workspace};

/// A replacement of text in a file of `macros/src/rayleigh_system`.
#[derive(Clone, Copy)]
pub struct Edit {
    pub file: &'static str,
    pub old: &'static str,
    pub new: &'static str,
}

impl Edit {
    /// The text of the file with the replacement made.
    pub fn made_in(self, text: &str) -> Result<String, String> {
        if text.matches(self.old).count() == 1 {
            Ok(text.replace(self.old, self.new))
        } else {
            Err(format!("{} does not hold once: {}", self.file, self.old))
        }
    }
}

fn copied(from: &Path, to: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(to)?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copied(&entry.path(), &target)?;
        } else {
            let text = std::fs::read(entry.path())?;
            if !std::fs::read(&target).is_ok_and(|old| old == text) {
                std::fs::write(&target, text)?;
            }
        }
    }
    Ok(())
}

/// The study built with the macro's source from `macros`, edited; its program.
pub fn study(macros: &Path, edits: &[Edit]) -> Result<PathBuf, String> {
    let words = |error: std::io::Error| error.to_string();
    let root = folder()?.join("rebuilt");
    let source = root.join("macros/src");
    copied(macros, &source).map_err(words)?;
    copied(&workspace().join("tests/examples/random_programs"), &root.join("tests/examples/random_programs"))
        .map_err(words)?;
    for edit in edits {
        let path = source.join("rayleigh_system").join(edit.file);
        let text = std::fs::read_to_string(&path).map_err(words)?;
        std::fs::write(&path, edit.made_in(&text)?).map_err(words)?;
    }
    let manifest = format!(
        "[package]\nname = \"rebuilt-study\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
        [[bin]]\nname = \"rebuilt-study\"\npath = \"examples/random_programs/main.rs\"\n\n\
        [dependencies]\ncorosensei = \"0.3.4\"\ndalembert-tests = {{ path = {:?}, default-features = false }}\n\
        nalgebra = {{ version = \"0.35\", default-features = false, features = [\"libm\", \"std\"] }}\n\
        num-dual = \"0.15.1\"\nprettyplease = \"0.3.0\"\nproc-macro2 = {{ version = \"1.0.107\", features = [\"span-locations\"] }}\n\
        quote = \"1.0.47\"\nsyn = {{ version = \"3\", features = [\"full\", \"visit\", \"visit-mut\"] }}\n\n\
        [profile.dev]\nopt-level = 1\ndebug = false\nincremental = false\n",
        workspace().join("tests")
    );
    let beside = Beside { folder: root.join("tests"), target: folder()?.join("target") };
    beside.begin(&workspace(), &manifest).map_err(words)?;
    let build = beside.cargo(&["build"]).map_err(words)?;
    if !build.status.success() {
        return Err(String::from_utf8_lossy(&build.stderr).into_owned());
    }
    Ok(beside.target.join("debug/rebuilt-study"))
}
