//! Ceilings of instructions and stack: what was measured, and a tenth.

/// Instructions of one step.
#[derive(Clone, Copy)]
pub struct Ceiling {
    /// Mean over the scene's steps.
    pub mean: u32,
    /// The longest of them after the first.
    pub worst: u32,
}

impl Ceiling {
    /// That of the first step of a run, which also finds the velocity to start at and holds the values generated against the
    /// functions as written, at two points: 2.5 times the longest of the others.
    pub fn first(self) -> u32 {
        self.worst / 2 * 5
    }
}

/// The ceiling of a scene on a machine.
pub fn ceiling(machine: &str, level: &str, scene: &str) -> Option<Ceiling> {
    let (mean, worst) = match (machine, level, scene) {
        ("m4f", "3", "double_pendulum_f32") => (1_710, 2_820),
        ("m4f", "3", "cart_pole_f32") => (1_130, 1_240),
        ("m4f", "3", "double_pendulum_f64") => (71_000, 121_000),
        ("m4f", "3", "cart_pole_f64") => (46_000, 51_000),
        ("m4f", "s", "double_pendulum_f32") => (2_740, 3_610),
        ("m4f", "s", "cart_pole_f32") => (2_190, 2_300),
        ("m4f", "s", "double_pendulum_f64") => (75_000, 126_000),
        ("m4f", "s", "cart_pole_f64") => (50_000, 55_000),
        ("m7", "3", "double_pendulum_f32") => (1_630, 2_710),
        ("m7", "3", "cart_pole_f32") => (1_070, 1_180),
        ("m7", "3", "double_pendulum_f64") => (2_460, 3_300),
        ("m7", "3", "cart_pole_f64") => (1_850, 1_900),
        ("m7", "s", "double_pendulum_f32") => (2_660, 3_490),
        ("m7", "s", "cart_pole_f32") => (2_120, 2_230),
        ("m7", "s", "double_pendulum_f64") => (3_580, 4_910),
        ("m7", "s", "cart_pole_f64") => (2_950, 2_990),
        ("m33", "3", "double_pendulum_f32") => (1_700, 2_790),
        ("m33", "3", "cart_pole_f32") => (1_110, 1_220),
        ("m33", "3", "double_pendulum_f64") => (71_000, 121_000),
        ("m33", "3", "cart_pole_f64") => (46_000, 51_000),
        ("m33", "s", "double_pendulum_f32") => (2_410, 3_560),
        ("m33", "s", "cart_pole_f32") => (1_850, 1_950),
        ("m33", "s", "double_pendulum_f64") => (75_000, 126_000),
        ("m33", "s", "cart_pole_f64") => (50_000, 55_000),
        ("rv", "3", "double_pendulum_f32") => (34_000, 45_000),
        ("rv", "3", "cart_pole_f32") => (24_000, 26_000),
        ("rv", "3", "double_pendulum_f64") => (81_000, 137_000),
        ("rv", "3", "cart_pole_f64") => (52_000, 57_000),
        ("rv", "s", "double_pendulum_f32") => (37_000, 47_000),
        ("rv", "s", "cart_pole_f32") => (26_000, 28_000),
        ("rv", "s", "double_pendulum_f64") => (85_000, 142_000),
        ("rv", "s", "cart_pole_f64") => (55_000, 60_000),
        _ => return None,
    };
    Some(Ceiling { mean, worst })
}

/// Bytes of stack for scenes of a scalar type, on any machine; `f64` after `f32`.
pub fn stack_ceiling(scalar: &str) -> Option<u32> {
    match scalar {
        "f32" => Some(3_060),
        "f64" => Some(5_520),
        _ => None,
    }
}
