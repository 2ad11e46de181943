//! The paper's section 4 as printed, for one family S_k: sections, flows, equations, generating function.
//!
//! Index convention: on the segment (q_j, q_{j+1}) the functions S_j and S_{j+1} are used, `s0` and `s1`
//! below.

use nalgebra::SVector;

use super::{HamiltonJacobi, HamiltonJacobiError};
use crate::numbers::Scalar;
use crate::step::{Discrete, DiscreteRayleigh, Momenta, State};
use crate::system::ScalarField;

/// The image of (q_{j−1}, q_j) under F̃_d^H ∘ γ, a point of T*(Q×Q): its two halves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PairedFlow<S, const N: usize> {
    /// F_d^H(γ⁻(q_{j−1}, q_j)); its configuration is (F_d^H)^{γ⁻}(q_{j−1}, q_j).
    pub(super) minus: State<S, N>,
    /// F_d^H(γ⁺(q_{j−1}, q_j)); its configuration is (F_d^H)^{γ⁺}(q_{j−1}, q_j).
    pub(super) plus: State<S, N>,
}

/// The left side of a Hamilton–Jacobi equation, 0 where it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EquationValue<S> {
    /// The left side.
    pub(super) value: S,
    /// The sum of the sizes of its terms.
    pub(super) magnitude: S,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// γ = Φ⁻¹(γ⁻, γ⁺) as printed: γ⁻ = DS_j(q_j) − f_d⁻ (`p0`) and γ⁺ = DS_{j+1}(q_{j+1}) + f_d⁺ (`p1`).
    #[must_use]
    pub fn gamma<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        s1: &F,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) -> Momenta<S, N> {
        let f = self.by.objects(q0, q1).force();
        Momenta { p0: s0.gradient(q0) - f.minus, p1: s1.gradient(q1) + f.plus }
    }

    /// F̃_d^H ∘ γ as printed; the configurations of the two halves are (F_d^H)^γ = ((F_d^H)^{γ⁻},
    /// (F_d^H)^{γ⁺}).
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] if the step from one of the momenta has no solution.
    pub(super) fn paired_flow<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        s1: &F,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) -> Result<PairedFlow<S, N>, HamiltonJacobiError> {
        let gamma = self.gamma(s0, s1, q0, q1);
        let guess = self.mean_velocity(q0, q1);
        Ok(PairedFlow {
            minus: self.step(q0, &gamma.p0, Some(&guess))?,
            plus: self.in_step(1, |theory| theory.step(q1, &gamma.p1, Some(&guess)))?,
        })
    }

    /// The forced right discrete Hamilton–Jacobi equation as printed,
    /// S_{j+1}(q_{j+1}) − S_j(q_j) − γ⁺·q_{j+1} + H_d⁺(q_j, γ⁺) = 0.
    ///
    /// H_d⁺ is the function of its two arguments: its q_{j+1} comes from 𝔽⁺ and γ⁺, not from the points
    /// given.
    ///
    /// # Errors
    /// Those of [`discrete_hamiltonian_plus`](Self::discrete_hamiltonian_plus).
    pub(super) fn right_equation<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        s1: &F,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) -> Result<EquationValue<S>, HamiltonJacobiError> {
        let p1 = self.gamma(s0, s1, q0, q1).p1;
        let h_plus = self.discrete_hamiltonian_plus(q0, &p1, Some(&self.mean_velocity(q0, q1)))?;
        let EquationValue { value, magnitude } = increment(s0, s1, q0, q1);
        let reach = p1.abs().dot(&(q1.abs() + h_plus.eliminated.abs())) + h_plus.d1.abs().dot(&q0.abs());
        Ok(EquationValue {
            value: value - p1.dot(q1) + h_plus.value,
            magnitude: magnitude + reach + h_plus.value.abs(),
        })
    }

    /// The forced left discrete Hamilton–Jacobi equation as printed,
    /// S_{j+1}(q_{j+1}) − S_j(q_j) + γ⁻·q_j + H_d⁻(q_{j+1}, γ⁻) = 0.
    ///
    /// H_d⁻ is the function of its two arguments, its q_j eliminated through 𝔽⁻. If it is not, as in the
    /// paper's example, γ⁻ drops out and [`action_increment`](Self::action_increment) is what is left.
    ///
    /// # Errors
    /// Those of [`discrete_hamiltonian_minus`](Self::discrete_hamiltonian_minus).
    pub(super) fn left_equation<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        s1: &F,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) -> Result<EquationValue<S>, HamiltonJacobiError> {
        let p0 = self.gamma(s0, s1, q0, q1).p0;
        let h_minus = self.discrete_hamiltonian_minus(q1, &p0, Some(&self.mean_velocity(q0, q1)))?;
        let EquationValue { value, magnitude } = increment(s0, s1, q0, q1);
        let reach = p0.abs().dot(&(q0.abs() + h_minus.eliminated.abs())) + h_minus.d1.abs().dot(&q1.abs());
        Ok(EquationValue {
            value: value + p0.dot(q0) + h_minus.value,
            magnitude: magnitude + reach + h_minus.value.abs(),
        })
    }

    /// S_{j+1}(q_{j+1}) − S_j(q_j) − L_d(q_j, q_{j+1}): what both equations say when no configuration is
    /// eliminated from H_d^±. It holds no γ at all, so that along one trajectory it is the recursion that
    /// defines the discrete action.
    #[must_use]
    pub(super) fn action_increment<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        s1: &F,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) -> EquationValue<S> {
        let l = self.by.objects(q0, q1).lagrangian_derivatives();
        let EquationValue { value, magnitude } = increment(s0, s1, q0, q1);
        EquationValue {
            value: value - l.value,
            magnitude: magnitude + l.value.abs() + l.d1.abs().dot(&q0.abs()) + l.d2.abs().dot(&q1.abs()),
        }
    }

    /// The theorem's 𝓕^← = π_Q ∘ 𝔽⁻ ∘ (𝔽⁺)⁻¹ ∘ γ⁻: (q_j, q_{j+1}) ↦ q_{j−1}, as printed.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] if 𝔽⁺(q_{j−1}, q_j) = (q_j, γ⁻) has no solution in reach.
    pub(super) fn backward_flow<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        s1: &F,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) -> Result<SVector<S, N>, HamiltonJacobiError> {
        let gamma = self.gamma(s0, s1, q0, q1);
        self.a_step_before(|theory| theory.backward_step(q0, &gamma.p0, Some(&self.mean_velocity(q0, q1))))
    }

    /// G_d(q_j, q_{j+1}) = S_j(q_j) + S_{j+1}(q_{j+1}) − R_d(q_j, q_{j+1}) of a Rayleigh system, so that γ =
    /// DG_d.
    ///
    /// For functions S_j of one point D1 G_d and D2 G_d are the γ^± of [`gamma`](Self::gamma). The paper's
    /// example puts the discrete action of a trajectory for S_j and S_{j+1}; then D1 G_d differentiates
    /// S_{j+1} too, and [`along_trajectory`](Self::along_trajectory) shows by how much it misses.
    #[must_use]
    pub fn generating_function<F>(&self, s0: &F, s1: &F, q0: &SVector<S, N>, q1: &SVector<S, N>) -> S
    where
        F: ScalarField<N, Scalar = S>,
        L: DiscreteRayleigh<R, N>,
    {
        s0.value(q0) + s1.value(q1) - self.by.system.discrete_rayleigh(&self.by.between(q0, q1))
    }
}

/// S_{j+1}(q_{j+1}) − S_j(q_j), what every equation starts with.
fn increment<S: Scalar, F: ScalarField<N, Scalar = S>, const N: usize>(
    s0: &F,
    s1: &F,
    q0: &SVector<S, N>,
    q1: &SVector<S, N>,
) -> EquationValue<S> {
    let (before, after) = (s0.value(q0), s1.value(q1));
    EquationValue { value: after - before, magnitude: after.abs() + before.abs() }
}
