//! The spring chain: spring and dashpot i between the masses i − 1 and i (the first on the wall), force k d +
//! κ d³, stiffness k + 3κ d².

use dalembert::nalgebra::SVector;
use dalembert::run::KeptMatrix;
use dalembert::step::{Banded, Momenta, Segment, StepKernel};
use dalembert::{Discrete, Midpoint};

use super::HandDerived;

/// The spring chain of N masses, by hand.
pub struct SpringChain<L, const N: usize> {
    /// The generated system.
    pub generated: L,
    /// Masses.
    pub m: [f64; N],
    /// Stiffness k.
    pub stiffness: f64,
    /// Hardening κ.
    pub hardening: f64,
    /// Friction coefficient c.
    pub friction: f64,
}

impl<L, const N: usize> SpringChain<L, N> {
    /// The elongation of each spring at q̄, and its rate.
    #[inline]
    fn elongations(q0: &SVector<f64, N>, v: &SVector<f64, N>, half: f64) -> [[f64; N]; 2] {
        let q = q0 + v * half;
        let (mut d, mut rate) = ([0.0; N], [0.0; N]);
        (d[0], rate[0]) = (q[0], v[0]);
        for i in 1..N {
            d[i] = q[i] - q[i - 1];
            rate[i] = v[i] - v[i - 1];
        }
        [d, rate]
    }
}

impl<L, const N: usize> HandDerived<N> for SpringChain<L, N>
where
    L: Discrete<Midpoint, N, Scalar = f64>,
{
    type Generated = L;
    type Matrix = Banded<f64, N, 3>;
    type Memory = KeptMatrix<f64, Self::Matrix, N>;

    fn generated(&self) -> &L {
        &self.generated
    }

    #[inline]
    fn step_kernel(&self, segment: &Segment<f64, N>) -> StepKernel<f64, N, Self::Matrix> {
        let Segment { q0, v, h } = segment;
        let half = 0.5 * h;
        let [d, rate] = Self::elongations(q0, v, half);
        let constant = half * (self.friction + half * self.stiffness);
        let varying = half * half * 3.0 * self.hardening;
        let (mut force, mut stiffness) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            let square = d[i] * d[i];
            force[i] = half * ((self.stiffness + self.hardening * square) * d[i] + self.friction * rate[i]);
            stiffness[i] = constant + varying * square;
        }
        let mut rows = [[0.0; 3]; N];
        let mut p0 = *v;
        for i in 0..N {
            p0[i] = self.m[i] * v[i] + force[i];
            rows[i][1] = self.m[i] + stiffness[i];
        }
        for i in 1..N {
            p0[i - 1] -= force[i];
            rows[i - 1][1] += stiffness[i];
            rows[i - 1][2] = -stiffness[i];
            rows[i][0] = -stiffness[i];
        }
        let matrix = Banded { rows };
        StepKernel { p0, matrix }
    }

    #[inline]
    fn momenta(&self, segment: &Segment<f64, N>) -> Momenta<f64, N> {
        let Segment { q0, v, h } = segment;
        let half = 0.5 * h;
        let [d, rate] = Self::elongations(q0, v, half);
        let mut impulse = *v;
        for i in 0..N {
            impulse[i] =
                half * ((self.stiffness + self.hardening * (d[i] * d[i])) * d[i] + self.friction * rate[i]);
        }
        for i in 1..N {
            impulse[i - 1] -= impulse[i];
        }
        let (mut p0, mut p1) = (*v, *v);
        for i in 0..N {
            let momentum = self.m[i] * v[i];
            (p0[i], p1[i]) = (momentum + impulse[i], momentum - impulse[i]);
        }
        Momenta { p0, p1 }
    }
}
