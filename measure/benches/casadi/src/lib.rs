//! The double pendulum and the arm of `dalembert-scenes`, with a torque at each joint, by two rules.

use dalembert::{Gauss, Midpoint, rayleigh_system};

dalembert_c::parameters! {
    /// A double pendulum: masses, lengths, gravity, friction of the joints.
    pub struct DoublePendulum {
        /// Masses.
        pub m: [f64; 2],
        /// Lengths.
        pub l: [f64; 2],
        /// Gravity.
        pub g: f64,
        /// Friction.
        pub c: [f64; 2],
    }
}

#[rayleigh_system(rule = [midpoint, gauss])]
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
        0.5 * self.c[0] * v[0].powi(2) + 0.5 * self.c[1] * (v[1] - v[0]).powi(2)
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        u
    }
}

dalembert_c::c_api! { pendulum_midpoint: DoublePendulum, rule: Midpoint }
dalembert_c::c_api! { pendulum_gauss: DoublePendulum, rule: Gauss<3> }

dalembert_c::parameters! {
    /// An arm: yaw, shoulder, elbow.
    pub struct Arm {
        /// Moment of inertia of the base.
        pub base: f64,
        /// Masses of the rods.
        pub m: [f64; 2],
        /// Lengths of the rods.
        pub l: [f64; 2],
        /// Mass at the tip.
        pub payload: f64,
        /// Gravity.
        pub g: f64,
        /// Friction.
        pub c: [f64; 3],
    }
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Arm {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let [shoulder, elbow] = self.l;
        let (sine, cosine) = q[1].sin_cos();
        let (r1, z1) = (shoulder * cosine, shoulder * sine);
        let at_elbow = [-z1 * v[1], r1 * v[1], r1 * v[0]];
        let (sine, cosine) = (q[1] + q[2]).sin_cos();
        let (r2, z2) = (r1 + elbow * cosine, z1 + elbow * sine);
        let turning = v[1] + v[2];
        let at_tip =
            [at_elbow[0] - elbow * sine * turning, at_elbow[1] + elbow * cosine * turning, r2 * v[0]];
        let kinetic = 0.5 * self.base * v[0] * v[0]
            + Self::rod(self.m[0], [0.0; 3], at_elbow)
            + Self::rod(self.m[1], at_elbow, at_tip)
            + 0.5 * self.payload * Self::dot(at_tip, at_tip);
        let potential = self.g * (self.m[0] * 0.5 * z1 + self.m[1] * 0.5 * (z1 + z2) + self.payload * z2);
        kinetic - potential
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1] + self.c[2] * v[2] * v[2])
    }

    fn force(&self, _q: [f64; 3], _v: [f64; 3], u: [f64; 3]) -> [f64; 3] {
        u
    }

    fn rod(m: f64, a: [f64; 3], b: [f64; 3]) -> f64 {
        m / 6.0 * (Self::dot(a, a) + Self::dot(a, b) + Self::dot(b, b))
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }
}

dalembert_c::c_api! { arm_midpoint: Arm, rule: Midpoint }
dalembert_c::c_api! { arm_gauss: Arm, rule: Gauss<3> }
