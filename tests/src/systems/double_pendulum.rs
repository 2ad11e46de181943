//! The plane double pendulum with friction in both joints: a mass matrix that depends on q.

use dalembert::rayleigh_system;

use crate::by_hand::{ByHand, Number};

/// Two pendulums, one hung from the other; angles from the vertical.
///
/// ```text
/// L = ½(m1 + m2) l1² v1² + ½m2 l2² v2² + m2 l1 l2 v1 v2 cos(q1 − q2) + (m1 + m2) g l1 cos q1 + m2 g l2 cos q2
/// R = ½r1 v1² + ½r2 (v2 − v1)²
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DoublePendulum {
    /// Masses.
    pub m: [f64; 2],
    /// Lengths.
    pub l: [f64; 2],
    /// Acceleration of gravity.
    pub g: f64,
    /// Coefficients of friction in the joints.
    pub r: [f64; 2],
}

impl DoublePendulum {
    /// Parameters without accidental coincidences.
    pub const EXAMPLE: Self = Self { m: [1.3, 0.6], l: [0.9, 1.1], g: 2.3, r: [0.25, 0.15] };
    /// The example without friction.
    pub const FREE: Self = Self { r: [0.0, 0.0], ..Self::EXAMPLE };
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [m1, m2] = self.m;
        let [l1, l2] = self.l;
        let kinetic = 0.5 * (m1 + m2) * (l1 * v[0]).powi(2)
            + 0.5 * m2 * (l2 * v[1]).powi(2)
            + m2 * l1 * l2 * v[0] * v[1] * (q[0] - q[1]).cos();
        kinetic + self.g * ((m1 + m2) * l1 * q[0].cos() + m2 * l2 * q[1].cos())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r[0] * v[0].powi(2) + 0.5 * self.r[1] * (v[1] - v[0]).powi(2)
    }
}

impl ByHand<2> for DoublePendulum {
    fn lagrangian_by_hand<D: Number>(&self, q: [D; 2], v: [D; 2]) -> D {
        // Each mass by its velocity in the plane.
        let ([m1, m2], [l1, l2]) = (self.m, self.l);
        let (x1, y1) = (q[0].cos() * v[0] * l1, q[0].sin() * v[0] * l1);
        let (x2, y2) = (x1 + q[1].cos() * v[1] * l2, y1 + q[1].sin() * v[1] * l2);
        let height1 = q[0].cos() * -l1;
        let height2 = height1 - q[1].cos() * l2;
        (x1 * x1 + y1 * y1) * (m1 / 2.0) + (x2 * x2 + y2 * y2) * (m2 / 2.0)
            - height1 * (m1 * self.g)
            - height2 * (m2 * self.g)
    }

    fn rayleigh_by_hand<D: Number>(&self, _: [D; 2], v: [D; 2]) -> D {
        let relative = v[1] - v[0];
        v[0] * v[0] * (self.r[0] / 2.0) + relative * relative * (self.r[1] / 2.0)
    }

    fn acceleration(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let ([m1, m2], [l1, l2], [r1, r2]) = (self.m, self.l, self.r);
        let (s, c) = (q[0] - q[1]).sin_cos();
        let (a, b, d) = ((m1 + m2) * l1 * l1, m2 * l1 * l2 * c, m2 * l2 * l2);
        let f1 = -m2 * l1 * l2 * s * v[1] * v[1] - (m1 + m2) * self.g * l1 * q[0].sin() - r1 * v[0]
            + r2 * (v[1] - v[0]);
        let f2 = m2 * l1 * l2 * s * v[0] * v[0] - m2 * self.g * l2 * q[1].sin() - r2 * (v[1] - v[0]);
        let det = a * d - b * b;
        [(d * f1 - b * f2) / det, (a * f2 - b * f1) / det]
    }
}
