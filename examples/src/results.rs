//! Results in files: there whole or not at all, and never lost.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::Path;
use std::{env, fs, process};

use anyhow::{Context, Result};
use atomic_write_file::AtomicWriteFile;

/// Writes `text` to `path`. Until all of it is on the disk, what was there before stays.
///
/// If that fails, the text is kept: in the folder for temporary files or else on standard output.
///
/// # Errors
/// The file cannot be written; the error says why, and where the text is.
pub fn save(path: &Path, text: &str) -> Result<()> {
    let Err(error) = replace(path, text) else { return Ok(()) };
    let name = path.file_name().unwrap_or(OsStr::new("results")).to_string_lossy();
    let spare = env::temp_dir().join(format!("dalembert-{}-{name}", process::id()));
    let kept = if replace(&spare, text).is_ok() {
        format!("nothing is lost: it is in {}", spare.display())
    } else if io::stdout().write_all(text.as_bytes()).is_ok() {
        "nothing is lost: it stands above, on standard output".to_owned()
    } else {
        "nor to the folder for temporary files, nor to standard output".to_owned()
    };
    let advice = advice(&error);
    Err(error).with_context(|| format!("cannot write {}; {kept}. What helps: {advice}", path.display()))
}

/// What helps against an error of writing.
pub fn advice(error: &io::Error) -> &'static str {
    use io::ErrorKind as Kind;
    match error.kind() {
        Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge => "make room",
        Kind::PermissionDenied | Kind::ReadOnlyFilesystem => "permit writing there, or give another path",
        Kind::NotADirectory | Kind::AlreadyExists | Kind::IsADirectory => {
            "a path that leads through folders, to a file"
        }
        _ => "another path",
    }
}

/// A new file under the name of the old one, once it is complete.
pub(crate) fn replace(path: &Path, text: &str) -> io::Result<()> {
    match fs::metadata(path) {
        // A pipe or a device must not be replaced by a file.
        Ok(present) if !present.is_file() => return fs::write(path, text),
        _ => fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?,
    }
    // Of a link, what it points to.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut file = AtomicWriteFile::open(path)?;
    file.write_all(text.as_bytes())?;
    file.commit()
}
