//! The forced discrete Hamilton equations on a segment: as the paper prints them, and corrected.

use core::fmt;

use nalgebra::SVector;

use super::residual::{MomentumMagnitudes, Outcome, Worst, line, tolerance_line};
use super::{HamiltonJacobi, HamiltonJacobiError};
use crate::numbers::Scalar;
use crate::step::{Discrete, DiscreteRayleigh};

/// One equation in two forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedAndCorrected<const N: usize> {
    /// The residual of the equation as the paper prints it.
    pub printed: Outcome<N>,
    /// The residual of the corrected equation.
    pub corrected: Outcome<N>,
}

/// The forced discrete Hamilton equations along a sequence of configurations.
///
/// ```text
///               printed                                    corrected
/// right, a   [q1 − D2 H_d⁺] ∂p1/∂q1 = −f_d⁺             the same
/// right, b   p0 = D1 H_d⁺ − f_d⁻                        p0 = D1 H_d⁺ − f_d⁻ − (∂q1/∂q0|p1)ᵀ f_d⁺
/// left, a    [q0 + D2 H_d⁻] ∂p0/∂q0 = f_d⁻              the same
/// left, b    p1 = −D1 H_d⁻ + f_d⁺                       p1 = −D1 H_d⁻ + f_d⁺ + (∂q0/∂q1|p0)ᵀ f_d⁻
/// ```
///
/// Here p0, p1 are the momenta of the segment by 𝔽^±, and H_d^± is a function of its two arguments alone: q1
/// (q0) is eliminated through the **forced** transform. Since q1 then moves with q0 at fixed p1, the force
/// f_d⁺ at q1 enters D1 H_d⁺ as well; that term is missing in the printed second equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HamiltonEquationsReport<const N: usize> {
    /// [q1 − D2 H_d⁺] ∂p1/∂q1 = −f_d⁺.
    pub right_configuration: PrintedAndCorrected<N>,
    /// p0 = D1 H_d⁺ − f_d⁻ …
    pub right_momentum: PrintedAndCorrected<N>,
    /// [q0 + D2 H_d⁻] ∂p0/∂q0 = f_d⁻.
    pub left_configuration: PrintedAndCorrected<N>,
    /// p1 = −D1 H_d⁻ + f_d⁺ …
    pub left_momentum: PrintedAndCorrected<N>,
    /// Relative tolerance used.
    pub relative: f64,
    rayleigh: bool,
}

/// The four equations' residuals being gathered.
struct Equations<const N: usize> {
    printed: [Worst<N>; 4],
    corrected: [Worst<N>; 4],
}

impl<const N: usize> Equations<N> {
    fn new(relative: f64) -> Self {
        Self { printed: [Worst::new(relative); 4], corrected: [Worst::new(relative); 4] }
    }

    fn failure(&mut self, equations: [usize; 2], error: HamiltonJacobiError) {
        for index in equations {
            self.printed[index].failure(error);
            self.corrected[index].failure(error);
        }
    }

    fn take<S: Scalar>(
        &mut self,
        index: usize,
        step: usize,
        q: &SVector<S, N>,
        [printed, corrected]: [SVector<S, N>; 2],
        terms: &SVector<S, N>,
        reach: &SVector<S, N>,
    ) {
        let magnitude = &(terms + reach);
        self.printed[index].vector(step, q, &printed, terms, magnitude);
        self.corrected[index].vector(step, q, &corrected, terms, magnitude);
    }

    fn report(self, relative: f64, rayleigh: bool) -> HamiltonEquationsReport<N> {
        let pair = |index: usize| PrintedAndCorrected {
            printed: self.printed[index].outcome(),
            corrected: self.corrected[index].outcome(),
        };
        HamiltonEquationsReport {
            right_configuration: pair(0),
            right_momentum: pair(1),
            left_configuration: pair(2),
            left_momentum: pair(3),
            relative,
            rayleigh,
        }
    }
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// The residuals of the forced discrete Hamilton equations on every segment of `configurations`.
    ///
    /// They are identities of a segment, so that the configurations need not solve the discrete
    /// Euler–Lagrange equations.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Stopped`].
    pub fn hamilton_equations(
        &self,
        configurations: &[SVector<S, N>],
    ) -> Result<HamiltonEquationsReport<N>, HamiltonJacobiError> {
        let mut equations = Equations::new(self.relative);
        for (step, pair) in configurations.windows(2).enumerate() {
            self.at_step(step, |theory| theory.equations_at(&mut equations, step, &pair[0], &pair[1]))?;
        }
        Ok(equations.report(self.relative, false))
    }

