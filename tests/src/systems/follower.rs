//! A general force alone, without a Rayleigh function.

use dalembert::rayleigh_system;

use crate::by_hand::{ByHand, Number};

/// A particle in a double well under a circulating force and friction that depends on q.
///
/// ```text
/// L = ½m(1 + ½x²) v_x² + ½m v_y² − ¼(x² − 1)² − ½y²
/// f = (−κy − r v_x, κx − r(1 + x²) v_y + r v_x v_y)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Follower {
    /// Mass.
    pub m: f64,
    /// Strength of the circulating force.
    pub kappa: f64,
    /// Coefficient of friction.
    pub r: f64,
}

impl Follower {
    /// Parameters without accidental coincidences.
    pub const EXAMPLE: Self = Self { m: 1.6, kappa: 0.4, r: 0.3 };
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Follower {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [x, y] = q;
        0.5 * self.m * ((1.0 + 0.5 * x * x) * v[0].powi(2) + v[1].powi(2))
            - 0.25 * (x * x - 1.0).powi(2)
            - 0.5 * y * y
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let second = self.kappa * q[0] - self.r * (1.0 + q[0] * q[0]) * v[1] + self.r * v[0] * v[1];
        [-self.kappa * q[1] - self.r * v[0], second]
    }
}

impl ByHand<2> for Follower {
    fn lagrangian_by_hand<D: Number>(&self, [x, y]: [D; 2], v: [D; 2]) -> D {
        let well = x * x - 1.0;
        (v[0] * v[0] * (x * x / 2.0 + 1.0) + v[1] * v[1]) * (self.m / 2.0) - well * well / 4.0 - y * y / 2.0
    }

    fn force_by_hand<D: Number>(&self, [x, y]: [D; 2], v: [D; 2]) -> [D; 2] {
        let second = x * self.kappa - (x * x + 1.0) * v[1] * self.r + v[0] * v[1] * self.r;
        [-y * self.kappa - v[0] * self.r, second]
    }

    /// d/dt[m(1 + ½x²) v_x] = ½m x v_x² − (x² − 1) x + f_x.
    fn acceleration(&self, [x, y]: [f64; 2], [vx, vy]: [f64; 2]) -> [f64; 2] {
        let fx = -0.5 * self.m * x * vx * vx - (x * x - 1.0) * x - self.kappa * y - self.r * vx;
        let fy = -y + self.kappa * x - self.r * (1.0 + x * x) * vy + self.r * vx * vy;
        [fx / (self.m * (1.0 + 0.5 * x * x)), fy / self.m]
    }
}
