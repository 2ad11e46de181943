/// The Fermi–Pasta–Ulam–Tsingou β-chain of unit masses between walls, with drag.
macro_rules! fput_chain {
    ($engine:ident, $n:tt) => {
        /// Springs of potential d²/2 + β d⁴/4.
        pub struct FputChain {
            /// Strength of the quartic term.
            pub beta: f64,
            /// Drag coefficient.
            pub drag: f64,
        }

        #[rayleigh_system(derivatives = $engine)]
        impl FputChain {
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
