//! The names of what an error can speak of.

use core::fmt;

/// A quantity that an error speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// The configuration q.
    Configuration,
    /// The velocity v, or the guess for v̄.
    Velocity,
    /// The momentum p.
    Momentum,
    /// The derivatives of L, R, f or a constraint, at the point where the step evaluated them.
    Derivatives,
    /// An entry of the input u that a view holds.
    InputEntry,
    /// The time t of a view.
    Time,
    /// A field of the system, or a constant of its block.
    Field {
        /// Its name, as the body reads it: `k`, `c[0]`.
        name: &'static str,
    },
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Configuration => "configuration",
            Self::Velocity => "velocity",
            Self::Momentum => "momentum",
            Self::Derivatives => "derivative of L, R, f or a constraint",
            Self::InputEntry => "entry of the input",
            Self::Time => "time",
            Self::Field { name } => return write!(f, "field {name}"),
        })
    }
}
