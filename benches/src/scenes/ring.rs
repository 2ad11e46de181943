/// Ring potential V = s(s − 1)², s = |q|², with isotropic drag (Marsden & West 2001, example 3.2.3).
macro_rules! ring {
    ($engine:ident) => {
        /// A particle in V = s(s − 1)², s = |q|², with drag.
        pub struct Ring {
            /// Drag coefficient.
            pub k: f64,
        }

        #[rayleigh_system(derivatives = $engine)]
        impl Ring {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let s = q[0] * q[0] + q[1] * q[1];
                0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
            }
        }
    };
}
