//! The forced motion and its first variations as a system of ordinary differential equations.
//!
//! ```text
//! q′ = v,   L_vv v′ = L_q + f − L_vq v
//! δp = L_vq δq + L_vv δv,   δp′ = (L_qq + f_q) δq + (L_qv + f_v) δv
//! ```
//!
//! Variations are carried as (δq, δp), not as (δq, δv): the derivatives of v′ would need third derivatives of L, those of
//! p′ = L_q + f need the second ones that every [`Lagrangian`] gives. So ∂q(t)/∂q0 and ∂q(t)/∂q1 are exact to rounding.

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use super::ActingForce;
use super::resolve::Breakdown;
use crate::linear::inverse;
use crate::{CovectorDerivatives, Derivatives, Lagrangian};

/// A system with the force that acts on it.
pub(super) struct Dynamics<'a, L, F, const N: usize> {
    pub(super) system: &'a L,
    pub(super) force: PhantomData<F>,
}

impl<L, F, const N: usize> Clone for Dynamics<'_, L, F, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L, F, const N: usize> Copy for Dynamics<'_, L, F, N> {}

/// L and f with their derivatives at (q, v), and the acceleration.
pub(super) struct Local<const N: usize> {
    pub(super) l: Derivatives<f64, N>,
    pub(super) f: CovectorDerivatives<f64, N>,
    /// (∂²L/∂v²)⁻¹.
    pub(super) inverse_mass: SMatrix<f64, N, N>,
    pub(super) acceleration: SVector<f64, N>,
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
    pub(super) v: SVector<f64, N>,
    /// Variations of q0.
    pub(super) minus: Family<N>,
    /// Variations of q1, or of p0 where the motion is told by its initial values.
    pub(super) plus: Family<N>,
}

impl<L: Lagrangian<N, Scalar = f64>, F: ActingForce<L, N>, const N: usize> Dynamics<'_, L, F, N> {
    /// Everything that the equations need at (q, v).
    pub(super) fn local(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Result<Local<N>, Breakdown> {
        let (l, f) = self.derivatives(q, v)?;
        let inverse_mass =
            inverse(&l.d22).map_err(|singular| Breakdown::Degenerate { column: singular.column })?;
        let acceleration = inverse_mass * (l.d1 + f.value - l.d12.tr_mul(v));
        Ok(Local { l, f, inverse_mass, acceleration })
    }

    /// L and f with their derivatives, all finite.
    pub(super) fn derivatives(
        &self,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
    ) -> Result<(Derivatives<f64, N>, CovectorDerivatives<f64, N>), Breakdown> {
        let l = self.system.lagrangian_derivatives(q, v);
        let f = F::derivatives(self.system, q, v);
        let finite = |matrix: &SMatrix<f64, N, N>| matrix.iter().all(|entry| entry.is_finite());
        let all = l.value.is_finite()
            && l.d1.iter().chain(&l.d2).chain(&f.value).all(|entry| entry.is_finite())
            && [&l.d11, &l.d12, &l.d22, &f.d1, &f.d2].into_iter().all(finite);
        if all { Ok((l, f)) } else { Err(Breakdown::NotFinite) }
    }
}

impl<const N: usize> Local<N> {
    /// δv, from δp = L_vq δq + L_vv δv; `excess` is what else makes up δp.
    pub(super) fn velocity(
        &self,
        q: &SVector<f64, N>,
        p: &SVector<f64, N>,
        excess: &SVector<f64, N>,
    ) -> SVector<f64, N> {
        self.inverse_mass * (p - self.l.d12.tr_mul(q) - excess)
    }

    /// δv of each column.
    pub(super) fn velocities(&self, family: &Family<N>) -> SMatrix<f64, N, N> {
        self.inverse_mass * (family.p - self.l.d12.tr_mul(&family.q))
    }

    /// δp′ of variations δq, δv.
    pub(super) fn momentum_rates<const M: usize>(
        &self,
        q: &SMatrix<f64, N, M>,
        v: &SMatrix<f64, N, M>,
    ) -> SMatrix<f64, N, M> {
        (self.l.d11 + self.f.d1) * q + (self.l.d12 + self.f.d2) * v
    }
}

impl<const N: usize> Point<N> {
    /// Numbers that a point takes.
    pub(super) const LENGTH: usize = 2 * N + 4 * N * N;

    /// Runs of numbers that share a unit.
    pub(super) const BLOCKS: [usize; 6] = [N, N, N * N, N * N, N * N, N * N];

    pub(super) fn write(&self, numbers: &mut [f64]) {
        let mut writer = Writer(numbers);
        writer.put(self.q.as_slice());
        writer.put(self.v.as_slice());
        for family in [&self.minus, &self.plus] {
            writer.put(family.q.as_slice());
            writer.put(family.p.as_slice());
        }
    }

    pub(super) fn read(numbers: &[f64]) -> Self {
        let mut reader = Reader(numbers);
        let (q, v) = (reader.vector(), reader.vector());
        let minus = Family { q: reader.matrix(), p: reader.matrix() };
        let plus = Family { q: reader.matrix(), p: reader.matrix() };
        Self { q, v, minus, plus }
    }
}

/// Takes vectors and matrices off the front of a run of numbers.
pub(super) struct Reader<'a>(pub(super) &'a [f64]);

impl Reader<'_> {
    pub(super) fn take(&mut self, length: usize) -> &[f64] {
        let (front, rest) = self.0.split_at(length);
        self.0 = rest;
        front
    }

    pub(super) fn number(&mut self) -> f64 {
        self.take(1)[0]
    }

    pub(super) fn vector<const N: usize>(&mut self) -> SVector<f64, N> {
        SVector::from_column_slice(self.take(N))
    }

    pub(super) fn matrix<const N: usize>(&mut self) -> SMatrix<f64, N, N> {
        SMatrix::from_column_slice(self.take(N * N))
    }
}

/// Puts runs of numbers one after another.
pub(super) struct Writer<'a>(pub(super) &'a mut [f64]);

impl Writer<'_> {
    pub(super) fn put(&mut self, numbers: &[f64]) {
        let (front, rest) = core::mem::take(&mut self.0).split_at_mut(numbers.len());
        front.copy_from_slice(numbers);
        self.0 = rest;
    }
}
