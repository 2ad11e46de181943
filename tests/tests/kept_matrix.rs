//! A Newton matrix is kept where it serves, and not where it is soon of no use: evaluations counted over a run.

use std::cell::Cell;

use dalembert::{
    Derivatives, Discrete, KeptMatrix, Lagrangian, Midpoint, Momenta, State, StepKernel, Trajectory,
    VelocityHistory, rayleigh_system,
};
use nalgebra::{SMatrix, SVector};

/// Three coupled turns whose inertias depend on the angles.
struct Rotor;

#[rayleigh_system]
impl Rotor {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let inertia = 2.0 + q[1].cos() + 0.5 * q[2].sin();
        0.5 * inertia * v[0] * v[0]
            + 0.5 * v[1] * v[1]
            + 0.5 * (1.5 + q[1].sin()) * v[2] * v[2]
            + 0.3 * (q[1] - q[2]).cos() * v[1] * v[2]
            + q[0].cos()
    }
}

type Vector = SVector<f64, 3>;

/// The rotor with a memory of its own, and how often its step's equation and its momenta are evaluated.
macro_rules! counted {
    ($name:ident, $memory:ty) => {
        #[derive(Default)]
        struct $name {
            equations: Cell<u32>,
            momenta: Cell<u32>,
        }

        impl Lagrangian<3> for $name {
            type Scalar = f64;

            fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
                Lagrangian::lagrangian(&Rotor, q, v)
            }

            fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 3> {
                Rotor.lagrangian_derivatives(q, v)
            }
        }

        impl Discrete<Midpoint, 3> for $name {
            type Matrix = SMatrix<f64, 3, 3>;
            type Memory = $memory;

            fn discrete_lagrangian(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
                Rotor.discrete_lagrangian(q0, q1, h)
            }

            fn discrete_lagrangian_derivatives(
                &self,
                q0: &Vector,
                q1: &Vector,
                h: f64,
            ) -> Derivatives<f64, 3> {
                Rotor.discrete_lagrangian_derivatives(q0, q1, h)
            }

            fn step_kernel(&self, q0: &Vector, v: &Vector, h: f64) -> StepKernel<f64, 3> {
                self.equations.set(self.equations.get() + 1);
                Rotor.step_kernel(q0, v, h)
            }

            fn momenta(&self, q0: &Vector, v: &Vector, h: f64) -> Momenta<f64, 3> {
                self.momenta.set(self.momenta.get() + 1);
                Rotor.momenta(q0, v, h)
            }

            fn segment_energy(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
                Rotor.segment_energy(q0, q1, h)
            }
        }

        impl $name {
            /// Evaluations of both kinds over 2000 steps.
            fn run(v: [f64; 3], h: f64) -> [u32; 2] {
                let system = Self::default();
                let start = State::from_velocity(&system, [0.1, 0.2, -0.3], v).unwrap();
                for step in Trajectory::new(&system, Midpoint, h, start).take(2000) {
                    step.unwrap();
                }
                [system.equations.get(), system.momenta.get()]
            }
        }
    };
}

counted!(Keeping, KeptMatrix<f64, SMatrix<f64, 3, 3>, 3>);
counted!(Renewing, VelocityHistory<f64, 3>);

#[test]
fn a_matrix_that_changes_fast_is_not_kept() {
    let (v, h) = ([3.0, 5.0, -4.0], 0.05);
    let (keeping, renewing) = (Keeping::run(v, h), Renewing::run(v, h));
    let total = |[equations, momenta]: [u32; 2]| f64::from(equations + momenta);
    assert!(total(keeping) <= 1.05 * total(renewing), "{keeping:?} against {renewing:?}");
}

#[test]
fn a_matrix_that_hardly_changes_is_kept() {
    let (v, h) = ([3e-3, 5e-3, -4e-3], 0.05);
    let (keeping, renewing) = (Keeping::run(v, h), Renewing::run(v, h));
    assert!(keeping[0] < renewing[0] / 20, "{keeping:?} against {renewing:?}");
}
