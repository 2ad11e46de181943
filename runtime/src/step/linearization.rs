//! The step's derivative by the state that it starts from, exact: no differences, the implicit function
//! theorem.
//!
//! On a segment (q0, q1) the two Legendre transforms have the derivatives
//!
//! ```text
//! K00 = ∂p0/∂q0 = −D1D1 L_d − D1 f_d⁻        K01 = ∂p0/∂q1 = −D1D2 L_d − D2 f_d⁻
//! K10 = ∂p1/∂q0 = (D1D2 L_d)ᵀ + D1 f_d⁺      K11 = ∂p1/∂q1 = D2D2 L_d + D2 f_d⁺
//! ```
//!
//! The step holds p0 fixed and solves for q1, so that dq1 = K01⁻¹ (dp0 − K00 dq0) and dp1 = K10 dq0 + K11
//! dq1:
//!
//! ```text
//!     ∂(q1, p1)     ⎡     −K01⁻¹ K00            K01⁻¹     ⎤
//! A = ─────────  =  ⎢                                     ⎥
//!     ∂(q0, p0)     ⎣ K10 − K11 K01⁻¹ K00    K11 K01⁻¹    ⎦
//!
//! det A = det K10 / det(−K01) = det(D1D2 L_d⁻) / det(D1D2 L_d⁺)      the second form for a Rayleigh force
//! ```
//!
//! The derivative B = ∂(q1, p1)/∂u by an input that is held, and those by parameters, come in the same way:
//! what moves the momenta by P0 and P1 at fixed configurations moves q1 by −K01⁻¹ P0 and p1 by P1 − K11 K01⁻¹
//! P0.

use core::ops::Mul;

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Derivatives, Scalar, Singular, derivatives::linear, linear};
use crate::step::cause::explained_by_lagrangian;
use crate::step::massless::Massless;
use crate::step::{DiscreteForceDerivatives, Momenta, MomentaBy, StepError};
use crate::system::{Lagrangian, Quantity};

/// Both momenta of a segment with their derivatives by its two configurations; see the formulas above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegendreDerivatives<S, const N: usize> {
    /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
    pub momenta: Momenta<S, N>,
    /// K00 = ∂p0/∂q0: entry (i, j) differentiates p0ᵢ by q0ⱼ.
    pub p0_by_q0: SMatrix<S, N, N>,
    /// K01 = ∂p0/∂q1; times h it is the Newton matrix of the step.
    pub p0_by_q1: SMatrix<S, N, N>,
    /// K10 = ∂p1/∂q0.
    pub p1_by_q0: SMatrix<S, N, N>,
    /// K11 = ∂p1/∂q1.
    pub p1_by_q1: SMatrix<S, N, N>,
}

/// A matrix on T*Q = ℝ²ᴺ in its four blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "S: Scalar + serde::Serialize",
        deserialize = "S: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct PhaseMatrix<S, const N: usize> {
    /// ∂q1/∂q0.
    pub q_by_q: SMatrix<S, N, N>,
    /// ∂q1/∂p0.
    pub q_by_p: SMatrix<S, N, N>,
    /// ∂p1/∂q0.
    pub p_by_q: SMatrix<S, N, N>,
    /// ∂p1/∂p0.
    pub p_by_p: SMatrix<S, N, N>,
}

impl<S: Scalar, const N: usize> PhaseMatrix<S, N> {
    /// The identity: the matrix of a state that stays as it is.
    #[must_use]
    pub fn identity() -> Self {
        let (one, zero) = (SMatrix::identity(), nalgebra::zero());
        Self { q_by_q: one, q_by_p: zero, p_by_q: zero, p_by_p: one }
    }
}

/// The product: first `other`, then this.
impl<S: Scalar, const N: usize> Mul for PhaseMatrix<S, N> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            q_by_q: self.q_by_q * other.q_by_q + self.q_by_p * other.p_by_q,
            q_by_p: self.q_by_q * other.q_by_p + self.q_by_p * other.p_by_p,
            p_by_q: self.p_by_q * other.q_by_q + self.p_by_p * other.p_by_q,
            p_by_p: self.p_by_q * other.q_by_p + self.p_by_p * other.p_by_p,
        }
    }
}

