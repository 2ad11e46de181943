//! The end of a step with the damping in it: the Legendre transform at q1 of L + (h/2) R.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Derivatives, Gradient, Scalar};
use crate::step::equation::Alone;
use crate::step::{Segment, State, StepError, StepKernel, invert, newton};
use crate::system::{Damping, Lagrangian, Rayleigh, Structure};

/// L(q1, v) + (h/2) R(q̄, v) as a function of v at the end of a segment: its momentum w has the velocity v1.
pub(super) struct End<'a, L: Lagrangian<N>, const N: usize> {
    /// The system at the start of the segment.
    system: &'a L,
    segment: &'a Segment<L::Scalar, N>,
    half: L::Scalar,
}

impl<'a, L: Rayleigh<N>, const N: usize> End<'a, L, N> {
    pub(super) fn of(system: &'a L, segment: &'a Segment<L::Scalar, N>) -> Self {
        Self { system, segment, half: segment.h * L::Scalar::constant(0.5) }
    }

    /// v1 of w = ∂L/∂v(q1, v1) + (h/2) ∂R/∂v(q̄, v1).
    ///
    /// # Errors
    /// Those of [`State::velocity`], of L + (h/2) R.
    pub(super) fn velocity(&self, w: &SVector<L::Scalar, N>) -> Result<SVector<L::Scalar, N>, StepError> {
        let state = State { q: self.q1(), p: *w };
        if !<Self as Lagrangian<N>>::STRUCTURE.constant_mass_matrix {
            let equation = Alone {
                kernel: |q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>| {
                    let l = self.lagrangian_derivatives(q, v);
                    StepKernel { p0: l.d2, matrix: l.d22 }
                },
                momentum: |q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>| {
                    self.lagrangian_gradient(q, v).d2
                },
                inertia: |q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>| {
                    self.lagrangian_derivatives(q, v).d22
                },
            };
            // The mean velocity is near, rest is not.
            if let Ok(solution) = newton::quick(&equation, &state, nalgebra::zero(), self.segment.v) {
                return Ok(solution.unknown);
            }
        }
        state.velocity(self)
    }

    /// p1 = ∂L/∂v(q1, v1).
    pub(super) fn momentum(&self, v1: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        let q1 = self.q1();
        self.system.later(self.segment.h, |system| system.lagrangian_gradient(&q1, v1).d2)
    }

    fn q1(&self) -> SVector<L::Scalar, N> {
        self.segment.q0 + self.segment.v * self.segment.h
    }

    /// (h/2) R(q̄, v) with its derivatives, q̄ moving.
    fn damping(&self, v: &SVector<L::Scalar, N>) -> Derivatives<L::Scalar, N> {
        let middle = self.segment.at(L::Scalar::constant(0.5));
        self.system.later(self.half, |system| system.rayleigh_derivatives(&middle, v)) * self.half
    }

    /// The equation for v1 at its solution, linearised.
    pub(super) fn linearized(
        &self,
        v1: &SVector<L::Scalar, N>,
    ) -> Result<LinearizedEnd<L::Scalar, N>, StepError> {
        let q1 = self.q1();
        let l = self.system.later(self.segment.h, |system| system.lagrangian_derivatives(&q1, v1));
        let damping = self.damping(v1);
        Ok(LinearizedEnd {
            velocity: *v1,
            mass: l.d22,
            momentum_by_q1: l.d12.transpose(),
            damping_by_middle: damping.d12.transpose(),
            velocity_by_w: invert(&(l.d22 + damping.d22))?,
        })
    }
}

impl<L: Rayleigh<N>, const N: usize> Lagrangian<N> for End<'_, L, N> {
    type Scalar = L::Scalar;

    const STRUCTURE: Structure = {
        let is_quadratic = L::STRUCTURE.constant_mass_matrix
            && matches!(L::STRUCTURE.damping, Damping::Linear | Damping::LinearByConfiguration);
        if is_quadratic { Structure::UNKNOWN.with_constant_mass_matrix() } else { Structure::UNKNOWN }
    };

    fn lagrangian(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        self.lagrangian_gradient(q, v).value
    }

    fn lagrangian_gradient(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Gradient<L::Scalar, N> {
        let middle = self.segment.at(L::Scalar::constant(0.5));
        let r = self.system.later(self.half, |system| system.rayleigh_gradient(&middle, v));
        let mut l = self.system.later(self.segment.h, |system| system.lagrangian_gradient(q, v));
        l.value += r.value * self.half;
        l.d2 += r.d2 * self.half;
        l
    }

    fn lagrangian_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        let r = self.damping(v);
        let mut l = self.system.later(self.segment.h, |system| system.lagrangian_derivatives(q, v));
        l.value += r.value;
        l.d2 += r.d2;
        l.d22 += r.d22;
        l
    }
}

/// The equation for v1, linearised: by what p1 moves.
pub(super) struct LinearizedEnd<S, const N: usize> {
    /// v1.
    pub(super) velocity: SVector<S, N>,
    /// ∂²L/∂v² at (q1, v1).
    mass: SMatrix<S, N, N>,
    /// ∂²L/∂v∂q at (q1, v1).
    momentum_by_q1: SMatrix<S, N, N>,
    /// (h/2) ∂²R/∂v∂q at (q̄, v1).
    damping_by_middle: SMatrix<S, N, N>,
    /// (∂²L/∂v² + (h/2) ∂²R/∂v²)⁻¹.
    velocity_by_w: SMatrix<S, N, N>,
}

impl<S: Scalar, const N: usize> LinearizedEnd<S, N> {
    /// The derivatives of p1, from those of w at fixed ends and of ∂L/∂v(q1, v1) and (h/2) ∂R/∂v(q̄, v1) at
    /// fixed v1.
    pub(super) fn momentum_by<const K: usize>(
        &self,
        w: &SMatrix<S, N, K>,
        momentum: &SMatrix<S, N, K>,
        damping: &SMatrix<S, N, K>,
    ) -> SMatrix<S, N, K> {
        self.mass * (self.velocity_by_w * (w - momentum - damping)) + momentum
    }

    /// ∂p1/∂q0, where w has this derivative.
    pub(super) fn momentum_by_q0(&self, w: &SMatrix<S, N, N>) -> SMatrix<S, N, N> {
        self.momentum_by(w, &nalgebra::zero(), &(self.damping_by_middle * S::constant(0.5)))
    }

    /// ∂p1/∂q1, where w has this derivative.
    pub(super) fn momentum_by_q1(&self, w: &SMatrix<S, N, N>) -> SMatrix<S, N, N> {
        self.momentum_by(w, &self.momentum_by_q1, &(self.damping_by_middle * S::constant(0.5)))
    }
}
