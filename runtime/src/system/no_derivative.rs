//! The error of a derivative of L, R, f or a constraint that does not exist.

use core::fmt;

use crate::system::{Function, Place};

/// A derivative of L, R, f or a constraint that is NaN or infinite, or a component of f or a constraint that
/// is so itself.
#[derive(Clone, Copy, PartialEq)]
pub struct NoDerivative {
    /// Which function.
    pub function: Function,
    /// The coordinate i of the derivative by qᵢ or vᵢ; of no meaning where a value alone is none.
    pub coordinate: usize,
    /// The operation that has no derivative there: of a system whose derivatives are written out, where it is
    /// an operation of the body that has none, and not a number that became too large.
    pub place: Option<Place>,
}

impl fmt::Display for NoDerivative {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { function, coordinate, place } = self;
        match place {
            Some(place) => write!(
                f,
                "the derivative of {function} by coordinate {coordinate} is NaN or infinite: {place}"
            ),
            None => write!(
                f,
                "{function} or its derivative by coordinate {coordinate} is NaN or infinite; look first at the fields of the system and its input: one may be NaN, infinite or too large; then at \
                 {function}: √s has no derivative at s = 0 (√(s + ε²) has), a power below 1 and a logarithm have none at \
                 0; if its derivatives are finite at the state given, the step leaves the region where they are: try a \
                 smaller step"
            ),
        }
    }
}

debug_by_display!(NoDerivative);

impl core::error::Error for NoDerivative {}
