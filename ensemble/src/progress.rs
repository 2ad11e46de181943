//! How far a study is, and that it was cancelled.

use core::fmt;

/// How far a study is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Members that are done, those that failed among them.
    pub done: u64,
    /// Members that failed.
    pub failed: u64,
    /// Members in all.
    pub members: u64,
}

/// A study that was cancelled by its progress callback.
#[derive(Clone, PartialEq, Eq)]
pub struct Cancelled<A> {
    /// The total over the members finished before it was cancelled: a prefix of the range.
    pub total: A,
    /// How far it was.
    pub progress: Progress,
}

impl<A> fmt::Display for Cancelled<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Progress { done, members, .. } = self.progress;
        write!(f, "cancelled after {done} of {members} members")
    }
}

impl<A> fmt::Debug for Cancelled<A> {
    /// The text of [`Display`](fmt::Display), which `main` and `unwrap` print.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl<A> core::error::Error for Cancelled<A> {}
