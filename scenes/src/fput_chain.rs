//! The β-chain of Fermi, Pasta, Ulam and Tsingou: n unit masses between walls, q₀ = qₙ₊₁ = 0, dᵢ = qᵢ₊₁ − qᵢ.
//!
//! ```text
//! L = Σ ½vᵢ² − Σ (½dᵢ² + ¼βdᵢ⁴),   R = ½k Σ vᵢ²
//! ```

macro_rules! fput_chain {
    ($name:ident: $n:literal, $engine:ident, [$($rule:ident),*] $(, lanes = [$($lanes:ident),*])?) => {
        /// Springs of potential d²/2 + β d⁴/4.
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// Strength of the quartic term.
            pub beta: f64,
            /// Drag coefficient.
            pub drag: f64,
        }

        impl $name {
            /// The springs and the drag at which speed is measured.
            pub const MEASURED: Self = Self { beta: 0.7, drag: 1e-3 };
        }

        #[dalembert::rayleigh_system(rule = [$($rule),*], derivatives = $engine $(, lanes = [$($lanes),*])?)]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let mut energy = 0.0;
                for v in &v {
                    energy += 0.5 * v * v;
                }
                energy -= Self::spring(self.beta, q[0]) + Self::spring(self.beta, q[$n - 1]);
                for i in 1..$n {
                    energy -= Self::spring(self.beta, q[i] - q[i - 1]);
                }
                energy
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                0.5 * self.drag * v.iter().map(|v| v * v).sum::<f64>()
            }

            fn spring(beta: f64, d: f64) -> f64 {
                let square = d * d;
                0.5 * square + 0.25 * beta * square * square
            }
        }
    };
}
