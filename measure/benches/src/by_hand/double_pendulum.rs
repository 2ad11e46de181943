//! The double pendulum, with C = cos(q0 − q1), S = sin(q0 − q1).

use dalembert::nalgebra::{SMatrix, matrix, vector};
use dalembert::run::VelocityHistory;
use dalembert::step::{Momenta, Segment, StepKernel};
use dalembert_scenes as scenes;

use super::HandDerived;

/// The double pendulum, by hand.
pub struct DoublePendulum {
    generated: scenes::DoublePendulum,
    /// (m1 + m2) l1², m2 l2² and m2 l1 l2.
    inertia: [f64; 3],
    /// (m1 + m2) g l1 and m2 g l2.
    weight: [f64; 2],
}

impl From<scenes::DoublePendulum> for DoublePendulum {
    fn from(generated: scenes::DoublePendulum) -> Self {
        let ([m1, m2], [l1, l2], g) = (generated.m, generated.l, generated.g);
        Self {
            inertia: [(m1 + m2) * l1 * l1, m2 * l2 * l2, m2 * l1 * l2],
            weight: [(m1 + m2) * g * l1, m2 * g * l2],
            generated,
        }
    }
}

impl HandDerived<2> for DoublePendulum {
    type Generated = scenes::DoublePendulum;
    type Matrix = SMatrix<f64, 2, 2>;
    type Memory = VelocityHistory<f64, 2>;

    fn generated(&self) -> &scenes::DoublePendulum {
        &self.generated
    }

    #[inline]
    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        let Segment { q0, v, h } = segment;
        let Self { inertia: [a, b, d], weight: [e, f], generated } = self;
        let [c0, c1] = generated.c;
        let half = 0.5 * h;
        let q = q0 + v * half;
        let (sine, cosine) = (q[0] - q[1]).sin_cos();
        let ((s0, k0), (s1, k1)) = (q[0].sin_cos(), q[1].sin_cos());
        let (ds, dc) = (d * sine, d * cosine);
        let relative = c1 * (v[1] - v[0]);
        let product = v[0] * v[1];
        let coupling = ds * product;
        let g = vector![relative - coupling - e * s0 - c0 * v[0], coupling - f * s1 - relative];
        // Along v̄ the point moves by half h: ∂/∂v̄ = ∂/∂v + half ∂/∂q.
        let square = half * half;
        let x = half * ds * (v[0] + v[1]);
        let y = square * dc * product;
        let joint = half * c1;
        let beside = dc - y - joint;
        StepKernel {
            p0: vector![a * v[0] + dc * v[1], dc * v[0] + b * v[1]] - g * half,
            matrix: matrix![
                a + half * (c0 + c1) + square * (e * k0) + y, beside + x;
                beside - x, b + joint + square * (f * k1) + y
            ],
        }
    }

    #[inline]
    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        let Segment { q0, v, h } = segment;
        let Self { inertia: [a, b, d], weight: [e, f], generated } = self;
        let [c0, c1] = generated.c;
        let half = 0.5 * h;
        let q = q0 + v * half;
        let (sine, cosine) = (q[0] - q[1]).sin_cos();
        let dc = d * cosine;
        let relative = c1 * (v[1] - v[0]);
        let coupling = d * sine * (v[0] * v[1]);
        let g =
            vector![relative - coupling - e * q[0].sin() - c0 * v[0], coupling - f * q[1].sin() - relative];
        let momentum = vector![a * v[0] + dc * v[1], dc * v[0] + b * v[1]];
        let impulse = g * half;
        Momenta { p0: momentum - impulse, p1: momentum + impulse }
    }
}
