//! What a choice and its refusal say.

use core::fmt;

use super::{Choice, Method, ToleranceError, Trial};

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rule => f.write_str("order 2, the rule alone"),
            Self::KahanLi6 => f.write_str("order 6 in 9 substeps"),
            Self::KahanLi8 => f.write_str("order 8 in 17 substeps"),
            Self::BlanesMoan4 => f.write_str("order 4, splitting with 6 kicks"),
            Self::BlanesMoan6 => f.write_str("order 6, splitting with 11 kicks"),
            Self::Gauss4 => f.write_str("order 8, Gauss with 4 stages"),
            Self::Gauss8 => f.write_str("order 16, Gauss with 8 stages"),
        }
    }
}

impl fmt::Display for Trial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.step_size {
            Some(h) => write!(
                f,
                "{}: h = {h:.3e}, {:.3e} substeps, error {:.1e}",
                self.method, self.substeps, self.expected
            ),
            None => write!(f, "{}: its order does not show at the start", self.method),
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { method, step_size, steps, tolerance, expected, trials, .. } = self;
        write!(
            f,
            "{method}, h = {step_size:.4e}, {steps} steps: error {expected:.1e} expected, {tolerance:.1e} asked for"
        )?;
        trials.iter().flatten().try_for_each(|trial| write!(f, "\n  {trial}"))
    }
}

impl fmt::Display for ToleranceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Request { time, tolerance } => {
                write!(f, "time {time} and tolerance {tolerance} have to be finite and above 0")
            }
            Self::OutOfReach { closest } => {
                f.write_str("no method reaches the tolerance; ask for less, or for a shorter time")?;
                match closest {
                    Some(trial) => write!(f, "; the closest: {trial}"),
                    None => f.write_str("; none shows its order at the start"),
                }
            }
            Self::Step(error) => write!(f, "at the start: {error}"),
        }
    }
}

impl core::error::Error for ToleranceError {}
