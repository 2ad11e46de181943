//! A four-bar linkage in coordinates of its bars: place of the centre and angle of crank, coupler and rocker.
//!
//! ```text
//! L = Σ ½mᵢ(ẋᵢ² + ẏᵢ² + lᵢ²θ̇ᵢ²/12) − g mᵢyᵢ,   R = ½c(θ̇₁² + (θ̇₂ − θ̇₁)² + (θ̇₃ − θ̇₂)² + θ̇₃²)
//! ```
//!
//! L is a sum over bars; eight constraints pin their ends to each other and to the ground. SI units.

use dalembert::rayleigh_system;

/// Lengths of crank, coupler and rocker, m.
pub const LENGTHS: [f64; 3] = [0.3, 0.9, 0.7];
/// Their masses, kg.
pub const MASSES: [f64; 3] = [0.5, 0.9, 0.6];
/// The distance of the pivots on the ground, m.
pub const GROUND: f64 = 1.0;
/// Acceleration of gravity, m/s².
pub const G: f64 = 9.81;

/// How the ninth constraint is made of the others: Σ nₖgₖ = 0.
pub const COMBINATION: [f64; 9] = [-1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0];

/// The linkage with this number of constraints: its joints', and `once_more` of q.
macro_rules! four_bar {
    ($(#[$doc:meta])* $name:ident: $count:literal $(, |$q:ident| $once_more:expr)?) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// Friction of each joint, N m s.
            pub friction: f64,
        }

        #[rayleigh_system]
        impl $name {
            fn lagrangian(&self, q: [f64; 9], v: [f64; 9]) -> f64 {
                let mut sum = 0.0;
                for i in 0..3 {
                    let [x, y, turn] = [v[3 * i], v[3 * i + 1], LENGTHS[i] * v[3 * i + 2]];
                    sum += 0.5 * MASSES[i] * (x * x + y * y + turn * turn / 12.0);
                    sum -= MASSES[i] * G * q[3 * i + 1];
                }
                sum
            }

            fn rayleigh(&self, v: [f64; 9]) -> f64 {
                let [crank, coupler, rocker] = [v[2], v[5], v[8]];
                let mut sum = 0.0;
                for turn in [crank, coupler - crank, rocker - coupler, rocker] {
                    sum += 0.5 * self.friction * turn * turn;
                }
                sum
            }

            fn force(&self, _q: [f64; 9], _v: [f64; 9], torque: [f64; 1]) -> [f64; 9] {
                [0.0, 0.0, torque[0], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
            }

            fn constraints(&self, q: [f64; 9]) -> [f64; $count] {
                let [near, far] = self.ends(q);
                [
                    near[0][0],
                    near[0][1],
                    far[0][0] - near[1][0],
                    far[0][1] - near[1][1],
                    far[1][0] - far[2][0],
                    far[1][1] - far[2][1],
                    near[2][0] - GROUND,
                    near[2][1],
                    $({
                        let $q = q;
                        $once_more
                    },)?
                ]
            }

            /// The ends of the bars, the near ones first, by which crank and rocker are pinned to the ground.
            pub fn ends(&self, q: [f64; 9]) -> [[[f64; 2]; 3]; 2] {
                let mut ends = [[[0.0; 2]; 3]; 2];
                for i in 0..3 {
                    let [x, y, half] = [q[3 * i], q[3 * i + 1], 0.5 * LENGTHS[i]];
                    let [along, up] = [half * q[3 * i + 2].cos(), half * q[3 * i + 2].sin()];
                    ends[0][i] = [x - along, y - up];
                    ends[1][i] = [x + along, y + up];
                }
                ends
            }
        }
    };
}

four_bar! {
    /// The linkage with a constraint for each component of each joint; a motor turns the crank.
    FourBar: 8
}

four_bar! {
    /// The linkage with the sum of four of these besides: the loop along x.
    Redundant: 9,
    |q| LENGTHS[0] * q[2].cos() + LENGTHS[1] * q[5].cos() - LENGTHS[2] * q[8].cos() - GROUND
}
