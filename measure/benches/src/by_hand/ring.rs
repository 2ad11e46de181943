//! The ring: V = s(s − 1)², dV/ds = (s − 1)(3s − 1), d²V/ds² = 6s − 4, G = −2 dV/ds q − k v.

use dalembert::nalgebra::{SMatrix, matrix};
use dalembert::run::VelocityHistory;
use dalembert::step::{Momenta, Segment, StepKernel};
use dalembert_scenes as scenes;

use super::HandDerived;

/// The ring, by hand.
pub struct Ring {
    generated: scenes::Ring,
}

impl From<scenes::Ring> for Ring {
    fn from(generated: scenes::Ring) -> Self {
        Self { generated }
    }
}

impl HandDerived<2> for Ring {
    type Generated = scenes::Ring;
    type Matrix = SMatrix<f64, 2, 2>;
    type Memory = VelocityHistory<f64, 2>;

    fn generated(&self) -> &scenes::Ring {
        &self.generated
    }

    #[inline]
    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        let Segment { q0, v, h } = segment;
        let half = 0.5 * h;
        let q = q0 + v * half;
        let s = q[0] * q[0] + q[1] * q[1];
        let slope = 2.0 * (s - 1.0) * (3.0 * s - 1.0);
        let curvature = 24.0 * s - 16.0;
        let drag = half * self.generated.k;
        let along = half * slope;
        let square = half * half;
        let diagonal = 1.0 + drag + square * slope;
        let scaled = square * curvature;
        let (x, y) = (scaled * q[0], scaled * q[1]);
        let mixed = x * q[1];
        StepKernel {
            p0: v + v * drag + q * along,
            matrix: matrix![diagonal + x * q[0], mixed; mixed, diagonal + y * q[1]],
        }
    }

    #[inline]
    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        let Segment { q0, v, h } = segment;
        let half = 0.5 * h;
        let q = q0 + v * half;
        let s = q[0] * q[0] + q[1] * q[1];
        let slope = 2.0 * (s - 1.0) * (3.0 * s - 1.0);
        let impulse = v * (half * self.generated.k) + q * (half * slope);
        Momenta { p0: v + impulse, p1: v - impulse }
    }
}