/// The product: how a state follows what moves an earlier one by `other`.
impl<S: Scalar, const N: usize, const M: usize> Mul<StateBy<S, N, M>> for PhaseMatrix<S, N> {
    type Output = StateBy<S, N, M>;

    fn mul(self, other: StateBy<S, N, M>) -> StateBy<S, N, M> {
        StateBy {
            q: self.q_by_q * other.q + self.q_by_p * other.p,
            p: self.p_by_q * other.q + self.p_by_p * other.p,
        }
    }
}

/// Derivatives of a state (q1, p1) by M quantities, such as inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateBy<S, const N: usize, const M: usize> {
    /// ∂q1/∂θ, shape N×M.
    pub q: SMatrix<S, N, M>,
    /// ∂p1/∂θ, shape N×M.
    pub p: SMatrix<S, N, M>,
}

linear!(StateBy<M> { q, p });

impl<S: Scalar, const N: usize> LegendreDerivatives<S, N> {
    /// From the derivatives of L_d and of f_d.
    pub(crate) fn from_terms(l: &Derivatives<S, N>, f: &DiscreteForceDerivatives<S, N>) -> Self {
        Self {
            momenta: Momenta { p0: -l.d1 - f.minus.value, p1: l.d2 + f.plus.value },
            p0_by_q0: -l.d11 - f.minus.d1,
            p0_by_q1: -l.d12 - f.minus.d2,
            p1_by_q0: l.d12.transpose() + f.plus.d1,
            p1_by_q1: l.d22 + f.plus.d2,
        }
    }
}

/// A and B of a step, or of a period; M is the number of inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Linearization<S, const N: usize, const M: usize = 0> {
    /// The step matrix A = ∂(q1, p1)/∂(q0, p0).
    pub a: PhaseMatrix<S, N>,
    /// B = ∂(q1, p1)/∂u, the input being held over the step.
    pub b: StateBy<S, N, M>,
}

impl<S: Scalar, const N: usize> LegendreDerivatives<S, N> {
    /// The step matrix A = ∂(q1, p1)/∂(q0, p0).
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] if ∂p0/∂q1 is singular; [`StepError::NonFinite`] where a
    /// derivative is no number.
    pub fn step_matrix(&self) -> Result<PhaseMatrix<S, N>, StepError> {
        self.step_matrix_with(&invert(&self.p0_by_q1)?)
    }

    /// The derivatives of (q1, p1), (q0, p0) being held, by quantities that move the momenta by `momenta` at
    /// fixed configurations; with K01⁻¹ at hand.
    pub(crate) fn answer<const M: usize>(
        &self,
        q_by_p: &SMatrix<S, N, N>,
        momenta: &MomentaBy<S, N, M>,
    ) -> Result<StateBy<S, N, M>, StepError> {
        let q = -(q_by_p * momenta.p0);
        let p = momenta.p1 + self.p1_by_q1 * q;
        StepError::require_finite(&q, Quantity::Derivatives)?;
        StepError::require_finite(&p, Quantity::Derivatives)?;
        Ok(StateBy { q, p })
    }

    /// [`step_matrix`](Self::step_matrix), with K01⁻¹ at hand.
    pub(crate) fn step_matrix_with(&self, q_by_p: &SMatrix<S, N, N>) -> Result<PhaseMatrix<S, N>, StepError> {
        let q_by_q = -(q_by_p * self.p0_by_q0);
        let a = PhaseMatrix {
            q_by_q,
            q_by_p: *q_by_p,
            p_by_q: self.p1_by_q0 + self.p1_by_q1 * q_by_q,
            p_by_p: self.p1_by_q1 * q_by_p,
        };
        let blocks = [&a.q_by_q, &a.q_by_p, &a.p_by_q, &a.p_by_p];
        blocks.into_iter().try_for_each(|block| StepError::require_finite(block, Quantity::Derivatives))?;
        Ok(a)
    }
}

