//! A chain of n masses hung from a wall, each on a hardening spring and a dashpot to the one before it: q₀ = 0,
//! dᵢ = qᵢ − qᵢ₋₁.
//!
//! ```text
//! L = Σ ½mᵢvᵢ² − Σ (½k dᵢ² + ¼κdᵢ⁴),   R = ½c Σ ḋᵢ²
//! ```

macro_rules! spring_chain {
    ($name:ident: $n:literal, $engine:ident, [$($rule:ident),*]) => {
        /// Masses mᵢ; springs of potential k d²/2 + κ d⁴/4 and dashpots of force c ḋ between neighbours.
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// Masses.
            pub m: [f64; $n],
            /// Stiffness k.
            pub stiffness: f64,
            /// Hardening κ.
            pub hardening: f64,
            /// Friction coefficient c.
            pub friction: f64,
        }

        #[dalembert::rayleigh_system(rule = [$($rule),*], derivatives = $engine)]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let (mut kinetic, mut potential) = (0.0, 0.0);
                let mut before = 0.0;
                for i in 0..$n {
                    kinetic += 0.5 * self.m[i] * v[i] * v[i];
                    let d = q[i] - before;
                    potential += 0.5 * self.stiffness * d * d + 0.25 * self.hardening * d.powi(4);
                    before = q[i];
                }
                kinetic - potential
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                let mut sum = v[0] * v[0];
                for pair in v.windows(2) {
                    sum += (pair[1] - pair[0]).powi(2);
                }
                0.5 * self.friction * sum
            }
        }
    };
}
