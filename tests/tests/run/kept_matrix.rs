//! A Newton matrix is kept where it serves, and not where it is soon of no use: evaluations counted over a
//! run.

use std::cell::Cell;

use dalembert::rules::Fused;
use dalembert::run::{KeptMatrix, VelocityHistory};
use dalembert::step::{Banded, Momenta, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Discretise, Lagrangian, Midpoint, State, rayleigh_system};
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

/// Springs that harden between 32 masses.
struct Chain;

#[rayleigh_system]
impl Chain {
    fn lagrangian(&self, q: [f64; 32], v: [f64; 32]) -> f64 {
        let (mut kinetic, mut potential, mut before) = (0.0, 0.0, 0.0);
        for i in 0..32 {
            let d = q[i] - before;
            kinetic += 0.5 * v[i] * v[i];
            potential += 20.0 * d * d + 2.0 * d.powi(4);
            before = q[i];
        }
        kinetic - potential
    }
}

/// A system with a memory of its own, and how often its step's equation and its momenta are evaluated.
macro_rules! counted {
    ($name:ident, $system:ident, $n:literal, $matrix:ty, $memory:ty) => {
        #[derive(Default)]
        struct $name {
            equations: Cell<u32>,
            momenta: Cell<u32>,
        }

        impl Lagrangian<$n> for $name {
            type Scalar = f64;

            fn lagrangian(&self, q: &SVector<f64, $n>, v: &SVector<f64, $n>) -> f64 {
                Lagrangian::lagrangian(&$system, q, v)
            }

            fn lagrangian_derivatives(
                &self,
                q: &SVector<f64, $n>,
                v: &SVector<f64, $n>,
            ) -> Derivatives<f64, $n> {
                $system.lagrangian_derivatives(q, v)
            }
        }

        impl ActingForce<$n> for $name {}

        impl Fused<Midpoint, $n> for $name {
            type Matrix = $matrix;
            type Memory = $memory;
            type Border = dalembert::step::Free;

            fn step_kernel(&self, segment: &Segment<f64, $n>) -> StepKernel<f64, $n, $matrix> {
                self.equations.set(self.equations.get() + 1);
                Fused::<Midpoint, $n>::step_kernel(&$system, segment)
            }

            fn momenta(&self, segment: &Segment<f64, $n>) -> Momenta<f64, $n> {
                self.momenta.set(self.momenta.get() + 1);
                Fused::<Midpoint, $n>::momenta(&$system, segment)
            }
        }

        impl $name {
            /// Evaluations of both kinds over 2000 steps.
            fn run(q: [f64; $n], v: [f64; $n], h: f64) -> [u32; 2] {
                let system = Self::default();
                let start = State::from_velocity(&system, q, v).unwrap();
                for step in system.by(Midpoint, h).run(start).take(2000) {
                    step.unwrap();
                }
                [system.equations.get(), system.momenta.get()]
            }
        }
    };
}

counted!(Keeping, Rotor, 3, SMatrix<f64, 3, 3>, KeptMatrix<f64, SMatrix<f64, 3, 3>, 3>);
counted!(Renewing, Rotor, 3, SMatrix<f64, 3, 3>, VelocityHistory<f64, 3>);
counted!(KeepingChain, Chain, 32, Banded<f64, 32, 3>, KeptMatrix<f64, Banded<f64, 32, 3>, 32>);

const TURNED: [f64; 3] = [0.1, 0.2, -0.3];

#[test]
fn a_matrix_that_changes_fast_is_not_kept() {
    let (v, h) = ([3.0, 5.0, -4.0], 0.05);
    let (keeping, renewing) = (Keeping::run(TURNED, v, h), Renewing::run(TURNED, v, h));
    let total = |[equations, momenta]: [u32; 2]| f64::from(equations + momenta);
    assert!(total(keeping) <= 1.05 * total(renewing), "{keeping:?} against {renewing:?}");
}

#[test]
fn a_matrix_that_hardly_changes_is_kept() {
    let (v, h) = ([3e-3, 5e-3, -4e-3], 0.05);
    let (keeping, renewing) = (Keeping::run(TURNED, v, h), Renewing::run(TURNED, v, h));
    // One step in five looks at the matrix once more: what is left is not small beside momenta of 10⁻³.
    assert!(keeping[0] < renewing[0] / 8, "{keeping:?} against {renewing:?}");
}

/// On a long wave the forces of neighbouring springs cancel, and their rounding holds up the residuals of
/// masses that turn. To measure that rounding, coordinate by coordinate, takes 129 evaluations; a step in
/// twenty that did so would show.
#[test]
fn cancelling_forces_do_not_hold_up_a_run() {
    let wave = core::array::from_fn(|i| (core::f64::consts::PI * (i + 1) as f64 / 65.0).sin());
    let [equations, momenta] = KeepingChain::run(wave, [0.0; 32], 0.05);
    assert!(equations < 2000 && momenta < 2000 * 5, "{equations} equations, {momenta} momenta in 2000 steps");
}
