//! Ceilings of instructions and stack: what was measured, and at most a tenth, rounded up.

/// Instructions of one step.
#[derive(Clone, Copy)]
pub struct Ceiling {
    /// Mean over the scene's steps.
    pub mean: u32,
    /// The longest of them after the first.
    pub worst: u32,
}

impl Ceiling {
    /// That of the first step of a run, which also finds the velocity to start at and holds the values
    /// generated against the functions as written, at two points: three times the ceiling of the others.
    pub fn first(self) -> u32 {
        self.worst * 3
    }
}

/// The ceiling of a scene on a machine.
pub fn ceiling(machine: &str, level: &str, scene: &str) -> Option<Ceiling> {
    let (mean, worst) = match (machine, level, scene) {
        ("m4f", "3", "double_pendulum_f32") => (1_710, 2_310),
        ("m4f", "3", "cart_pole_f32") => (1_130, 1_240),
        ("m4f", "3", "pushed_cart_pole_f32") => (1_250, 1_350),
        ("m4f", "3", "double_pendulum_f64") => (71_000, 97_000),
        ("m4f", "3", "cart_pole_f64") => (46_000, 47_000),
        ("m4f", "3", "pushed_cart_pole_f64") => (50_000, 51_000),
        ("m4f", "s", "double_pendulum_f32") => (2_290, 2_740),
        ("m4f", "s", "cart_pole_f32") => (1_710, 1_810),
        ("m4f", "s", "pushed_cart_pole_f32") => (1_890, 1_970),
        ("m4f", "s", "double_pendulum_f64") => (74_000, 100_000),
        ("m4f", "s", "cart_pole_f64") => (48_000, 49_000),
        ("m4f", "s", "pushed_cart_pole_f64") => (53_000, 54_000),
        ("m7", "3", "double_pendulum_f32") => (1_630, 2_170),
        ("m7", "3", "cart_pole_f32") => (1_070, 1_180),
        ("m7", "3", "pushed_cart_pole_f32") => (1_140, 1_230),
        ("m7", "3", "double_pendulum_f64") => (1_750, 2_360),
        ("m7", "3", "cart_pole_f64") => (1_200, 1_250),
        ("m7", "3", "pushed_cart_pole_f64") => (1_260, 1_310),
        ("m7", "s", "double_pendulum_f32") => (2_220, 2_670),
        ("m7", "s", "cart_pole_f32") => (1_680, 1_780),
        ("m7", "s", "pushed_cart_pole_f32") => (1_820, 1_900),
        ("m7", "s", "double_pendulum_f64") => (2_620, 3_370),
        ("m7", "s", "cart_pole_f64") => (2_010, 2_050),
        ("m7", "s", "pushed_cart_pole_f64") => (2_120, 2_160),
        ("m33", "3", "double_pendulum_f32") => (1_700, 2_270),
        ("m33", "3", "cart_pole_f32") => (1_110, 1_220),
        ("m33", "3", "pushed_cart_pole_f32") => (1_220, 1_310),
        ("m33", "3", "double_pendulum_f64") => (71_000, 97_000),
        ("m33", "3", "cart_pole_f64") => (46_000, 47_000),
        ("m33", "3", "pushed_cart_pole_f64") => (50_000, 51_000),
        ("m33", "s", "double_pendulum_f32") => (2_310, 2_760),
        ("m33", "s", "cart_pole_f32") => (1_720, 1_820),
        ("m33", "s", "pushed_cart_pole_f32") => (1_870, 1_950),
        ("m33", "s", "double_pendulum_f64") => (75_000, 101_000),
        ("m33", "s", "cart_pole_f64") => (49_000, 50_000),
        ("m33", "s", "pushed_cart_pole_f64") => (53_000, 54_000),
        ("rv", "3", "double_pendulum_f32") => (34_000, 38_000),
        ("rv", "3", "cart_pole_f32") => (24_000, 26_000),
        ("rv", "3", "pushed_cart_pole_f32") => (27_000, 28_000),
        ("rv", "3", "double_pendulum_f64") => (81_000, 111_000),
        ("rv", "3", "cart_pole_f64") => (52_000, 55_000),
        ("rv", "3", "pushed_cart_pole_f64") => (57_000, 58_000),
        ("rv", "s", "double_pendulum_f32") => (37_000, 41_000),
        ("rv", "s", "cart_pole_f32") => (26_000, 28_000),
        ("rv", "s", "pushed_cart_pole_f32") => (30_000, 31_000),
        ("rv", "s", "double_pendulum_f64") => (85_000, 117_000),
        ("rv", "s", "cart_pole_f64") => (55_000, 59_000),
        ("rv", "s", "pushed_cart_pole_f64") => (61_000, 63_000),
        _ => return None,
    };
    Some(Ceiling { mean, worst })
}

/// Bytes of stack for scenes of a scalar type, on any machine; `f64` after `f32`, and those of constraints
/// and dry friction after both.
pub fn stack_ceiling(scalar: &str) -> Option<u32> {
    match scalar {
        "f32" => Some(4_200),
        "f64" | "bordered" => Some(7_300),
        _ => None,
    }
}
