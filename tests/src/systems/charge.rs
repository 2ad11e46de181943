//! A charge in a magnetic field: gyroscopic terms, friction that depends on q, and a force that no R gives.

use dalembert::rayleigh_system;

use crate::by_hand::{ByHand, Number};

/// A particle with three different inertias in the vector potential A = b(1 + ½z²)(−y, x, 0).
///
/// ```text
/// L = ½Σ mᵢvᵢ² + b(1 + ½z²)(x v_y − y v_x) − ¼|q|⁴
/// R = ½r(1 + x² + y²)|v|²,   f = (−κy, κx, −c z v_z)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Charge {
    /// Inertias.
    pub m: [f64; 3],
    /// Strength of the magnetic field.
    pub b: f64,
    /// Coefficient of friction.
    pub r: f64,
    /// Strength of the circulating force.
    pub kappa: f64,
    /// Strength of the force along z.
    pub c: f64,
}

impl Charge {
    /// Parameters without accidental coincidences.
    pub const EXAMPLE: Self = Self { m: [1.4, 0.8, 2.2], b: 0.7, r: 0.15, kappa: 0.35, c: 0.25 };
    /// The example without friction and force.
    pub const FREE: Self = Self { r: 0.0, kappa: 0.0, c: 0.0, ..Self::EXAMPLE };
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Charge {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let [x, y, z] = q;
        let mut kinetic = 0.0;
        for (i, v) in v.iter().enumerate() {
            kinetic += 0.5 * self.m[i] * v * v;
        }
        let square: f64 = q.iter().map(|x| x * x).sum();
        kinetic + self.b * (1.0 + 0.5 * z * z) * (x * v[1] - y * v[0]) - 0.25 * square.powi(2)
    }

    fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let square: f64 = v.iter().map(|x| x * x).sum();
        0.5 * self.r * (1.0 + q[0].powi(2) + q[1].powi(2)) * square
    }

    fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
        [-self.kappa * q[1], self.kappa * q[0], -self.c * q[2] * v[2]]
    }
}

impl ByHand<3> for Charge {
    fn lagrangian_by_hand<D: Number>(&self, [x, y, z]: [D; 3], v: [D; 3]) -> D {
        let kinetic = v[0] * v[0] * self.m[0] + v[1] * v[1] * self.m[1] + v[2] * v[2] * self.m[2];
        let square = x * x + y * y + z * z;
        kinetic / 2.0 + (z * z / 2.0 + 1.0) * (x * v[1] - y * v[0]) * self.b - square * square / 4.0
    }

    fn rayleigh_by_hand<D: Number>(&self, [x, y, _]: [D; 3], v: [D; 3]) -> D {
        (x * x + y * y + 1.0) * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * (self.r / 2.0)
    }

    fn force_by_hand<D: Number>(&self, [x, y, z]: [D; 3], v: [D; 3]) -> [D; 3] {
        [y * -self.kappa, x * self.kappa, z * v[2] * -self.c]
    }

    fn acceleration(&self, [x, y, z]: [f64; 3], [vx, vy, vz]: [f64; 3]) -> [f64; 3] {
        let square = x * x + y * y + z * z;
        let field = 2.0 * self.b * (1.0 + 0.5 * z * z);
        let friction = self.r * (1.0 + x * x + y * y);
        let fx = field * vy + self.b * z * vz * y - square * x - friction * vx - self.kappa * y;
        let fy = -field * vx - self.b * z * vz * x - square * y - friction * vy + self.kappa * x;
        let fz = self.b * z * (x * vy - y * vx) - square * z - friction * vz - self.c * z * vz;
        [fx / self.m[0], fy / self.m[1], fz / self.m[2]]
    }
}