impl<S: Scalar, const N: usize, const M: usize> StateBy<S, N, M> {
    /// Both parts as one matrix, q above p; K = 2N.
    #[must_use]
    pub fn assembled<const K: usize>(&self) -> SMatrix<S, K, M> {
        const { assert!(K == 2 * N, "K is 2N: for N = 1 write `assembled::<2>()`, for N = 2 `assembled::<4>()`") };
        SMatrix::from_fn(|i, j| if i < N { self.q[(i, j)] } else { self.p[(i - N, j)] })
    }
}

impl<S: Scalar, const N: usize> PhaseMatrix<S, N> {
    /// ∂(q, p)/∂(q, v), the derivative of [`State::from_velocity`](crate::State::from_velocity) at (`q`,
    /// `v`): the column blocks by p stand for those by v.
    #[must_use]
    pub fn from_velocity<L: Lagrangian<N, Scalar = S>>(
        system: &L,
        q: &SVector<S, N>,
        v: &SVector<S, N>,
    ) -> Self {
        let l = system.lagrangian_derivatives(q, v);
        Self {
            q_by_q: SMatrix::identity(),
            q_by_p: SMatrix::zeros(),
            p_by_q: l.d12.transpose(),
            p_by_p: l.d22,
        }
    }

    /// ∂(q, v)/∂(q, p), the derivative of [`State::velocity`](crate::State::velocity) at (`q`, `v`): the row
    /// blocks of p stand for those of v. What a sensor of velocities makes of a state.
    ///
    /// # Errors
    /// [`StepError::DegenerateLagrangian`] if ∂²L/∂v² is singular and friction does not determine velocities
    /// either, [`StepError::SingularCoordinates`] if it is so at q alone.
    pub fn to_velocity<L: Lagrangian<N, Scalar = S>>(
        system: &L,
        q: &SVector<S, N>,
        v: &SVector<S, N>,
    ) -> Result<Self, StepError> {
        let l = system.lagrangian_derivatives(q, v);
        let mut found = linear::inverse(&l.d22);
        let (mut by_q, mut massless) = (l.d12.transpose(), Massless::none());
        if found.is_err() {
            massless = Massless::of(system, q);
            let balance = massless.balance_at(system, q, v, S::constant(1.0));
            (found, by_q) = (linear::inverse(&balance.by_v), balance.by_q);
        }
        let v_by = found.map_err(|Singular { column }| {
            explained_by_lagrangian(system, q, v, StepError::DegenerateLagrangian { column })
        })?;
        Ok(Self {
            q_by_q: SMatrix::identity(),
            q_by_p: SMatrix::zeros(),
            p_by_q: -(v_by * by_q),
            p_by_p: massless.without(&v_by.transpose()).transpose(),
        })
    }

    /// The blocks as one matrix in the order (q, p); M = 2N.
    #[must_use]
    pub fn assembled<const M: usize>(&self) -> SMatrix<S, M, M> {
        const { assert!(M == 2 * N, "M is 2N: for N = 1 write `assembled::<2>()`, for N = 2 `assembled::<4>()`") };
        SMatrix::from_fn(|i, j| {
            let block = match (i < N, j < N) {
                (true, true) => &self.q_by_q,
                (true, false) => &self.q_by_p,
                (false, true) => &self.p_by_q,
                (false, false) => &self.p_by_p,
            };
            block[(i % N, j % N)]
        })
    }
}

/// The inverse, or the column whose pivot is lost to rounding.
pub(crate) fn invert<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
) -> Result<SMatrix<S, N, N>, StepError> {
    linear::inverse(matrix).map_err(|singular| {
        match StepError::require_finite(matrix, Quantity::Derivatives) {
            Err(error) => error,
            Ok(()) => StepError::SingularNewtonMatrix { iteration: 0, column: singular.column },
        }
    })
}
