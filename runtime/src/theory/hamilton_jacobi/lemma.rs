//! The lemma's implicitly defined flows 𝓕^±, as printed; and the points where γ⁺ is the plus transform.

use nalgebra::{SMatrix, SVector};

use super::{DiscreteHamiltonian, HamiltonJacobi, HamiltonJacobiError, ImplicitEquation, section};
use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::{Discrete, State, StepError, StepKernel, equation::Alone, invert, newton};
use crate::system::ScalarField;

/// Both sides' difference in a definition of 𝓕^±, with the size of its terms.
#[derive(Clone, Copy)]
pub(super) struct Definition<S, const N: usize> {
    pub(super) residual: SVector<S, N>,
    pub(super) magnitude: SVector<S, N>,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// The lemma's 𝓕⁺(q_{k−1}, q_k), the solution x of its printed definition:
    ///
    /// ```text
    /// x = D2 H_d⁺(q_k, γ⁺(q_k, x)) − f_d⁺(q_k, x) [D2 γ⁺(q_k, x)]⁻¹,     γ⁺(q_k, x) = DS_{k+1}(x) + f_d⁺(q_k, x)
    /// ```
    ///
    /// q_{k−1} does not occur in it. Solved by Newton's method from q_k + h `guess`; its matrix is taken by
    /// central differences, since exact entries would need third derivatives of S and second ones of f_d
    /// (the residual is exact).
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] where the definition, or H_d⁺ in it, has no solution in reach.
    pub fn lemma_flow_plus<F: ScalarField<N, Scalar = S>>(
        &self,
        s1: &F,
        q: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<SVector<S, N>, HamiltonJacobiError> {
        root(|x| self.lemma_definition_plus(s1, q, x), self.start(q, guess), ImplicitEquation::LemmaFlowPlus)
    }

    /// The lemma's 𝓕⁻(q_{k−1}, q_k), the solution x of its printed definition:
    ///
    /// ```text
    /// q_k = f_d⁻(q_k, x) [D_{q_k} γ⁻(q_k, x)]⁻¹ − D2 H_d⁻(x, γ⁻(q_k, x)),     γ⁻(q_k, x) = DS_k(q_k) − f_d⁻(q_k, x)
    /// ```
    ///
    /// D_{q_k} is read as the partial derivative at fixed x, as in the left Hamilton equation that it stands
    /// for.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] where the definition, or H_d⁻ in it, has no solution in reach.
    pub fn lemma_flow_minus<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        q: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<SVector<S, N>, HamiltonJacobiError> {
        root(
            |x| self.lemma_definition_minus(s0, q, x),
            self.start(q, guess),
            ImplicitEquation::LemmaFlowMinus,
        )
    }

    fn start(&self, q: &SVector<S, N>, guess: Option<&SVector<S, N>>) -> SVector<S, N> {
        guess.map_or(*q, |v| q + v * self.by.h)
    }

    /// The point x with γ⁺(q, x) = 𝔽⁺(q, x), that is DS_{k+1}(x) = D2 L_d(q, x): the force drops out.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Implicit`] where it has no solution in reach of q + h `guess`.
    pub(super) fn right_characteristic<F: ScalarField<N, Scalar = S>>(
        &self,
        s1: &F,
        q: &SVector<S, N>,
        guess: Option<&SVector<S, N>>,
    ) -> Result<SVector<S, N>, HamiltonJacobiError> {
        let h = self.by.h;
        let difference = |q: &SVector<S, N>, v: &SVector<S, N>| {
            let x = q + v * h;
            let l = self.by.objects(q, &x).lagrangian_derivatives();
            StepKernel { p0: l.d2 - s1.gradient(&x), matrix: (l.d22 - s1.hessian(&x)) * h }
        };
        let equation = Alone {
            kernel: &difference,
            momentum: |q: &SVector<S, N>, v: &SVector<S, N>| difference(q, v).p0,
            inertia: |q: &SVector<S, N>, v: &SVector<S, N>| self.by.system.lagrangian_derivatives(q, v).d22,
        };
        let start = guess.copied().unwrap_or_else(nalgebra::zero);
        let v = newton::root(&equation, &State { q: *q, p: nalgebra::zero() }, h, start)
            .map_err(ImplicitEquation::RightCharacteristic.at(0))?;
        Ok(q + v * h)
    }

    /// x − (right side of the definition of 𝓕⁺).
    pub(super) fn lemma_definition_plus<F: ScalarField<N, Scalar = S>>(
        &self,
        s1: &F,
        q: &SVector<S, N>,
        x: &SVector<S, N>,
    ) -> Result<Definition<S, N>, HamiltonJacobiError> {
        let f = self.by.objects(q, x).force_derivatives();
        let p1 = s1.gradient(x) + f.plus.value;
        let h_plus = self.discrete_hamiltonian_plus(q, &p1, Some(&self.mean_velocity(q, x)))?;
        let by_x = invert(&(s1.hessian(x) + f.plus.d2)).map_err(ImplicitEquation::Derivative.at(0))?;
        let shift = by_x.tr_mul(&f.plus.value);
        let rounding = section::magnitude(s1, x) + f.plus.value.abs() + f.plus.d1.abs() * q.abs();
        let residual = x - h_plus.d2 + shift;
        Ok(Definition { residual, magnitude: magnitude(x, &h_plus, &by_x, &shift, &rounding) })
    }

    /// q − (right side of the definition of 𝓕⁻).
    pub(super) fn lemma_definition_minus<F: ScalarField<N, Scalar = S>>(
        &self,
        s0: &F,
        q: &SVector<S, N>,
        x: &SVector<S, N>,
    ) -> Result<Definition<S, N>, HamiltonJacobiError> {
        let f = self.by.objects(q, x).force_derivatives();
        let p0 = s0.gradient(q) - f.minus.value;
        let h_minus = self.discrete_hamiltonian_minus(x, &p0, Some(&self.mean_velocity(q, x)))?;
        let by_q = invert(&(s0.hessian(q) - f.minus.d1)).map_err(ImplicitEquation::Derivative.at(0))?;
        let shift = by_q.tr_mul(&f.minus.value);
        let rounding = section::magnitude(s0, q) + f.minus.value.abs() + f.minus.d2.abs() * x.abs();
        let residual = q - shift + h_minus.d2;
        Ok(Definition { residual, magnitude: magnitude(q, &h_minus, &by_q, &shift, &rounding) })
    }
}

