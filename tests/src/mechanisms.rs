//! Mechanisms of points, rods and bars, and a second program for their steps, in twice the precision.
//!
//! A mechanism is written once for the attribute ([`mechanism!`](crate::mechanism)), and its slopes by hand
//! over any number, from the same list of joints and forces ([`Shape`]). Nothing of the second is the
//! runtime's.

mod drawn;
mod elimination;
mod equations;
mod judged;
mod oracle;
#[cfg(test)]
mod oracle_tests;
mod report;
mod run;
mod shape;
mod system;

pub use drawn::{Drawn, Kind};
pub use equations::{Number, Rule};
pub use judged::{Judged, MOST, MOST_OFF, off};
pub use oracle::{Curve, End, Problem, Root};
pub use report::report;
pub use run::{Judged as JudgedSystem, Outcome, Refused, run, start};
pub use shape::{Force, ForceValues, Joint, JointValues, Shape, Values};
pub use system::Mechanism;
