//! Instructions per step, counted by valgrind's callgrind: the same on every run of one build.

use std::process::Command;

/// The first argument of a run that valgrind watches; the scene, the way and the number of steps follow.
pub const COUNTED: &str = "--counted";

/// Runs this program again under callgrind with `steps` and with twice as many steps; the difference is that of the steps
/// alone. `None` where valgrind is not installed.
pub fn per_step(scene: &str, way: &str, steps: usize) -> Option<f64> {
    let [once, twice] = [steps, 2 * steps].map(|steps| collected(scene, way, steps));
    Some((twice? as f64 - once? as f64) / steps as f64)
}

/// Instructions of a whole run.
fn collected(scene: &str, way: &str, steps: usize) -> Option<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe().ok()?)
        .args([COUNTED, scene, way, &steps.to_string()])
        .output()
        .ok()?;
    let report = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{scene}, {way}, under valgrind:\n{report}");
    let line = report.lines().find_map(|line| line.split_once("Collected :"))?;
    line.1.trim().parse().ok()
}
