//! The checkers on holonomic constraints: the pair (L_d, R_d) restricted to N×N, N = g⁻¹(0).

use dalembert::samples::{self, Pair};
use dalembert::step::Flow;
use dalembert::{Discretise, Lagrangian, State, rayleigh_system};

const EVEN: Spherical =
    Spherical { gravity: 9.81, springs: [0.0; 2], c: [0.4; 3], turning: 0.0, normal: 0.0 };
const FREE: Spherical = Spherical { c: [0.0; 3], ..EVEN };
const UNEVEN: Spherical = Spherical { gravity: 1.0, springs: [2.0, -0.7], c: [0.6, 0.1, 0.2], ..EVEN };

/// A unit mass with springs and friction that are not even, forces beside R, and constraints.
macro_rules! spherical {
    ($name:ident $(, $q:ident, $count:literal, $constraints:expr)?) => {
        #[derive(Clone, Copy)]
        struct $name {
            gravity: f64,
            springs: [f64; 2],
            c: [f64; 3],
            /// f = turning e_z × v, whose matrix is skew.
            turning: f64,
            /// f = normal v_x q, by the trapezoidal rule normal to the sphere at both ends.
            normal: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal])]
        impl $name {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let springs = self.springs[0] * q[0] * q[0] + 2.0 * self.springs[1] * q[0] * q[1];
                0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - springs) - self.gravity * q[2]
            }

            fn rayleigh(&self, v: [f64; 3]) -> f64 {
                0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1] + self.c[2] * v[2] * v[2])
            }

            fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
                let along = self.normal * v[0];
                [along * q[0] - self.turning * v[1], along * q[1] + self.turning * v[0], along * q[2]]
            }

            $(fn constraints(&self, $q: [f64; 3]) -> [f64; $count] {
                $constraints
            })?
        }
    };
}
mod momenta;
mod steps;
mod structure;

spherical!(Spherical, q, 1, [0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0)]);

impl Spherical {
    fn state(q: [f64; 3], v: [f64; 3]) -> State<f64, 3> {
        State::nearest(&EVEN, q, v).unwrap()
    }

    fn states() -> Vec<State<f64, 3>> {
        vec![Self::state([0.7, 0.2, -0.6], [0.3, 1.2, 0.1]), Self::state([-0.3, 0.5, 0.6], [0.9, -0.4, 0.5])]
    }
}

/// Segments on the constraints of a system in three coordinates.
fn on<L, R>(system: &L, rule: R) -> Vec<Pair<f64, 3>>
where
    L: Lagrangian<3, Scalar = f64> + Flow<R, 3>,
{
    let beside = samples::segments([-1.0; 3], [1.0; 3], [0.1; 3], 40);
    system.by(rule, 0.05).on_constraints(&beside).unwrap()
}
