//! Why parts are not written.

use core::fmt;
use std::io;
use std::path::PathBuf;

use parquet::errors::ParquetError;

use crate::progress::Progress;

/// Why parts are not written.
#[non_exhaustive]
pub enum PartsError {
    /// The file system refuses.
    Io {
        /// Which file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A part cannot be written, or one that is there cannot be read.
    Parquet {
        /// Which.
        path: PathBuf,
        /// Why.
        source: ParquetError,
    },
    /// A part that is there is another study's.
    AnotherStudy {
        /// Which.
        path: PathBuf,
        /// The key of the metadata that differs.
        key: String,
        /// Its value here.
        expected: String,
        /// Its value there.
        found: Option<String>,
    },
    /// A part that is there holds some of the same members, and others.
    Overlap {
        /// Which.
        path: PathBuf,
    },
    /// The members do not start with a part.
    Unaligned {
        /// The first member.
        start: u64,
        /// Members of a part.
        members: u64,
    },
    /// The progress callback cancelled.
    Cancelled(Progress),
}

impl fmt::Display for PartsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, source } => write!(f, "{}: {source}", path.display()),
            Self::Parquet { path, source } => write!(
                f,
                "{}: {source}; what is no part may be removed, and is computed again",
                path.display()
            ),
            Self::AnotherStudy { path, key, expected, found } => {
                let found = found.as_deref().unwrap_or("nothing");
                write!(
                    f,
                    "{} is another study's: {key} is {found} there and {expected} here; write into another folder",
                    path.display()
                )
            }
            Self::Overlap { path } => write!(
                f,
                "{} holds some of these members and others: take the members_per_part that it was written with, or \
                 another folder",
                path.display()
            ),
            Self::Unaligned { start, members } => write!(
                f,
                "members from {start} on do not start with a part of {members}: take a multiple of it"
            ),
            Self::Cancelled(Progress { done, members, .. }) => {
                write!(f, "cancelled after {done} of the {members} members of a part")
            }
        }
    }
}

impl fmt::Debug for PartsError {
    /// The text of [`Display`](fmt::Display), which `main` and `unwrap` print.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl core::error::Error for PartsError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            Self::Parquet { source, .. } => Some(source),
            _ => None,
        }
    }
}
