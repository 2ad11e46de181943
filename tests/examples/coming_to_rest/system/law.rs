//! Laws of potentials.

/// A function of one linear form of the coordinates, x.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// ½kx²
    Spring,
    /// ¼kx⁴
    Cubic,
    /// −k cos x
    Pendulum,
    /// −k/√(x² + 1)
    Attraction,
    /// k ln cosh x
    Saturating,
    /// k(eˣ + e⁻ˣ)
    Walls,
    /// −kx
    Load,
}

impl Law {
    /// The largest second derivative where |x| ≤ `extent`, for k = 1.
    pub fn stiffness(self, extent: f64) -> f64 {
        match self {
            Self::Spring | Self::Pendulum | Self::Saturating => 1.0,
            Self::Attraction => 1.0,
            Self::Cubic => 3.0 * extent * extent,
            Self::Walls => 2.0 * extent.min(6.0).cosh(),
            Self::Load => 0.0,
        }
    }

    /// V as a Rust expression of `x`, a unit of length `l` and a factor `k`, one of several ways of writing
    /// it.
    pub fn text(self, k: &str, x: &str, l: &str, way: usize) -> String {
        let squared = match way % 3 {
            0 => format!("({x}).powi(2)"),
            1 => format!("({x}) * ({x})"),
            _ => format!("{{ let d = {x}; d * d }}"),
        };
        match self {
            Self::Spring => format!("0.5 * {k} * {squared}"),
            Self::Cubic => format!("0.25 * {k} * ({x}).powi(4) / ({l} * {l})"),
            Self::Pendulum => format!("-{k} * {l} * {l} * (({x}) / {l}).cos()"),
            Self::Attraction => format!("-{k} * {l} * {l} * {l} / ({squared} + {l} * {l}).sqrt()"),
            Self::Saturating => format!("{k} * {l} * {l} * (({x}) / {l}).cosh().ln()"),
            Self::Walls => format!("{k} * {l} * {l} * ((({x}) / {l}).exp() + (-({x}) / {l}).exp())"),
            Self::Load => format!("-{k} * {l} * ({x})"),
        }
    }
}