    /// [`hamilton_equations`](Self::hamilton_equations) in the paper's Rayleigh form, with the signs as
    /// printed and corrected.
    ///
    /// ```text
    ///               printed                               corrected
    /// right, a   [q1 − D2 H_d⁺] D2D2 L_d⁻ = −D2 R_d        … = +D2 R_d
    /// right, b   p0 = D1 H_d⁺ + D1 R_d                     p0 = D1 H_d⁺ − D1 R_d + (∂q1/∂q0|p1)ᵀ D2 R_d
    /// left, a    [q0 + D2 H_d⁻] D1D1 L_d⁺ = D1 R_d         … = −D1 R_d
    /// left, b    p1 = −D1 H_d⁻ + D2 R_d                    p1 = −D1 H_d⁻ − D2 R_d + (∂q0/∂q1|p0)ᵀ D1 R_d
    /// ```
    ///
    /// The momenta and H_d^± are those of the whole system: a general force beside R makes even the corrected
    /// forms fail.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::Stopped`].
    pub fn hamilton_equations_rayleigh(
        &self,
        configurations: &[SVector<S, N>],
    ) -> Result<HamiltonEquationsReport<N>, HamiltonJacobiError>
    where
        L: DiscreteRayleigh<R, N>,
    {
        let mut equations = Equations::new(self.relative);
        for (step, pair) in configurations.windows(2).enumerate() {
            self.at_step(step, |theory| {
                theory.equations_rayleigh_at(&mut equations, step, &pair[0], &pair[1])
            })?;
        }
        Ok(equations.report(self.relative, true))
    }

    fn equations_at(
        &self,
        equations: &mut Equations<N>,
        step: usize,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) {
        let zero = SVector::zeros();
        let v = self.mean_velocity(q0, q1);
        let objects = self.by.objects(q0, q1);
        let (k, f) = (objects.legendre(), objects.force());
        let size = MomentumMagnitudes::of(&k, q0, q1);
        let (p0, p1) = (k.momenta.p0, k.momenta.p1);

        match self.discrete_hamiltonian_plus(q0, &p1, Some(&v)) {
            Ok(right) => {
                let a = k.p1_by_q1.tr_mul(&(q1 - right.d2)) + f.plus;
                equations.take(0, step, q0, [a, a], &(size.p1 + f.plus.abs()), &zero);
                let b = p0 - right.d1 + f.minus;
                let moved = right.eliminated_by_q.tr_mul(&f.plus);
                let reach = right.eliminated_by_q.abs().tr_mul(&size.p1);
                equations.take(1, step, q0, [b, b + moved], &(size.p0 + f.minus.abs()), &reach);
            }
            Err(error) => equations.failure([0, 1], error.at_step(step)),
        }
        match self.discrete_hamiltonian_minus(q1, &p0, Some(&v)) {
            Ok(left) => {
                let a = k.p0_by_q0.tr_mul(&(q0 + left.d2)) - f.minus;
                equations.take(2, step, q0, [a, a], &(size.p0 + f.minus.abs()), &zero);
                let b = p1 + left.d1 - f.plus;
                let moved = left.eliminated_by_q.tr_mul(&f.minus);
                let reach = left.eliminated_by_q.abs().tr_mul(&size.p0);
                equations.take(3, step, q0, [b, b - moved], &(size.p1 + f.plus.abs()), &reach);
            }
            Err(error) => equations.failure([2, 3], error.at_step(step)),
        }
    }

