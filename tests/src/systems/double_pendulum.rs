//! The plane double pendulum of all packages, by hand.

use dalembert_scenes::DoublePendulum;

use crate::by_hand::{ByHand, Number};

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
        v[0] * v[0] * (self.c[0] / 2.0) + relative * relative * (self.c[1] / 2.0)
    }

    fn acceleration(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let ([m1, m2], [l1, l2], [r1, r2]) = (self.m, self.l, self.c);
        let (s, c) = (q[0] - q[1]).sin_cos();
        let (a, b, d) = ((m1 + m2) * l1 * l1, m2 * l1 * l2 * c, m2 * l2 * l2);
        let f1 = -m2 * l1 * l2 * s * v[1] * v[1] - (m1 + m2) * self.g * l1 * q[0].sin() - r1 * v[0]
            + r2 * (v[1] - v[0]);
        let f2 = m2 * l1 * l2 * s * v[0] * v[0] - m2 * self.g * l2 * q[1].sin() - r2 * (v[1] - v[0]);
        let det = a * d - b * b;
        [(d * f1 - b * f2) / det, (a * f2 - b * f1) / det]
    }
}
