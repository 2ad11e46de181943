//! Instructions, counted by valgrind's callgrind: the same on every run of one build.

use std::process::Command;

/// The first argument of a run that valgrind watches; the scene, the way, the [`Part`] and the number of
/// times follow.
pub const COUNTED: &str = "--counted";

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A whole step.
    Step,
    /// What a step evaluates, once: the step's equation with its matrix, and both momenta.
    Evaluation,
}

impl Part {
    /// Every one.
    pub const ALL: [Self; 2] = [Self::Step, Self::Evaluation];

    /// A word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Evaluation => "evaluation",
        }
    }
}

/// Runs this program again under callgrind so many times over and twice as many; the difference is that of
/// the part alone. `None` where valgrind is not installed.
pub fn each(scene: &str, way: &str, part: Part, times: usize) -> Option<f64> {
    let [once, twice] = [times, 2 * times].map(|times| collected(scene, way, part, times));
    Some((twice? as f64 - once? as f64) / times as f64)
}

/// Instructions of a whole run.
fn collected(scene: &str, way: &str, part: Part, times: usize) -> Option<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe().ok()?)
        .args([COUNTED, scene, way, part.name(), &times.to_string()])
        .output()
        .ok()?;
    let report = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{scene}, {way}, under valgrind:\n{report}");
    let line = report.lines().find_map(|line| line.split_once("Collected :"))?;
    line.1.trim().parse().ok()
}
