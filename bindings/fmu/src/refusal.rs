//! Why a call was refused.

use std::fmt;

use dalembert::StepError;
use dalembert_face::WrongPoints;

/// Why a call did nothing.
#[derive(Clone, PartialEq)]
pub enum Refusal {
    /// A step, or the start, has no result.
    Step { error: StepError, time: f64 },
    /// The communication step is none.
    CommunicationStep(f64),
    /// The importer is at another time.
    AnotherTime { given: f64, own: f64 },
    /// h is not finite and positive.
    StepSize(f64),
    /// A start time that is none.
    StartTime(f64),
    /// No variable has this value reference.
    NoVariable(u32),
    /// The variable is of another type.
    AnotherType { name: String, kind: &'static str },
    /// The variable cannot be set, now or ever.
    NotSettable { name: String, mode: Mode },
    /// NaN, or infinity where that is no value.
    NotFinite { name: String },
    /// The points of a table make none.
    Points(WrongPoints),
    /// An output is NaN or infinite.
    Output { name: String, value: f64, time: f64 },
    /// Arrays of different lengths.
    Lengths { asked: usize, given: usize },
    /// An address is NULL or misaligned.
    Address(&'static str),
    /// Text that is not UTF-8, or names no category.
    Category,
    /// The call does not belong into this mode.
    NotNow(Mode),
    /// No derivative of one by the other.
    NoDerivative { unknown: String, known: String },
    /// There is no communication step to be derived.
    NoStep,
    /// Bytes that no state of this unit was written as.
    Bytes,
    /// A function of another kind of unit.
    Absent(&'static str),
    /// Variables of a type of which the unit has none.
    NoSuchType(&'static str),
}

/// How far an instance has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    Instantiated,
    Initialization,
    Step,
    Terminated,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Instantiated => "instantiated, not initialized",
            Self::Initialization => "in initialization mode",
            Self::Step => "in step mode",
            Self::Terminated => "terminated",
        })
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step { error, time } => write!(f, "at time {time}: {error}"),
            Self::CommunicationStep(size) => {
                write!(
                    f,
                    "the communication step {size} is not positive, or too short or too long to be taken"
                )
            }
            Self::AnotherTime { given, own } => {
                write!(f, "the communication point {given} is not where the unit is, at {own}")
            }
            Self::StepSize(h) => write!(f, "the step size {h} is not finite and positive: set step_size"),
            Self::StartTime(time) => write!(f, "the start time {time} is not finite"),
            Self::NoVariable(reference) => write!(f, "no variable has the value reference {reference}"),
            Self::AnotherType { name, kind } => write!(f, "{name} is of the type {kind}"),
            Self::NotSettable { name, mode } => write!(f, "{name} cannot be set while the unit is {mode}"),
            Self::NotFinite { name } => write!(f, "{name} was given a value that is no finite number"),
            Self::Points(wrong) => write!(f, "the points of {wrong}"),
            Self::Output { name, value, time } => write!(
                f,
                "at time {time}: the output {name} is {value}, no finite number: `fn outputs` has no value at this state and \
                 input"
            ),
            Self::Lengths { asked, given } => {
                write!(f, "{asked} numbers belong there, and {given} are given")
            }
            Self::Address(argument) => write!(f, "{argument} is NULL or misaligned"),
            Self::Category => {
                write!(f, "the log has the categories logStatusDiscard, logStatusError, logStatusFatal")
            }
            Self::NotNow(mode) => write!(f, "the call does not belong here: the unit is {mode}"),
            Self::NoDerivative { unknown, known } => write!(
                f,
                "no derivative of {unknown} by {known}: in step mode there are those of q, p, v, energy by u, by q and p at \
                 the beginning of the communication step, and of q and p by the parameters that the model lists; in \
                 initialization mode those of p and energy by q and v, unless constraints hold these"
            ),
            Self::NoStep => write!(f, "no derivatives yet: they are those of the last communication step"),
            Self::Bytes => write!(f, "these bytes are no state of this unit"),
            Self::Absent(function) => write!(f, "{function} is not part of what this unit offers"),
            Self::NoSuchType(kind) => write!(f, "the unit has no variable of the type {kind}"),
        }
    }
}

impl fmt::Debug for Refusal {
    /// The text of [`Display`](fmt::Display), which `main` and `unwrap` print.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Refusal {}
