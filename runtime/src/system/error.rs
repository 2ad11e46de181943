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
    /// A constraint.
    Constraint {
        /// Its place in the array, from 0.
        index: usize,
    },
    /// A component of p0 = −D1 L_d − f_d⁻, as the step's equation computes it.
    InitialMomentum {
        /// Its coordinate.
        index: usize,
    },
    /// A component of p1 = D2 L_d + f_d⁺, as the step computes it.
    FinalMomentum {
        /// Its coordinate.
        index: usize,
    },
}

/// A quantity of a function that is compared ([`verification`](crate::system::verification)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Compared {
    /// Its value.
    Value,
    /// Its derivative along a direction in (q, v).
    Derivative,
    /// Its second derivative along two directions in (q, v).
    SecondDerivative,
}

/// The derivatives generated belong to another function than the one written: it has another value, or
/// another slope ([`verification`](crate::system::verification)).
#[derive(Clone, Copy, PartialEq)]
pub struct GeneratedDiffers {
    /// Which function.
    pub function: Function,
    /// Which quantity of it.
    pub compared: Compared,
    /// The quantity as generated.
    pub generated: f64,
    /// The quantity of the function as written: a derivative by differences, a second one by those of the
    /// first as generated, and momenta by the derivatives of L_d and f_d.
    pub written: f64,
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lagrangian => f.write_str("L"),
            Self::Rayleigh => f.write_str("R"),
            Self::Force { index } => write!(f, "component {index} of f"),
            Self::TimeScale => f.write_str("σ"),
            Self::Constraint { index } => write!(f, "constraint {index}"),
            Self::InitialMomentum { index } => write!(f, "component {index} of p0"),
            Self::FinalMomentum { index } => write!(f, "component {index} of p1"),
        }
    }
}

impl fmt::Display for GeneratedDiffers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { function, compared, generated, written } = self;
        let along = match compared {
            Compared::Value => "",
            Compared::Derivative => "the derivative along a direction of ",
            Compared::SecondDerivative => "the second derivative along two directions of ",
        };
        write!(
            f,
            "{along}{function} is {written:e} as written and {generated:e} as generated: the derivatives belong to \
             another function, a fault of dalembert; report it with the body"
        )
    }
}

debug_by_display!(GeneratedDiffers);

impl core::error::Error for GeneratedDiffers {}
