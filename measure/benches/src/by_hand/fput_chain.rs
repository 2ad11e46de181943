//! The FPUT chain: spring i between the masses i − 1 and i (walls at both ends), force d + β d³, stiffness
//! 1 + 3β d².

use dalembert::nalgebra::SVector;
use dalembert::run::KeptMatrix;
use dalembert::step::{Banded, Momenta, Segment, StepKernel};
use dalembert_scenes as scenes;

use super::HandDerived;

const N: usize = 8;

/// The FPUT chain, by hand.
pub struct FputChain {
    generated: scenes::FputChain8,
}

impl From<scenes::FputChain8> for FputChain {
    fn from(generated: scenes::FputChain8) -> Self {
        Self { generated }
    }
}

type Vector = SVector<f64, N>;

impl FputChain {
    /// The extension of each spring at q̄.
    #[inline]
    fn extensions(q0: &Vector, v: &Vector, half: f64) -> [f64; N + 1] {
        let q = q0 + v * half;
        let mut d = [0.0; N + 1];
        d[0] = q[0];
        for i in 1..N {
            d[i] = q[i] - q[i - 1];
        }
        d[N] = -q[N - 1];
        d
    }
}

impl HandDerived<N> for FputChain {
    type Generated = scenes::FputChain8;
    type Matrix = Banded<f64, N, 3>;
    type Memory = KeptMatrix<f64, Self::Matrix, N>;

    fn generated(&self) -> &scenes::FputChain8 {
        &self.generated
    }

    #[inline]
    fn step_kernel(&self, segment: &Segment<f64, N>) -> StepKernel<f64, N, Self::Matrix> {
        let Segment { q0, v, h } = segment;
        let scenes::FputChain8 { beta, drag } = self.generated;
        let half = 0.5 * h;
        let square = half * half;
        let (mut force, mut stiffness) = ([0.0; N + 1], [0.0; N + 1]);
        for (i, d) in Self::extensions(q0, v, half).into_iter().enumerate() {
            let bend = beta * d * d;
            force[i] = d + bend * d;
            stiffness[i] = square + square * 3.0 * bend;
        }
        let mut rows = [[0.0; 3]; N];
        let mut p0 = *v;
        let diagonal = 1.0 + half * drag;
        for i in 0..N {
            p0[i] += half * (drag * v[i] + force[i] - force[i + 1]);
            rows[i] = [-stiffness[i], diagonal + (stiffness[i] + stiffness[i + 1]), -stiffness[i + 1]];
        }
        // Nothing lies beyond the walls.
        (rows[0][0], rows[N - 1][2]) = (0.0, 0.0);
        let matrix = Banded { rows };
        StepKernel { p0, matrix }
    }

    #[inline]
    fn momenta(&self, segment: &Segment<f64, N>) -> Momenta<f64, N> {
        let Segment { q0, v, h } = segment;
        let scenes::FputChain8 { beta, drag } = self.generated;
        let half = 0.5 * h;
        let force = Self::extensions(q0, v, half).map(|d| d + beta * d * d * d);
        let mut impulse = *v;
        for i in 0..N {
            impulse[i] = half * (drag * v[i] + force[i] - force[i + 1]);
        }
        Momenta { p0: v + impulse, p1: v - impulse }
    }
}
