//! Lines of documentation that name no variable.

use core::fmt;

/// A line about a variable, of the documentation of the struct or of `fn outputs`, that cannot be followed.
///
/// It is the inner error of the [`io::Error`](std::io::Error) that packing then ends with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum NamingError {
    /// The unit has no such variable.
    NoVariable {
        /// The line.
        line: &'static str,
    },
    /// An earlier line is about this variable.
    ToldTwice {
        /// The line.
        line: &'static str,
    },
    /// The name before the colon is none of FMI.
    NoName {
        /// The line.
        line: &'static str,
    },
    /// Another variable has the name.
    NameTwice {
        /// The line.
        line: &'static str,
    },
}

impl fmt::Display for NamingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, fault) = match self {
            Self::NoVariable { line } => {
                (line, "the unit has no such variable: count from 0, and y as many as `fn outputs` returns")
            }
            Self::ToldTwice { line } => (line, "an earlier line is about this variable: write one"),
            Self::NoName { line } => (
                line,
                "what stands before the colon is no name of FMI: write one such as `load` or `load.height`, of letters, \
                 digits and _, or leave it out",
            ),
            Self::NameTwice { line } => (line, "another variable of the unit has this name: choose another"),
        };
        write!(f, "in the documentation of the system, `{line}`: {fault}")
    }
}

impl fmt::Debug for NamingError {
    /// The text of [`Display`](fmt::Display), which `main` and `unwrap` print.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for NamingError {}
