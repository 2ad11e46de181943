//! The ring (J. E. Marsden and M. West 2001, example 3.2.3): q in the plane, s = |q|².
//!
//! ```text
//! L = ½|v|² − s(s − 1)²,   R = ½k|v|²
//! ```

macro_rules! ring {
    ($name:ident: $engine:ident, [$($rule:ident),*] $(, lanes = [$($lanes:ident),*])?) => {
        /// A particle in V = s(s − 1)², s = |q|², with drag.
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// Drag coefficient.
            pub k: f64,
        }

        impl $name {
            /// With the drag at which speed is measured.
            pub const MEASURED: Self = Self { k: 1e-3 };
        }

        #[dalembert::rayleigh_system(rule = [$($rule),*], derivatives = $engine $(, lanes = [$($lanes),*])?)]
        impl $name {
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
