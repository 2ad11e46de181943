//! The systems measured: for this project a Lagrangian and a Rayleigh function, for its peers the
//! accelerations that follow, derived by hand with common subexpressions shared.

use dalembert::system::ForcedLagrangian;
use dalembert::{Discrete, Midpoint, Trapezoidal, rayleigh_system};
pub use dalembert_scenes::{
    DoublePendulum, EccentricKepler, FputChain2, FputChain4, FputChain8, FputChain16, FputChain32,
    HenonHeiles, Kepler, Ring,
};

use crate::ours::{self, InScaledTime, Splittings, Steps};

/// A motion as its accelerations: what a peer integrates.
pub trait Accelerated<const N: usize>: Copy + 'static {
    /// q̈ as a function of (q, q̇).
    fn acceleration(&self, q: &[f64; N], v: &[f64; N]) -> [f64; N];
}

/// A system in both forms.
pub trait Scene<const N: usize>:
    Accelerated<N> + Discrete<Midpoint, N, Scalar = f64> + Discrete<Trapezoidal, N> + ForcedLagrangian<N>
{
    /// The methods that not every scene has.
    const OTHERS: &'static [(&'static str, Steps<Self, N>)] = &[];

    /// All methods of this project.
    fn methods() -> Vec<(&'static str, Steps<Self, N>)> {
        [&ours::methods(), Self::OTHERS].concat()
    }
}

/// The names of all methods of this project, those of an eccentric orbit among them.
pub fn names() -> Vec<&'static str> {
    let scaled = EccentricKepler::OTHERS.iter().map(|(name, _)| *name);
    let to_rounding = Ring::methods().into_iter().map(|(name, _)| name).chain(scaled);
    to_rounding.chain(ours::to_an_error::<Ring, 2>().into_iter().map(|(name, _)| name)).collect()
}

impl Scene<2> for Ring {
    const OTHERS: &'static [(&'static str, Steps<Self, 2>)] = Splittings::ALL;
}

impl Accelerated<2> for Ring {
    #[inline]
    fn acceleration(&self, q: &[f64; 2], v: &[f64; 2]) -> [f64; 2] {
        let s = q[0] * q[0] + q[1] * q[1];
        let slope = 2.0 * (s - 1.0) * (3.0 * s - 1.0);
        [-slope * q[0] - self.k * v[0], -slope * q[1] - self.k * v[1]]
    }
}

impl Scene<2> for DoublePendulum {}

impl Accelerated<2> for DoublePendulum {
    #[inline]
    fn acceleration(&self, q: &[f64; 2], v: &[f64; 2]) -> [f64; 2] {
        let ([m1, m2], [l1, l2], g, c) = (self.m, self.l, self.g, self.c);
        let (a, b, d) = ((m1 + m2) * l1 * l1, m2 * l2 * l2, m2 * l1 * l2);
        // Of the difference by addition theorem: two evaluations of sin and cos, not three.
        let ((s0, c0), (s1, c1)) = (q[0].sin_cos(), q[1].sin_cos());
        let (sine, cosine) = (s0 * c1 - c0 * s1, c0 * c1 + s0 * s1);
        let (coupling, relative) = (d * cosine, c[1] * (v[1] - v[0]));
        let x = -d * sine * v[1] * v[1] - (m1 + m2) * g * l1 * s0 - c[0] * v[0] + relative;
        let y = d * sine * v[0] * v[0] - m2 * g * l2 * s1 - relative;
        let inverse = 1.0 / (a * b - coupling * coupling);
        [(b * x - coupling * y) * inverse, (a * y - coupling * x) * inverse]
    }
}

macro_rules! chains {
    ($($name:ident: $n:literal;)*) => {$(
        impl Scene<$n> for $name {
            const OTHERS: &'static [(&'static str, Steps<Self, $n>)] = Splittings::ALL;
        }

        impl Accelerated<$n> for $name {
            #[inline]
            fn acceleration(&self, q: &[f64; $n], v: &[f64; $n]) -> [f64; $n] {
                let force = |d: f64| d + self.beta * (d * d * d);
                let mut left = force(q[0]);
                std::array::from_fn(|i| {
                    let right = force(if i + 1 < $n { q[i + 1] - q[i] } else { -q[i] });
                    let pull = right - left;
                    left = right;
                    pull - self.drag * v[i]
                })
            }
        }
    )*};
}
chains! {
    FputChain2: 2;
    FputChain4: 4;
    FputChain8: 8;
    FputChain16: 16;
    FputChain32: 32;
}

