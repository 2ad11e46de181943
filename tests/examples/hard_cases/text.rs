//! What the page says without figures of its own.

/// The heading at which it begins.
pub const FIRST_HEADING: &str = "## Also tested\n";

/// All of it: what has tests alone, what random and broken input and faults do, what was once wrong.
pub fn without_figures() -> String {
    // The comments say where a topic's rows belong.
    let once_wrong = include_str!("once_wrong.md").lines().filter(|line| !line.starts_with("<!--"));
    let once_wrong = once_wrong.map(|line| format!("{line}\n")).collect::<String>();
    format!("{ALSO_TESTED}{}\n{once_wrong}", include_str!("adversarial.md"))
}

/// What has tests alone, with nothing to plot.
const ALSO_TESTED: &str = "## Also tested\n\n\
| case | what happens | test |\n\
| --- | --- | --- |\n\
| negative damping, z = hr/2m → −1 | grows by (1 + z)/(1 − z); at z = 1 `SingularNewtonMatrix`; past it the root exists and has the wrong sign: choose h < 2m/\\|r\\| | `damping.rs` |\n\
| damping of both signs (van der Pol, μ = 1, 50) | period and amplitude of the cycle to order 2 | `damping.rs` |\n\
| friction written carelessly: `cosh` overflows, 1 − 1 cancels | `NoDerivative`, with R; rest to the rounding of 1 | `damping.rs` |\n\
| ∂²L/∂v² singular, L linear in v | `DegenerateLagrangian` with its coordinate, at the first step | `singular.rs` |\n\
| \\|q\\|, \\|q\\|^{3/2}, √\\|q\\|, drag \\|v\\|^{3/2} at 0 | rest where the equations hold next to it, `NoDerivative` where none exists, roots next to it | `singular.rs` |\n\
| coordinates in units of 2^{∓40} | the same motion to rounding, the same iterations | `scales.rs` |\n\
| h from ±1e-12 to ±1e12 | a step or an error; without friction −h leads back to rounding | `scales.rs` |\n\
| NaN, ±∞, subnormal and huge values in every argument | an error that names the argument, or a finite step | `scales.rs` |\n\
| a user function that panics, at any call | the trajectory holds its last state and goes on bit for bit | `faults.rs` |\n";