/// The size of the terms of a definition, with the `rounding` of the momentum that H_d^± and the `shift` by
/// the force are taken at; `slope` is that of the shift.
fn magnitude<S: Scalar, const N: usize>(
    at: &SVector<S, N>,
    hamiltonian: &DiscreteHamiltonian<S, N>,
    slope: &SMatrix<S, N, N>,
    shift: &SVector<S, N>,
    rounding: &SVector<S, N>,
) -> SVector<S, N> {
    at.abs()
        + hamiltonian.d2.abs()
        + shift.abs()
        + (hamiltonian.eliminated_by_p.abs() + slope.abs().transpose()) * rounding
}

/// Newton's method needs a few iterations where it converges at all.
const MAX_ITERATIONS: u32 = 60;

/// Halvings of a correction before its direction is given up.
const MAX_HALVINGS: u32 = 30;

/// A residual of at most this many roundings of its terms is a root once it has stopped falling.
const ROUNDINGS: f64 = 4096.0;

/// The root of a definition whose derivative is not at hand.
fn root<S: Scalar, const N: usize>(
    definition: impl Fn(&SVector<S, N>) -> Result<Definition<S, N>, HamiltonJacobiError>,
    start: SVector<S, N>,
    equation: ImplicitEquation,
) -> Result<SVector<S, N>, HamiltonJacobiError> {
    let at = equation.at(0);
    let mut x = start;
    let mut here = definition(&x)?;
    for iteration in 0..MAX_ITERATIONS {
        let matrix = differences(&definition, &x)?;
        let correction = matrix
            .solve(&here.residual)
            .map_err(|singular| at(StepError::SingularNewtonMatrix { iteration, column: singular.column }))?;
        let mut share = S::one();
        let mut moved = false;
        for _ in 0..MAX_HALVINGS {
            let candidate = x - correction * share;
            // H_d^± may not exist at a trial point: that point is too far.
            if let Ok(next) = definition(&candidate)
                && next.residual.amax() < here.residual.amax()
            {
                (x, here, moved) = (candidate, next, true);
                break;
            }
            share *= S::constant(0.5);
        }
        if !moved {
            let floor = here.magnitude.amax() * S::EPSILON;
            let residual = here.residual.amax();
            return if residual <= floor * S::constant(ROUNDINGS) {
                Ok(x)
            } else {
                Err(at(StepError::NoRealSolution { iteration, residual: residual.widen() }))
            };
        }
    }
    Err(at(StepError::NotConverged {
        iterations: MAX_ITERATIONS,
        residual: here.residual.amax().widen(),
        floor: (here.magnitude.amax() * S::EPSILON).widen(),
    }))
}

/// Derivative of the residual by central differences, at the step that balances truncation and rounding.
fn differences<S: Scalar, const N: usize>(
    definition: impl Fn(&SVector<S, N>) -> Result<Definition<S, N>, HamiltonJacobiError>,
    x: &SVector<S, N>,
) -> Result<SMatrix<S, N, N>, HamiltonJacobiError> {
    let width = S::EPSILON.cbrt() * (S::one() + x.amax());
    let mut matrix = SMatrix::<S, N, N>::zeros();
    for j in 0..N {
        let (mut before, mut after) = (*x, *x);
        before[j] -= width;
        after[j] += width;
        let column = (definition(&after)?.residual - definition(&before)?.residual) / (after[j] - before[j]);
        matrix.set_column(j, &column);
    }
    Ok(matrix)
}
