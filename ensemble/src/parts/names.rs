//! Names of files: of parts, and of drafts of them.

use std::ops::Range;
use std::path::{Path, PathBuf};

const PREFIX: &str = "members-";
const SUFFIX: &str = ".parquet";

/// The study that a folder is of. A Parquet file: polars refuses a folder with any other beside the parts.
/// pyarrow leaves out names that begin with `_`.
pub(super) const STUDY: &str = "_study.parquet";

/// The file of the members `part`.
pub(super) fn path(folder: &Path, part: &Range<u64>) -> PathBuf {
    folder.join(format!("{PREFIX}{:012}-{:012}{SUFFIX}", part.start, part.end))
}

/// The members of a file by its name.
pub(super) fn members(name: &str) -> Option<Range<u64>> {
    let (start, end) = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?.split_once('-')?;
    Some(start.parse().ok()?..end.parse().ok()?)
}

/// A draft of the file `place`, the `count`-th that this process writes on `host`.
pub(super) fn draft(place: &Path, count: u64, host: &str) -> PathBuf {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    place.with_file_name(format!(".{name}.{}-{count}@{host}", std::process::id()))
}

/// The file that a draft is of, and the host of its writer.
pub(super) fn drafted(name: &str) -> Option<(&str, &str)> {
    let (name, host) = name.strip_prefix('.')?.split_once('@')?;
    let (of, _) = name.rsplit_once('.')?;
    (of == STUDY || members(of).is_some()).then_some((of, host))
}
