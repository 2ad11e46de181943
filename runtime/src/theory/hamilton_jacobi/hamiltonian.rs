//! The discrete action and the discrete Hamiltonians, and the transforms that they are functions through.

use nalgebra::{SMatrix, SVector};

use super::{HamiltonJacobi, HamiltonJacobiError, ImplicitEquation};
use crate::numbers::Scalar;
use crate::step::{
    Discrete, LegendreDerivatives, State, StepError, StepKernel, equation::Alone, invert, newton,
};

/// A discrete Hamiltonian with its derivatives at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteHamiltonian<S, const N: usize> {
    /// H_d⁺(q0, p1) or H_d⁻(q1, p0).
    pub value: S,
    /// D1: derivative by the configuration, shape N.
    pub d1: SVector<S, N>,
    /// D2: derivative by the momentum, shape N.
    pub d2: SVector<S, N>,
    /// The configuration that the forced Legendre transform eliminates: q1 of H_d⁺(q0, p1), q0 of H_d⁻(q1,
    /// p0).
    pub eliminated: SVector<S, N>,
    /// Its derivative by the other configuration, shape N×N: ∂q1/∂q0 at fixed p1, or ∂q0/∂q1 at fixed p0.
    pub eliminated_by_q: SMatrix<S, N, N>,
    /// Its derivative by the momentum, shape N×N: ∂q1/∂p1, or ∂q0/∂p0.
    pub eliminated_by_p: SMatrix<S, N, N>,
}

/// Which end of a segment is the unknown of an implicit equation.
#[derive(Clone, Copy)]
enum Unknown {
    Q0,
    Q1,
}

/// Which momentum is given.
#[derive(Clone, Copy)]
enum Given {
    P0,
    P1,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// The discrete action S_d = Σ L_d(q_k, q_{k+1}) of a sequence of configurations (paper, section 3.2).
    #[must_use]
    pub fn discrete_action(&self, configurations: &[SVector<S, N>]) -> S {
        configurations.windows(2).enumerate().fold(S::zero(), |sum, (k, pair)| {
            sum + self.in_step(k, |theory| theory.by.objects(&pair[0], &pair[1]).lagrangian())
        })
    }

