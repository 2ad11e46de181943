//! A planar chain of n point masses on equal massless links, absolute angles from the vertical, with friction in
//! every joint: xᵢ, yᵢ the masses' places, v₀ = 0.
//!
//! ```text
//! L = Σ ½mᵢ(ẋᵢ² + ẏᵢ²) − mᵢ g yᵢ,   R = ½c Σ (vᵢ − vᵢ₋₁)²
//! ```

macro_rules! pendulum_chain {
    ($name:ident: $n:literal, $engine:ident, [$($rule:ident),*]) => {
        /// Every mass moves with all links above it: the mass matrix is full and depends on q.
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// Masses.
            pub m: [f64; $n],
            /// Length of a link.
            pub l: f64,
            /// Gravity.
            pub g: f64,
            /// Friction coefficient of the joints.
            pub c: f64,
        }

        #[dalembert::rayleigh_system(rule = [$($rule),*], derivatives = $engine)]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let (mut y, mut vx, mut vy) = (0.0, 0.0, 0.0);
                let mut energy = 0.0;
                for i in 0..$n {
                    let (sine, cosine) = q[i].sin_cos();
                    y -= self.l * cosine;
                    vx += self.l * v[i] * cosine;
                    vy += self.l * v[i] * sine;
                    energy += 0.5 * self.m[i] * (vx * vx + vy * vy) - self.m[i] * self.g * y;
                }
                energy
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                let mut sum = v[0] * v[0];
                for pair in v.windows(2) {
                    sum += (pair[1] - pair[0]).powi(2);
                }
                0.5 * self.c * sum
            }
        }
    };
}
