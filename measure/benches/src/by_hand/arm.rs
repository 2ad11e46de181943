//! The arm, with w = v1 + v2:
//!
//! ```text
//! T = ½ J v0² + ½ α v1² + δ cos q2 v1 w + ½ γ w²,   J = I + α c1² + 2δ c1 c12 + γ c12²,   V = g1 s1 + g2 s12
//! α = l1² (m1/3 + m2 + m),   δ = l1 l2 (m2/2 + m),   γ = l2² (m2/3 + m)
//! ```

use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::run::KeptMatrix;
use dalembert::step::{Momenta, Segment, StepKernel};
use dalembert_scenes as scenes;

use super::HandDerived;

/// The arm, by hand.
pub struct Arm {
    generated: scenes::Arm,
    alpha: f64,
    delta: f64,
    gamma: f64,
    /// g1, g2.
    weight: [f64; 2],
}

impl From<scenes::Arm> for Arm {
    fn from(generated: scenes::Arm) -> Self {
        let ([m1, m2], [l1, l2], payload, g) = (generated.m, generated.l, generated.payload, generated.g);
        Self {
            alpha: l1 * l1 * (m1 / 3.0 + m2 + payload),
            delta: l1 * l2 * (m2 / 2.0 + payload),
            gamma: l2 * l2 * (m2 / 3.0 + payload),
            weight: [g * l1 * (m1 / 2.0 + m2 + payload), g * l2 * (m2 / 2.0 + payload)],
            generated,
        }
    }
}

type Vector = SVector<f64, 3>;

/// What the equation and the momenta share.
struct Terms {
    /// sin and cos of q1, of q1 + q2 and of q2.
    upper: (f64, f64),
    lower: (f64, f64),
    elbow: (f64, f64),
    /// J.
    yaw: f64,
    momentum: Vector,
    /// −(∂L/∂q − ∂R/∂v).
    load: Vector,
    /// ∂J/∂q1, ∂J/∂q2.
    yaw_by: [f64; 2],
}

impl Arm {
    #[inline]
    fn terms(&self, q0: &Vector, v: &Vector, half: f64) -> Terms {
        let Self { alpha, delta, gamma, weight, generated } = self;
        let c = generated.c;
        let q = q0 + v * half;
        let (s1, c1) = q[1].sin_cos();
        let (s12, c12) = (q[1] + q[2]).sin_cos();
        let (s2, c2) = (s12 * c1 - c12 * s1, c12 * c1 + s12 * s1);
        let turning = v[1] + v[2];
        let reach = delta * c1 + gamma * c12;
        let yaw = generated.base + (alpha * c1 + delta * c12) * c1 + reach * c12;
        let by_elbow = -2.0 * s12 * reach;
        let by_shoulder = by_elbow - 2.0 * s1 * (alpha * c1 + delta * c12);
        let swing = 0.5 * (v[0] * v[0]);
        let (dc, ds) = (delta * c2, delta * s2);
        let lower = weight[1] * c12 - swing * by_elbow;
        Terms {
            upper: (s1, c1),
            lower: (s12, c12),
            elbow: (ds, dc),
            yaw,
            momentum: vector![
                yaw * v[0],
                alpha * v[1] + dc * (v[1] + turning) + gamma * turning,
                dc * v[1] + gamma * turning
            ],
            load: vector![
                c[0] * v[0],
                weight[0] * c1 + weight[1] * c12 - swing * by_shoulder + c[1] * v[1],
                lower + ds * (v[1] * turning) + c[2] * v[2]
            ],
            yaw_by: [by_shoulder, by_elbow],
        }
    }
}

impl HandDerived<3> for Arm {
    type Generated = scenes::Arm;
    type Matrix = SMatrix<f64, 3, 3>;
    type Memory = KeptMatrix<f64, Self::Matrix, 3>;

    fn generated(&self) -> &scenes::Arm {
        &self.generated
    }

    #[inline]
    fn step_kernel(&self, segment: &Segment<f64, 3>) -> StepKernel<f64, 3> {
        let Segment { q0, v, h } = segment;
        let Self { alpha, delta, gamma, weight, generated } = self;
        let c = generated.c;
        let half = 0.5 * h;
        let square = half * half;
        let Terms { upper: (s1, c1), lower: (s12, c12), elbow: (ds, dc), yaw, momentum, load, yaw_by } =
            self.terms(q0, v, half);
        let turning = v[1] + v[2];
        let swing = v[0] * v[0];
        // −½ ∂²J/∂q², by (1, 1), (1, 2) and (2, 2).
        let bend = gamma * (c12 * c12 - s12 * s12);
        let cross = delta * (c1 * c12 - s1 * s12) + bend;
        let second = [
            alpha * (c1 * c1 - s1 * s1) + delta * (c1 * c12 - s1 * s12) + cross,
            cross,
            delta * (c1 * c12) + bend,
        ];
        let fall = weight[1] * s12;
        // −L_qq.
        let stiffness = [
            swing * second[0] - (weight[0] * s1 + fall),
            swing * second[1] - fall,
            swing * second[2] + dc * (v[1] * turning) - fall,
        ];
        let gyroscopic = [half * yaw_by[0] * v[0], half * yaw_by[1] * v[0], half * ds * (v[1] + turning)];
        let beside = dc + gamma + square * stiffness[1];
        StepKernel {
            p0: momentum + load * half,
            matrix: matrix![
                yaw + half * c[0], gyroscopic[0], gyroscopic[1];
                -gyroscopic[0], alpha + 2.0 * dc + gamma + half * c[1] + square * stiffness[0], beside - gyroscopic[2];
                -gyroscopic[1], beside + gyroscopic[2], gamma + half * c[2] + square * stiffness[2]
            ],
        }
    }

    #[inline]
    fn momenta(&self, segment: &Segment<f64, 3>) -> Momenta<f64, 3> {
        let Segment { q0, v, h } = segment;
        let half = 0.5 * h;
        let Terms { momentum, load, .. } = self.terms(q0, v, half);
        let impulse = load * half;
        Momenta { p0: momentum + impulse, p1: momentum - impulse }
    }
}
