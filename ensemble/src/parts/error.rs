//! Why parts are not written.

use core::fmt;
use std::io;
use std::path::PathBuf;

use parquet::errors::ParquetError;

use super::metadata::STARTS;
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
    /// A file that is there is another study's.
    AnotherStudy {
        /// Which.
        path: PathBuf,
        /// The key of the metadata that differs; `dalembert.starts` is of the members' fields and starts.
        key: String,
        /// Its value here.
        expected: Option<String>,
        /// Its value there.
        found: Option<String>,
    },
    /// A file that is there is not as it was written.
    Damaged {
        /// Which.
        path: PathBuf,
        /// The way in which it is not.
        what: &'static str,
    },
    /// A part that is there has the name of another.
    Misplaced {
        /// Which.
        path: PathBuf,
        /// The members that it holds.
        members: String,
    },
    /// A part that another call has put there meanwhile has other results than were computed here.
    Unequal {
        /// Which.
        path: PathBuf,
    },
    /// A part that was found or written is not there at the end of the call.
    Gone {
        /// Which.
        path: PathBuf,
    },
    /// The file system knows no way to put a file where none is without replacing one.
    MayReplace {
        /// Which file.
        path: PathBuf,
        /// The answer to the last of the ways.
        source: io::Error,
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
            Self::AnotherStudy { path, key, .. } if key == STARTS => write!(
                f,
                "{} is another study's: its members have other fields or starts, or another machine has rounded them \
                 otherwise; write into another folder",
                path.display()
            ),
            Self::AnotherStudy { path, key, expected, found } => {
                let [found, expected] = [found, expected].map(|value| value.as_deref().unwrap_or("nothing"));
                write!(
                    f,
                    "{} is another study's: {key} is {found} there and {expected} here; write into another folder",
                    path.display()
                )
            }
            Self::Damaged { path, what } => {
                write!(f, "{} is damaged: {what}; remove it, and it is made again", path.display())
            }
            Self::Misplaced { path, members } => write!(
                f,
                "{} holds the members {members}: it has been renamed; give it its name, or remove it",
                path.display()
            ),
            Self::Unequal { path } => write!(
                f,
                "{} was written by another call meanwhile, with other results for the same members: a member is not \
                 a function of its number, or the programs differ",
                path.display()
            ),
            Self::Gone { path } => write!(
                f,
                "{} was there and is not any more: something else removes parts; the same call writes it again",
                path.display()
            ),
            Self::MayReplace { path, source } => write!(
                f,
                "{}: {source}; this file system has neither links nor a rename that replaces nothing, so that of \
                 two programs at once one could replace parts of the other: write into a folder of another one",
                path.display()
            ),
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
                write!(f, "cancelled after {done} of {members} members")
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
            Self::Io { source, .. } | Self::MayReplace { source, .. } => Some(source),
            Self::Parquet { source, .. } => Some(source),
            _ => None,
        }
    }
}
