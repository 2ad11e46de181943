//! The error of generated derivatives that do not belong to the functions as written.

use core::fmt;

/// A function of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Function {
    /// L.
    Lagrangian,
    /// R.
    Rayleigh,
    /// A component of f.
    Force {
        /// Its coordinate.
        index: usize,
    },
    /// σ, the time scale.
    TimeScale,
}

/// The derivatives generated belong to another function than the one written: their values differ
/// ([`verification`](crate::system::verification)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneratedDiffers {
    /// Which function.
    pub function: Function,
    /// Its value as generated together with its derivatives.
    pub generated: f64,
    /// Its value as written.
    pub written: f64,
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lagrangian => f.write_str("L"),
            Self::Rayleigh => f.write_str("R"),
            Self::Force { index } => write!(f, "component {index} of f"),
            Self::TimeScale => f.write_str("σ"),
        }
    }
}

impl fmt::Display for GeneratedDiffers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { function, generated, written } = self;
        write!(
            f,
            "{function} is {written:e} as written and {generated:e} as generated: the derivatives belong to another \
             function, a fault of dalembert; report it with the body, and use `derivatives = num_dual` until it is mended"
        )
    }
}

impl core::error::Error for GeneratedDiffers {}
