//! A bead on a wire: mass and friction depend on q.

use dalembert::rayleigh_system;

use crate::by_hand::{ByHand, Number};

/// A bead on the wire y = sin q in the potential m g y + ½kq²; q is the horizontal coordinate.
///
/// ```text
/// L = ½m(1 + cos²q) v² − m g sin q − ½kq²,   R = ½r(2 + sin q) v² + ¼c(1 + q²) v⁴
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bead {
    /// Mass.
    pub m: f64,
    /// Acceleration of gravity.
    pub g: f64,
    /// Stiffness.
    pub k: f64,
    /// Coefficient of linear friction.
    pub r: f64,
    /// Coefficient of cubic friction.
    pub c: f64,
}

impl Bead {
    /// Parameters without accidental coincidences.
    pub const EXAMPLE: Self = Self { m: 0.7, g: 1.3, k: 2.1, r: 0.3, c: 0.2 };
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Bead {
    fn slope(q: f64) -> f64 {
        q.cos()
    }

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let [q] = q;
        let speed_squared = (1.0 + Self::slope(q).powi(2)) * v[0].powi(2);
        0.5 * self.m * speed_squared - self.m * self.g * q.sin() - 0.5 * self.k * q * q
    }

    fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.r * (2.0 + q[0].sin()) * v[0].powi(2) + 0.25 * self.c * (1.0 + q[0] * q[0]) * v[0].powi(4)
    }
}

impl ByHand<1> for Bead {
    fn lagrangian_by_hand<D: Number>(&self, [q]: [D; 1], [v]: [D; 1]) -> D {
        let c = q.cos();
        v * v * (c * c + 1.0) * (self.m / 2.0) - q.sin() * (self.m * self.g) - q * q * (self.k / 2.0)
    }

    fn rayleigh_by_hand<D: Number>(&self, [q]: [D; 1], [v]: [D; 1]) -> D {
        let square = v * v;
        (q.sin() + 2.0) * square * (self.r / 2.0) + (q * q + 1.0) * square * square * (self.c / 4.0)
    }

    /// d/dt[m(1 + cos²q) v] = −m sin q cos q v² − m g cos q − k q − ∂R/∂v.
    fn acceleration(&self, [q]: [f64; 1], [v]: [f64; 1]) -> [f64; 1] {
        let (s, c) = q.sin_cos();
        let friction = self.r * (2.0 + s) * v + self.c * (1.0 + q * q) * v * v * v;
        let force = self.m * s * c * v * v - self.m * self.g * c - self.k * q - friction;
        [force / (self.m * (1.0 + c * c))]
    }
}
