//! A spatial arm of three joints: yaw of the base, pitch of the shoulder, pitch of the elbow relative to the
//! upper arm.
//!
//! ```text
//! L = ½J v₁² + Σ (m/6)(|a|² + a·b + |b|²) + ½M|tip|² − g Σ m z,   R = ½Σ cᵢvᵢ²
//! ```
//!
//! a and b are the velocities of the ends of a rod, z the height of its middle; M is the payload.

macro_rules! arm {
    ($name:ident: $engine:ident, [$($rule:ident),*]) => {
        /// Two uniform rods and a payload at the tip, on a turning base.
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// Moment of inertia of the base.
            pub base: f64,
            /// Masses of the rods.
            pub m: [f64; 2],
            /// Lengths of the rods.
            pub l: [f64; 2],
            /// Mass of the payload.
            pub payload: f64,
            /// Gravity.
            pub g: f64,
            /// Friction coefficients of the joints.
            pub c: [f64; 3],
        }

        #[dalembert::rayleigh_system(rule = [$($rule),*], derivatives = $engine)]
        impl $name {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let [shoulder, elbow] = self.l;
                // In the turning vertical plane of the arm: radius, height and out of it.
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
                let potential =
                    self.g * (self.m[0] * 0.5 * z1 + self.m[1] * 0.5 * (z1 + z2) + self.payload * z2);
                kinetic - potential
            }

            fn rayleigh(&self, v: [f64; 3]) -> f64 {
                0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1] + self.c[2] * v[2] * v[2])
            }

            /// Kinetic energy of a uniform rod whose ends have the velocities a and b.
            fn rod(m: f64, a: [f64; 3], b: [f64; 3]) -> f64 {
                m / 6.0 * (Self::dot(a, a) + Self::dot(a, b) + Self::dot(b, b))
            }

            fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
                a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
            }
        }
    };
}
