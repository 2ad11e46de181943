//! The pendulum chain. Mass k has the velocity l Σ_{i≤k} vᵢ (cos qᵢ, sin qᵢ); μᵢ = Σ_{k≥i} mₖ, P_i = l
//! Σ_{k≥i} mₖ velocityₖ.
//!
//! ```text
//! ∂L/∂vᵢ = P_i · (cos qᵢ, sin qᵢ),   ∂L/∂qᵢ = vᵢ P_i · (−sin qᵢ, cos qᵢ) − μᵢ g l sin qᵢ
//! ```
//!
//! Varying v̄ᵢ as the step's equation does moves vᵢ (cos qᵢ, sin qᵢ) along x⁻ = (cos + a v sin, sin − a v
//! cos) and x⁺ = (cos − a v sin, sin + a v cos), a = h/2: the Newton matrix is l² μ_max(i,j) x⁻ᵢ · x⁺ⱼ, what
//! the diagonal adds, and the friction.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::run::KeptMatrix;
use dalembert::step::{Momenta, Segment, StepKernel};
use dalembert_scenes as scenes;

use super::HandDerived;

const N: usize = 16;

/// The pendulum chain, by hand.
pub struct PendulumChain {
    generated: scenes::PendulumChain16,
    /// l² μᵢ.
    inertia: [f64; N],
    /// μᵢ g l.
    weight: [f64; N],
}

impl From<scenes::PendulumChain16> for PendulumChain {
    fn from(generated: scenes::PendulumChain16) -> Self {
        let mut mass = generated.m;
        for i in (1..N).rev() {
            mass[i - 1] += mass[i];
        }
        Self {
            inertia: mass.map(|mass| generated.l * generated.l * mass),
            weight: mass.map(|mass| mass * generated.g * generated.l),
            generated,
        }
    }
}

type Vector = SVector<f64, N>;

/// Directions of the links and the momenta below them, at q̄.
struct Links {
    sine: [f64; N],
    cosine: [f64; N],
    /// P_i.
    px: [f64; N],
    py: [f64; N],
}

impl PendulumChain {
    #[inline]
    fn links(&self, q0: &Vector, v: &Vector, half: f64) -> Links {
        let (mut sine, mut cosine) = ([0.0; N], [0.0; N]);
        let (mut px, mut py) = ([0.0; N], [0.0; N]);
        let (mut vx, mut vy) = (0.0, 0.0);
        for i in 0..N {
            (sine[i], cosine[i]) = (q0[i] + half * v[i]).sin_cos();
            vx += v[i] * cosine[i];
            vy += v[i] * sine[i];
            (px[i], py[i]) = (self.generated.m[i] * vx, self.generated.m[i] * vy);
        }
        for i in (1..N).rev() {
            px[i - 1] += px[i];
            py[i - 1] += py[i];
        }
        let square = self.generated.l * self.generated.l;
        Links { sine, cosine, px: px.map(|p| square * p), py: py.map(|p| square * p) }
    }

    /// −(h/2) (∂L/∂q − ∂R/∂v).
    #[inline]
    fn impulse(&self, links: &Links, v: &Vector, half: f64) -> Vector {
        let Links { sine, cosine, px, py } = links;
        let mut force = [0.0; N];
        for i in 0..N {
            force[i] = (v[i] * px[i] + self.weight[i]) * sine[i] - v[i] * py[i] * cosine[i];
        }
        let mut joint = [0.0; N];
        joint[0] = self.generated.c * v[0];
        for i in 1..N {
            joint[i] = self.generated.c * (v[i] - v[i - 1]);
        }
        let mut impulse = *v;
        for i in 0..N {
            impulse[i] = half * (force[i] + joint[i] - joint.get(i + 1).unwrap_or(&0.0));
        }
        impulse
    }
}

impl HandDerived<N> for PendulumChain {
    type Generated = scenes::PendulumChain16;
    type Matrix = SMatrix<f64, N, N>;
    type Memory = KeptMatrix<f64, Self::Matrix, N>;

    fn generated(&self) -> &scenes::PendulumChain16 {
        &self.generated
    }

    #[inline]
    fn step_kernel(&self, segment: &Segment<f64, N>) -> StepKernel<f64, N> {
        let Segment { q0, v, h } = segment;
        let half = 0.5 * h;
        let square = half * half;
        let links = self.links(q0, v, half);
        let Links { sine, cosine, px, py } = &links;
        let mut p0 = self.impulse(&links, v, half);
        let (mut minus, mut plus) = ([[0.0; N]; 2], [[0.0; N]; 2]);
        for i in 0..N {
            p0[i] += px[i] * cosine[i] + py[i] * sine[i];
            let turn = half * v[i];
            minus[0][i] = cosine[i] + turn * sine[i];
            minus[1][i] = sine[i] - turn * cosine[i];
            plus[0][i] = cosine[i] - turn * sine[i];
            plus[1][i] = sine[i] + turn * cosine[i];
        }
        let mut matrix = SMatrix::<f64, N, N>::zeros();
        for j in 0..N {
            // Above the diagonal μⱼ, below it μᵢ.
            let (x, y) = (plus[0][j], plus[1][j]);
            let (heavy_x, heavy_y) = (self.inertia[j] * x, self.inertia[j] * y);
            for i in 0..j {
                matrix[(i, j)] = minus[0][i] * heavy_x + minus[1][i] * heavy_y;
            }
            for i in j..N {
                matrix[(i, j)] = self.inertia[i] * (minus[0][i] * x + minus[1][i] * y);
            }
        }
        let joint = half * self.generated.c;
        for i in 0..N {
            matrix[(i, i)] += square * ((v[i] * px[i] + self.weight[i]) * cosine[i] + v[i] * py[i] * sine[i])
                + if i + 1 < N { joint + joint } else { joint };
        }
        for i in 1..N {
            matrix[(i, i - 1)] -= joint;
            matrix[(i - 1, i)] -= joint;
        }
        StepKernel { p0, matrix }
    }

    #[inline]
    fn momenta(&self, segment: &Segment<f64, N>) -> Momenta<f64, N> {
        let Segment { q0, v, h } = segment;
        let half = 0.5 * h;
        let links = self.links(q0, v, half);
        let impulse = self.impulse(&links, v, half);
        let mut momentum = *v;
        for i in 0..N {
            momentum[i] = links.px[i] * links.cosine[i] + links.py[i] * links.sine[i];
        }
        Momenta { p0: momentum + impulse, p1: momentum - impulse }
    }
}