    fn equations_rayleigh_at(
        &self,
        equations: &mut Equations<N>,
        step: usize,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) where
        L: DiscreteRayleigh<R, N>,
    {
        let zero = SVector::zeros();
        let v = self.mean_velocity(q0, q1);
        let k = self.legendre(q0, q1);
        let size = MomentumMagnitudes::of(&k, q0, q1);
        let (p0, p1) = (k.momenta.p0, k.momenta.p1);
        let (system, segment) = (self.by.system, &self.by.between(q0, q1));
        let r = system.discrete_rayleigh_derivatives(segment);
        let plus = system.modified_plus_derivatives(segment);
        let minus = system.modified_minus_derivatives(segment);

        match self.discrete_hamiltonian_plus(q0, &p1, Some(&v)) {
            Ok(right) => {
                let a = minus.d22.tr_mul(&(q1 - right.d2));
                equations.take(0, step, q0, [a + r.d2, a - r.d2], &(size.p1 + r.d2.abs()), &zero);
                let b = p0 - right.d1;
                let moved = right.eliminated_by_q.tr_mul(&r.d2);
                let reach = right.eliminated_by_q.abs().tr_mul(&size.p1);
                let corrected = b + r.d1 - moved;
                equations.take(1, step, q0, [b - r.d1, corrected], &(size.p0 + r.d1.abs()), &reach);
            }
            Err(error) => equations.failure([0, 1], error.at_step(step)),
        }
        match self.discrete_hamiltonian_minus(q1, &p0, Some(&v)) {
            Ok(left) => {
                let a = plus.d11.tr_mul(&(q0 + left.d2));
                equations.take(2, step, q0, [a - r.d1, a + r.d1], &(size.p0 + r.d1.abs()), &zero);
                let b = p1 + left.d1;
                let moved = left.eliminated_by_q.tr_mul(&r.d1);
                let reach = left.eliminated_by_q.abs().tr_mul(&size.p0);
                let corrected = b + r.d2 - moved;
                equations.take(3, step, q0, [b - r.d2, corrected], &(size.p1 + r.d2.abs()), &reach);
            }
            Err(error) => equations.failure([2, 3], error.at_step(step)),
        }
    }
}

impl<const N: usize> fmt::Display for HamiltonEquationsReport<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (title, rows) = if self.rayleigh {
            (
                "forced discrete Hamilton equations, Rayleigh form",
                [
                    "[q1 − D2H⁺] D2D2L⁻ = −D2R",
                    "[q1 − D2H⁺] D2D2L⁻ = +D2R",
                    "p0 = D1H⁺ + D1R",
                    "p0 = D1H⁺ − D1R + (∂q1/∂q0|p1)ᵀ D2R",
                    "[q0 + D2H⁻] D1D1L⁺ = D1R",
                    "[q0 + D2H⁻] D1D1L⁺ = −D1R",
                    "p1 = −D1H⁻ + D2R",
                    "p1 = −D1H⁻ − D2R + (∂q0/∂q1|p0)ᵀ D1R",
                ],
            )
        } else {
            (
                "forced discrete Hamilton equations",
                [
                    "[q1 − D2H⁺] ∂p1/∂q1 = −f⁺",
                    "[q1 − D2H⁺] ∂p1/∂q1 = −f⁺",
                    "p0 = D1H⁺ − f⁻",
                    "p0 = D1H⁺ − f⁻ − (∂q1/∂q0|p1)ᵀ f⁺",
                    "[q0 + D2H⁻] ∂p0/∂q0 = f⁻",
                    "[q0 + D2H⁻] ∂p0/∂q0 = f⁻",
                    "p1 = −D1H⁻ + f⁺",
                    "p1 = −D1H⁻ + f⁺ + (∂q0/∂q1|p0)ᵀ f⁻",
                ],
            )
        };
        writeln!(f, "{title}")?;
        let equations =
            [&self.right_configuration, &self.right_momentum, &self.left_configuration, &self.left_momentum];
        for (equation, names) in equations.into_iter().zip(rows.chunks(2)) {
            line(f, &format!("printed    {}", names[0]), &equation.printed)?;
            line(f, &format!("corrected  {}", names[1]), &equation.corrected)?;
        }
        tolerance_line(f, self.relative)
    }
}
