//! Operations that have no derivative at some arguments, and what to write instead.

use core::fmt;

use crate::numbers::Scalar;

/// An operation that has no derivative at some arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Operation {
    /// √s, none at s ≤ 0.
    SquareRoot,
    /// ∛s, none at s = 0.
    CubeRoot,
    /// sʸ; where y is below 2 and no whole number, no second derivative at s = 0, and none at s < 0.
    Power,
    /// A logarithm of s, none at s ≤ 0.
    Logarithm,
    /// The logarithm of 1 + s, none at s ≤ −1.
    LogarithmOfSum,
    /// A quotient by s, none at s = 0.
    Division,
    /// The arc sine or arc cosine of s, none at |s| ≥ 1.
    ArcSine,
    /// The inverse hyperbolic cosine of s, none at s ≤ 1.
    AreaCosine,
    /// The inverse hyperbolic tangent of s, none at |s| ≥ 1.
    AreaTangent,
    /// The angle of (x, y), none at (0, 0).
    Angle,
    /// √(x² + y²), none at (0, 0).
    Length,
}

/// An operation as it stands in a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Which operation.
    pub operation: Operation,
    /// Its text, with the names of the body as far as those are known.
    pub text: &'static str,
}

/// An operation at an argument where it has no derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The operation.
    pub written: &'static Written,
    /// The argument s; of an angle and a length, both are 0.
    pub argument: f64,
}

impl Place {
    /// The first of these operations that has no derivative at its arguments: s and, of a power, y; of an
    /// angle and a length, x and y; else s and 0.
    #[cold]
    #[must_use]
    pub fn first<S: Scalar>(of: &[(&'static Written, [S; 2])]) -> Option<Self> {
        of.iter().find_map(|&(written, [argument, second])| {
            let (argument, second) = (argument.widen(), second.widen());
            let is_singular = written.operation.is_singular_at(argument, second);
            is_singular.then_some(Self { written, argument })
        })
    }
}

impl Operation {
    fn is_singular_at(self, s: f64, second: f64) -> bool {
        match self {
            Self::SquareRoot | Self::Logarithm => s <= 0.0,
            Self::CubeRoot | Self::Division => s == 0.0,
            Self::Power => {
                let is_whole = second % 1.0 == 0.0;
                (s == 0.0 && (second < 0.0 || (second < 2.0 && !is_whole))) || (s < 0.0 && !is_whole)
            }
            Self::LogarithmOfSum => s <= -1.0,
            Self::ArcSine | Self::AreaTangent => s.abs() >= 1.0,
            Self::AreaCosine => s <= 1.0,
            Self::Angle | Self::Length => s == 0.0 && second == 0.0,
        }
    }

    /// The operation as a formula in s.
    const fn formula(self) -> &'static str {
        match self {
            Self::SquareRoot => "√s",
            Self::CubeRoot => "∛s",
            Self::Power => "a power of s",
            Self::Logarithm => "a logarithm of s",
            Self::LogarithmOfSum => "ln(1 + s)",
            Self::Division => "a quotient by s",
            Self::ArcSine => "an arc sine or arc cosine of s",
            Self::AreaCosine => "arcosh s",
            Self::AreaTangent => "artanh s",
            Self::Angle => "the angle of (s, s)",
            Self::Length => "√(s² + s²)",
        }
    }

    /// The cure: a text to write instead, where s is at the end of what the operation takes.
    const fn cure(self, is_at_end: bool) -> &'static str {
        match self {
            Self::SquareRoot if is_at_end => "write √(s + ε²)",
            Self::CubeRoot => "write s (s² + ε²)^(−1/3)",
            Self::Power if is_at_end => "write (s + ε)ʸ, for a power of |x| (x² + ε²)^(y/2)",
            Self::Logarithm if is_at_end => "write the logarithm of s + ε",
            Self::Division => "write s/(s² + ε²) for 1/s, or keep s away from 0",
            Self::Angle => "start away from that point, or take coordinates that need no angle there",
            Self::Length => "write √(x² + y² + ε²)",
            Self::SquareRoot | Self::Power | Self::Logarithm => {
                "keep s above 0; if it is at the state given, try a smaller step"
            }
            Self::LogarithmOfSum => "keep s above −1; if it is at the state given, try a smaller step",
            Self::ArcSine | Self::AreaTangent => {
                "keep |s| below 1; if it is at the state given, try a smaller step"
            }
            Self::AreaCosine => "keep s above 1; if it is at the state given, try a smaller step",
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { written: Written { operation, text }, argument } = *self;
        // −0 is 0.
        let s = argument + 0.0;
        let formula = operation.formula();
        write!(f, "{formula} has none at s = {s}, in `{text}`; {}", operation.cure(s == 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_the_first_argument_without_a_derivative() {
        const ROOT: &Written = &Written { operation: Operation::SquareRoot, text: "x.sqrt()" };
        const POWER: &Written = &Written { operation: Operation::Power, text: "x.powf(y)" };
        let of = |root: f64, [s, y]: [f64; 2]| Place::first(&[(ROOT, [root; 2]), (POWER, [s, y])]);
        assert_eq!(of(0.0, [0.0, 0.5]), Some(Place { written: ROOT, argument: 0.0 }));
        assert_eq!(of(1.0, [0.0, 1.5]), Some(Place { written: POWER, argument: 0.0 }));
        assert_eq!(of(1.0, [-2.0, 1.5]), Some(Place { written: POWER, argument: -2.0 }));
        assert_eq!(of(1.0, [0.0, -1.0]), Some(Place { written: POWER, argument: 0.0 }));
        for finite in [[0.0, 2.5], [0.0, 1.0], [0.0, 0.0], [-2.0, 3.0], [0.1, 0.5], [f64::NAN, 0.5]] {
            assert_eq!(of(f64::NAN, finite), None);
        }
    }
}
