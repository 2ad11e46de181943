/// Double pendulum of point masses, absolute angles from the vertical, with friction in both joints.
macro_rules! double_pendulum {
    ($engine:ident) => {
        /// Two point masses on massless rods.
        pub struct DoublePendulum {
            /// Masses.
            pub m: [f64; 2],
            /// Lengths.
            pub l: [f64; 2],
            /// Gravity.
            pub g: f64,
            /// Friction coefficients of the joints.
            pub c: [f64; 2],
        }

        #[rayleigh_system(derivatives = $engine)]
        impl DoublePendulum {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let [m1, m2] = self.m;
                let [l1, l2] = self.l;
                let kinetic = 0.5 * (m1 + m2) * l1 * l1 * v[0] * v[0]
                    + 0.5 * m2 * l2 * l2 * v[1] * v[1]
                    + m2 * l1 * l2 * (q[0] - q[1]).cos() * v[0] * v[1];
                let potential = -(m1 + m2) * self.g * l1 * q[0].cos() - m2 * self.g * l2 * q[1].cos();
                kinetic - potential
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let relative = v[1] - v[0];
                0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * relative * relative
            }
        }
    };
}
