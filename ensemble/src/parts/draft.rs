//! Files that are put in their place whole, once, and in place of no other.
//!
//! A draft is written beside its place under a name with the host and the process, and locked while its
//! writer lives. When all of it is on the disk it gets a second name, its place: a link, which a file system
//! makes only where there is none of that name. So of several writers one is first, and the others learn it.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::PartsError;
use super::names;

/// Drafts that are written of a file, where something else removes them.
pub(super) const TRIES: usize = 4;

/// The error where all of them were removed.
pub(super) fn removed() -> io::Error {
    io::Error::new(io::ErrorKind::NotFound, "something else removes its drafts, files that begin with a dot")
}

/// A file that is not in its place.
pub(super) struct Draft {
    pub(super) file: File,
    path: PathBuf,
    place: PathBuf,
}

/// The end of a draft.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Put {
    /// It is in its place.
    Placed,
    /// Another is there.
    Taken,
    /// Somebody has removed it.
    Removed,
}

impl Draft {
    /// An empty draft of the file `place`.
    pub(super) fn of(place: &Path) -> io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        loop {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = names::draft(place, count, host().unwrap_or("unknown"));
            let file = match OpenOptions::new().read(true).write(true).create_new(true).open(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                file => file?,
            };
            // Where a file system has no locks, nobody else gets one either, and spares it.
            let _ = file.try_lock();
            // Between the two somebody may have taken it for a leftover.
            if path.try_exists()? {
                return Ok(Self { file, path, place: place.to_owned() });
            }
        }
    }

    /// Puts it in its place, unless there is a file of that name.
    pub(super) fn put(self) -> Result<Put, PartsError> {
        self.put_by(&[link, rename])
    }

    /// As [`put`](Self::put), in the first of these ways that the file system knows.
    fn put_by(self, ways: &[Way]) -> Result<Put, PartsError> {
        let Self { file, path, place } = &self;
        let at = |source| PartsError::Io { path: place.clone(), source };
        file.sync_all().map_err(at)?;
        let mut unknown = io::ErrorKind::Unsupported.into();
        for way in ways {
            match way(path, place) {
                Ok(()) => {
                    sync_folder(place).map_err(at)?;
                    return Ok(Put::Placed);
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => return Ok(Put::Taken),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    let is_taken = place.try_exists().map_err(at)?;
                    return Ok(if is_taken { Put::Taken } else { Put::Removed });
                }
                Err(error) if is_unknown(&error) => unknown = error,
                Err(error) => return Err(at(error)),
            }
        }
        Err(PartsError::MayReplace { path: place.clone(), source: unknown })
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // A leftover does no harm.
        let _ = fs::remove_file(&self.path);
    }
}

/// A way to give a file a name that no file has.
type Way = fn(&Path, &Path) -> io::Result<()>;

fn link(from: &Path, to: &Path) -> io::Result<()> {
    fs::hard_link(from, to)
}

/// For file systems without links, such as FAT.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn rename(from: &Path, to: &Path) -> io::Result<()> {
    use nix::fcntl::{AT_FDCWD, RenameFlags, renameat2};
    Ok(renameat2(AT_FDCWD, from, AT_FDCWD, to, RenameFlags::RENAME_NOREPLACE)?)
}

/// [`fs::rename`] replaces what is there.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn rename(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Whether a file system says that it does not know this.
fn is_unknown(error: &io::Error) -> bool {
    use io::ErrorKind::{InvalidInput, PermissionDenied, TooManyLinks, Unsupported};
    matches!(error.kind(), Unsupported | PermissionDenied | InvalidInput | TooManyLinks)
}

/// Has the name of a file on the disk, where a folder can be opened.
fn sync_folder(place: &Path) -> io::Result<()> {
    match place.parent() {
        Some(folder) if cfg!(unix) => File::open(folder)?.sync_all(),
        _ => Ok(()),
    }
}

/// The name of this machine, in which neither a folder nor the user's characters are.
fn host() -> Option<&'static str> {
    static HOST: OnceLock<Option<String>> = OnceLock::new();
    let plain = |of: char| if of.is_ascii_alphanumeric() || of == '.' { of } else { '-' };
    HOST.get_or_init(|| Some(host_name()?.chars().map(plain).collect())).as_deref()
}

#[cfg(unix)]
fn host_name() -> Option<String> {
    nix::unistd::gethostname().ok()?.into_string().ok()
}

#[cfg(not(unix))]
fn host_name() -> Option<String> {
    std::env::var("COMPUTERNAME").ok()
}

/// Removes drafts of the files for which `is_ours` that nobody writes, and counts the others.
///
/// A draft whose file is there is of no use to its writer, who finds that file. Otherwise its writer lives
/// as long as the lock is held; of a draft of another host that is not known here, and it is spared.
pub(super) fn sweep(folder: &Path, is_ours: impl Fn(&str) -> bool) -> io::Result<u64> {
    let mut spared = 0;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let Some((of, writer)) = name.to_str().and_then(names::drafted) else { continue };
        if !is_ours(of) {
            continue;
        }
        let path = entry.path();
        let is_of_no_use = folder.join(of).try_exists()?;
        // Held until the file is removed: a writer who begins sees that it is gone.
        let lock = if is_of_no_use || Some(writer) != host() { None } else { File::open(&path).ok() };
        let is_left = lock.as_ref().is_some_and(|file| file.try_lock().is_ok());
        // It does no harm if that fails.
        let is_gone = (is_of_no_use || is_left) && fs::remove_file(&path).is_ok();
        spared += u64::from(!is_gone && path.try_exists()?);
    }
    Ok(spared)
}

#[cfg(test)]
mod tests;
