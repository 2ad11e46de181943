//! `Display` of the events and samples of a run.

use core::fmt;

use nalgebra::SVector;

use super::Sample;
use super::events::{Event, Passage};
use crate::numbers::Scalar;

/// `(1.0, −0.5)`, with the precision that is asked for.
struct Entries<'v, S, const N: usize>(&'v SVector<S, N>);

impl<S: Scalar, const N: usize> fmt::Display for Entries<'_, S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("(")?;
        for (i, entry) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str(", ")?;
            }
            fmt::Display::fmt(entry, f)?;
        }
        f.write_str(")")
    }
}

impl fmt::Display for Passage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rising => "rising",
            Self::Falling => "falling",
            Self::Touching => "touching",
        })
    }
}

/// `event 0, rising, at t = 1.5: q = (0.0), v = (1.0)`; a precision, as in `{:.3}`, is that of all numbers.
impl<S: Scalar, const N: usize> fmt::Display for Event<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "event {}, {}, at t = ", self.index, self.passage)?;
        fmt::Display::fmt(&self.time, f)?;
        f.write_str(": q = ")?;
        fmt::Display::fmt(&Entries(&self.state.q), f)?;
        f.write_str(", v = ")?;
        fmt::Display::fmt(&Entries(&self.velocity), f)
    }
}

/// `t = 1.5: q = (0.0), p = (1.0); 12 iterations`, and how many steps were damped if any was.
impl<S: Scalar, const N: usize> fmt::Display for Sample<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("t = ")?;
        fmt::Display::fmt(&self.time, f)?;
        f.write_str(": q = ")?;
        fmt::Display::fmt(&Entries(&self.state.q), f)?;
        f.write_str(", p = ")?;
        fmt::Display::fmt(&Entries(&self.state.p), f)?;
        write!(f, "; {} iterations", self.iterations)?;
        if self.damped > 0 {
            write!(f, ", {} steps damped", self.damped)?;
        }
        Ok(())
    }
}