    /// The right discrete Hamiltonian H_d⁺(q0, p1) = p1·q1 − L_d(q0, q1), q1 by p1 = D2 L_d + f_d⁺.
    ///
    /// ```text
    /// ∂q1/∂p1 = K11⁻¹,  ∂q1/∂q0 = −K11⁻¹ K10           K10, K11: ∂p1/∂q0, ∂p1/∂q1
    /// D1 H_d⁺ = (∂q1/∂q0)ᵀ (p1 − D2 L_d) − D1 L_d,     D2 H_d⁺ = q1 + (∂q1/∂p1)ᵀ (p1 − D2 L_d)
    /// ```
    ///
    /// `guess` is a guess for v̄ = (q1 − q0)/h, rest without it.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] where the transform has no solution in reach or K11 is singular.
    pub fn discrete_hamiltonian_plus(
        &self,
        q0: &SVector<S, N>,
        p1: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<DiscreteHamiltonian<S, N>, HamiltonJacobiError> {
        let at = ImplicitEquation::RightHamiltonian.at(0);
        let q1 = self.solve(Unknown::Q1, Given::P1, q0, p1, guess).map_err(&at)?;
        let l = self.by.objects(q0, &q1).lagrangian_derivatives();
        let k = self.legendre(q0, &q1);
        let eliminated_by_p = invert(&k.p1_by_q1).map_err(&at)?;
        let eliminated_by_q = -(eliminated_by_p * k.p1_by_q0);
        let beyond = p1 - l.d2;
        Ok(DiscreteHamiltonian {
            value: p1.dot(&q1) - l.value,
            d1: eliminated_by_q.tr_mul(&beyond) - l.d1,
            d2: q1 + eliminated_by_p.tr_mul(&beyond),
            eliminated: q1,
            eliminated_by_q,
            eliminated_by_p,
        })
    }

    /// The left discrete Hamiltonian H_d⁻(q1, p0) = −p0·q0 − L_d(q0, q1), q0 by p0 = −D1 L_d − f_d⁻.
    ///
    /// ```text
    /// ∂q0/∂p0 = K00⁻¹,  ∂q0/∂q1 = −K00⁻¹ K01           K00, K01: ∂p0/∂q0, ∂p0/∂q1
    /// D1 H_d⁻ = −(∂q0/∂q1)ᵀ (p0 + D1 L_d) − D2 L_d,    D2 H_d⁻ = −q0 − (∂q0/∂p0)ᵀ (p0 + D1 L_d)
    /// ```
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] where the transform has no solution in reach or K00 is singular.
    pub fn discrete_hamiltonian_minus(
        &self,
        q1: &SVector<S, N>,
        p0: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<DiscreteHamiltonian<S, N>, HamiltonJacobiError> {
        let at = ImplicitEquation::LeftHamiltonian.at(0);
        let q0 = self.solve(Unknown::Q0, Given::P0, q1, p0, guess).map_err(&at)?;
        let l = self.by.objects(&q0, q1).lagrangian_derivatives();
        let k = self.legendre(&q0, q1);
        let eliminated_by_p = invert(&k.p0_by_q0).map_err(&at)?;
        let eliminated_by_q = -(eliminated_by_p * k.p0_by_q1);
        let beyond = p0 + l.d1;
        Ok(DiscreteHamiltonian {
            value: -p0.dot(&q0) - l.value,
            d1: -eliminated_by_q.tr_mul(&beyond) - l.d2,
            d2: -q0 - eliminated_by_p.tr_mul(&beyond),
            eliminated: q0,
            eliminated_by_q,
            eliminated_by_p,
        })
    }

    /// q1 with 𝔽⁻(q0, q1) = (q0, p0), and the state that the step leads to.
    pub(super) fn step(
        &self,
        q0: &SVector<S, N>,
        p0: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<State<S, N>, HamiltonJacobiError> {
        let state = State { q: *q0, p: *p0 };
        let taken = self.by.system.step(&state, self.by.h, guess).map_err(ImplicitEquation::Step.at(0))?;
        Ok(taken.state)
    }

    /// q0 with 𝔽⁺(q0, q1) = (q1, p1): the step backwards.
    pub(super) fn backward_step(
        &self,
        q1: &SVector<S, N>,
        p1: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<SVector<S, N>, HamiltonJacobiError> {
        self.solve(Unknown::Q0, Given::P1, q1, p1, guess).map_err(ImplicitEquation::BackwardStep.at(0))
    }

    pub(super) fn legendre(&self, q0: &SVector<S, N>, q1: &SVector<S, N>) -> LegendreDerivatives<S, N> {
        self.by.objects(q0, q1).legendre()
    }

    /// Solves one transform for one end of the segment, in v̄ as the step does.
    fn solve(
        &self,
        unknown: Unknown,
        given: Given,
        known: &SVector<S, N>,
        p: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<SVector<S, N>, StepError> {
        let h = self.by.h;
        // The solver's p0 is whichever momentum is given, its q the known end.
        let ends = |known: &SVector<S, N>, v: &SVector<S, N>| match unknown {
            Unknown::Q0 => (known - v * h, *known),
            Unknown::Q1 => (*known, known + v * h),
        };
        let momentum = |known: &SVector<S, N>, v: &SVector<S, N>| {
            let (q0, q1) = ends(known, v);
            let momenta = self.by.objects(&q0, &q1).momenta();
            match given {
                Given::P0 => momenta.p0,
                Given::P1 => momenta.p1,
            }
        };
        let equation = Alone {
            kernel: |known: &SVector<S, N>, v: &SVector<S, N>| {
                let (q0, q1) = ends(known, v);
                let k = self.legendre(&q0, &q1);
                let matrix = match (unknown, given) {
                    (Unknown::Q0, Given::P0) => k.p0_by_q0 * -h,
                    (Unknown::Q0, Given::P1) => k.p1_by_q0 * -h,
                    (Unknown::Q1, Given::P0) => k.p0_by_q1 * h,
                    (Unknown::Q1, Given::P1) => k.p1_by_q1 * h,
                };
                StepKernel { p0: momentum(known, v), matrix }
            },
            momentum,
            inertia: |known: &SVector<S, N>, v: &SVector<S, N>| {
                self.by.system.lagrangian_derivatives(known, v).d22
            },
        };
        let start = guess.copied().unwrap_or_else(nalgebra::zero);
        let v = newton::root(&equation, &State { q: *known, p: *p }, h, start)?;
        let (q0, q1) = ends(known, &v);
        Ok(match unknown {
            Unknown::Q0 => q0,
            Unknown::Q1 => q1,
        })
    }
}