impl Scene<2> for HenonHeiles {
    const OTHERS: &'static [(&'static str, Steps<Self, 2>)] = Splittings::ALL;
}

impl Accelerated<2> for HenonHeiles {
    #[inline]
    fn acceleration(&self, &[x, y]: &[f64; 2], _: &[f64; 2]) -> [f64; 2] {
        [-x - 2.0 * (x * y), -y - x * x + y * y]
    }
}

impl Scene<2> for Kepler {
    const OTHERS: &'static [(&'static str, Steps<Self, 2>)] = Splittings::ALL;
}

impl Accelerated<2> for Kepler {
    #[inline]
    fn acceleration(&self, q: &[f64; 2], v: &[f64; 2]) -> [f64; 2] {
        let square = q[0] * q[0] + q[1] * q[1];
        let pull = 1.0 / (square * square.sqrt());
        [-pull * q[0] - self.k * v[0], -pull * q[1] - self.k * v[1]]
    }
}

impl Scene<2> for EccentricKepler {
    const OTHERS: &'static [(&'static str, Steps<Self, 2>)] = InScaledTime::ALL;
}

impl Accelerated<2> for EccentricKepler {
    #[inline]
    fn acceleration(&self, q: &[f64; 2], v: &[f64; 2]) -> [f64; 2] {
        Kepler { k: self.k }.acceleration(q, v)
    }
}

/// Seven pendulums of unit masses and lengths, one hanging from the other, absolute angles, friction in every
/// joint.
#[derive(Clone, Copy)]
pub struct Pendulums {
    pub g: f64,
    pub c: f64,
}

impl Pendulums {
    pub const EXAMPLE: Self = Self { g: 9.81, c: 0.05 };
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Pendulums {
    fn lagrangian(&self, q: [f64; 7], v: [f64; 7]) -> f64 {
        let (mut x, mut y, mut height, mut l) = (0.0, 0.0, 0.0, 0.0);
        for (q, v) in q.iter().zip(&v) {
            x += q.cos() * v;
            y += q.sin() * v;
            height -= q.cos();
            l += 0.5 * (x * x + y * y) - self.g * height;
        }
        l
    }

    fn rayleigh(&self, v: [f64; 7]) -> f64 {
        let mut r = 0.5 * self.c * v[0] * v[0];
        for i in 1..7 {
            let relative = v[i] - v[i - 1];
            r += 0.5 * self.c * relative * relative;
        }
        r
    }
}

impl Scene<7> for Pendulums {}

impl Accelerated<7> for Pendulums {
    /// Mass matrix Mᵢⱼ = (7 − max(i, j)) cos(qᵢ − qⱼ), solved with by LDLᵀ.
    #[inline]
    fn acceleration(&self, q: &[f64; 7], v: &[f64; 7]) -> [f64; 7] {
        const N: usize = 7;
        let turns = q.map(f64::sin_cos);
        let mut mass = [[0.0; N]; N];
        let mut a = [0.0; N];
        for i in 0..N {
            let (si, ci) = turns[i];
            a[i] += -((N - i) as f64) * self.g * si - self.c * (v[i] - if i > 0 { v[i - 1] } else { 0.0 });
            if i + 1 < N {
                a[i] += self.c * (v[i + 1] - v[i]);
            }
            mass[i][i] = (N - i) as f64;
            for j in 0..i {
                let (sj, cj) = turns[j];
                let carried = (N - i) as f64;
                mass[i][j] = carried * (ci * cj + si * sj);
                let sine = carried * (si * cj - ci * sj);
                a[i] -= sine * (v[j] * v[j]);
                a[j] += sine * (v[i] * v[i]);
            }
        }
        // In place, column by column: below the diagonal L, on it 1/D.
        for j in 0..N {
            let inverse = 1.0 / mass[j][j];
            let column: [f64; N] = std::array::from_fn(|i| mass[i][j]);
            for (i, row) in mass.iter_mut().enumerate().skip(j + 1) {
                row[j] = column[i] * inverse;
                for k in j + 1..=i {
                    row[k] -= row[j] * column[k];
                }
            }
            mass[j][j] = inverse;
        }
        for i in 0..N {
            for k in 0..i {
                a[i] -= mass[i][k] * a[k];
            }
        }
        for i in (0..N).rev() {
            a[i] *= mass[i][i];
            for k in i + 1..N {
                a[i] -= mass[k][i] * a[k];
            }
        }
        a
    }
}
