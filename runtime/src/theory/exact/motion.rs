//! The forced motion and its first variations, in configurations and momenta.
//!
//! ```text
//! p = ∂L/∂v,   q′ = v,   p′ = ∂L/∂q + f
//! δp = L_vq δq + L_vv δv,   δp′ = (L_qq + f_q) δq + (L_qv + f_v) δv
//! ```
//!
//! Neither asks for third derivatives of L, nor for derivatives by the time: ∂q(t)/∂q0 and ∂q(t)/∂q1 are
//! exact to rounding, and where L, R or f takes the time, each evaluation is that of its own.

use nalgebra::{SMatrix, SVector};

use super::work::{Breakdown, Work};
use crate::numbers::{
    CovectorDerivatives, Derivatives,
    linear::{inverse, require_regular},
};
use crate::system::ActingForce;

/// A system with the force that acts on it.
pub(super) struct Dynamics<'a, L, const N: usize> {
    pub(super) system: &'a L,
    /// Whether its force acts.
    pub(super) is_forced: bool,
    /// The time of the system at which the motion starts.
    pub(super) origin: f64,
    pub(super) work: &'a Work<'a>,
}

impl<L, const N: usize> Clone for Dynamics<'_, L, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L, const N: usize> Copy for Dynamics<'_, L, N> {}

/// L and f with their derivatives at (q, v).
#[derive(Clone, Copy)]
pub(super) struct Local<const N: usize> {
    pub(super) l: Derivatives<f64, N>,
    pub(super) f: CovectorDerivatives<f64, N>,
}

/// A family of N variations: column j is the one of parameter j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Family<const N: usize> {
    /// δq.
    pub(super) q: SMatrix<f64, N, N>,
    /// δp.
    pub(super) p: SMatrix<f64, N, N>,
}

/// A point of the motion with two families of variations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point<const N: usize> {
    pub(super) q: SVector<f64, N>,
    pub(super) p: SVector<f64, N>,
    pub(super) v: SVector<f64, N>,
    /// Variations of q0.
    pub(super) minus: Family<N>,
    /// Variations of q1, or of p0 where the motion is told by its initial values.
    pub(super) plus: Family<N>,
}

impl<L: ActingForce<N, Scalar = f64>, const N: usize> Dynamics<'_, L, N> {
    /// Everything that the equations need at (q, v), `time` after the start.
    pub(super) fn local(
        &self,
        time: f64,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
    ) -> Result<Local<N>, Breakdown> {
        let (l, f) = self.derivatives(time, q, v)?;
        // The equations of a step may be solved where accelerations are not determined.
        require_regular(&l.d22).map_err(|singular| Breakdown::Degenerate { column: singular.column })?;
        Ok(Local { l, f })
    }

    /// L and f with their derivatives, all finite.
    pub(super) fn derivatives(
        &self,
        time: f64,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
    ) -> Result<(Derivatives<f64, N>, CovectorDerivatives<f64, N>), Breakdown> {
        self.work.spend()?;
        let (l, f) = self.system.later(self.origin + time, |system| {
            let force = if self.is_forced {
                system.acting_force_derivatives(q, v)
            } else {
                CovectorDerivatives::zero()
            };
            (system.lagrangian_derivatives(q, v), force)
        });
        let finite = |matrix: &SMatrix<f64, N, N>| matrix.iter().all(|entry| entry.is_finite());
        let all = l.value.is_finite()
            && l.d1.iter().chain(&l.d2).chain(&f.value).all(|entry| entry.is_finite())
            && [&l.d11, &l.d12, &l.d22, &f.d1, &f.d2].into_iter().all(finite);
        if all { Ok((l, f)) } else { Err(Breakdown::NotFinite) }
    }
}

impl<const N: usize> Local<N> {
    /// p′.
    pub(super) fn rate(&self) -> SVector<f64, N> {
        self.l.d1 + self.f.value
    }

    /// ∂p′/∂q at fixed v.
    pub(super) fn rate_by_q(&self) -> SMatrix<f64, N, N> {
        self.l.d11 + self.f.d1
    }

    /// ∂p′/∂v.
    pub(super) fn rate_by_v(&self) -> SMatrix<f64, N, N> {
        self.l.d12 + self.f.d2
    }

    /// δv of each column; NaN where ∂²L/∂v² is singular, at which no motion gets.
    pub(super) fn velocities(&self, family: &Family<N>) -> SMatrix<f64, N, N> {
        let inverse_mass = inverse(&self.l.d22).unwrap_or(SMatrix::repeat(f64::NAN));
        inverse_mass * (family.p - self.l.d12.tr_mul(&family.q))
    }
}

impl<const N: usize> Family<N> {
    /// The columns.
    pub(super) fn columns(&self) -> impl Iterator<Item = (SVector<f64, N>, SVector<f64, N>)> {
        (0..N).map(|j| (self.q.column(j).into_owned(), self.p.column(j).into_owned()))
    }

    /// The family with these columns.
    pub(super) fn of_columns(column: impl Fn(usize) -> (SVector<f64, N>, SVector<f64, N>)) -> Self {
        Self { q: SMatrix::from_fn(|i, j| column(j).0[i]), p: SMatrix::from_fn(|i, j| column(j).1[i]) }
    }
}

impl<const N: usize> Point<N> {
    /// Runs of numbers that share a unit.
    pub(super) const BLOCKS: [usize; 7] = [N, N, N, N * N, N * N, N * N, N * N];

    /// All numbers, block by block.
    pub(super) fn numbers(&self) -> Vec<f64> {
        let vectors = [&self.q, &self.p, &self.v].into_iter().flat_map(|vector| vector.iter());
        let matrices = [&self.minus.q, &self.minus.p, &self.plus.q, &self.plus.p];
        vectors.chain(matrices.into_iter().flat_map(|matrix| matrix.iter())).copied().collect()
    }
}
