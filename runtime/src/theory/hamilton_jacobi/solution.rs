//! Whether a candidate (F_k, γ_k), γ_k or S_k solves the corrected Hamilton–Jacobi problem.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::residual::{MomentumMagnitudes, Outcome, Worst, line, tolerance_line};
use super::{ConfigurationMap, HamiltonJacobi, HamiltonJacobiError, Section, section};
use crate::numbers::{Scalar, linear};
use crate::step::{Discrete, invert};
use crate::system::ScalarField;

/// Whether a candidate is a solution, and if not, by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolutionReport<const N: usize> {
    /// Minus transform, 𝔽⁻(q, F_k(q)) = γ_k(q). Absent where F_k was defined by it.
    pub minus: Option<Outcome<N>>,
    /// Plus transform, 𝔽⁺(q, F_k(q)) = γ_{k+1}(F_k(q)).
    pub plus: Outcome<N>,
    /// Differential of the W-equation, DF_kᵀ(γ_{k+1} − D2 L_d) − γ_k − D1 L_d = f_d⁻ + DF_kᵀ f_d⁺. With the
    /// minus transform and DF_k invertible it is equivalent to the plus transform.
    pub work: Outcome<N>,
    /// The right Hamilton–Jacobi equation with the virtual work on its right side,
    /// S_{k+1}(q1) − S_k(q0) − γ_{k+1}(q1)·q1 + H_d⁺(q0, γ_{k+1}(q1)) = W_k(q0). For generating functions
    /// only.
    pub hamiltonian: Option<Outcome<N>>,
    /// dW_k = 0: the equation without virtual work, that of Ohsawa, Bloch and Leok. No part of the verdict.
    pub no_work: Outcome<N>,
    /// Dγ_k symmetric: the sections are closed.
    pub closed_sections: Outcome<N>,
    /// The pull-back of d f_d by (id, F_k) vanishes: W_k exists locally.
    pub closed_work: Outcome<N>,
    /// Places where DF_k is singular, a caustic of the family: there the W-equation does not give the plus
    /// transform.
    pub singular_maps: usize,
    /// Relative tolerance used.
    pub relative: f64,
}

impl<const N: usize> SolutionReport<N> {
    /// Whether both transforms hold, at finite sections with finite slopes: c_{k+1} = F_k(c_k), p_k =
    /// γ_k(c_k) then solve the forced discrete equations.
    #[must_use]
    pub fn is_solution(&self) -> bool {
        let holds = |outcome: &Outcome<N>| outcome.is_ok_and(|residual| residual.holds());
        self.minus.as_ref().is_none_or(holds) && holds(&self.plus)
    }
}

/// F_k and its derivative at a sample.
struct Image<S, const N: usize> {
    q1: SVector<S, N>,
    derivative: SMatrix<S, N, N>,
    /// The rounding error of q1, in units of ε.
    spread: SVector<S, N>,
}

struct Gathering<const N: usize> {
    minus: Worst<N>,
    plus: Worst<N>,
    work: Worst<N>,
    hamiltonian: Worst<N>,
    no_work: Worst<N>,
    closed_sections: Worst<N>,
    closed_work: Worst<N>,
    singular_maps: usize,
}

impl<const N: usize> Gathering<N> {
    fn new(relative: f64) -> Self {
        let new = || Worst::new(relative);
        Self {
            minus: new(),
            plus: new(),
            work: new(),
            hamiltonian: new(),
            no_work: new(),
            closed_sections: new(),
            closed_work: new(),
            singular_maps: 0,
        }
    }

    fn failure(&mut self, error: HamiltonJacobiError) {
        for worst in
            [&mut self.minus, &mut self.plus, &mut self.work, &mut self.hamiltonian, &mut self.closed_work]
        {
            worst.failure(error);
        }
        self.no_work.failure(error);
    }

    fn report(self, relative: f64, maps: bool, functions: bool) -> SolutionReport<N> {
        SolutionReport {
            minus: maps.then(|| self.minus.outcome()),
            plus: self.plus.outcome(),
            work: self.work.outcome(),
            hamiltonian: functions.then(|| self.hamiltonian.outcome()),
            no_work: self.no_work.outcome(),
            closed_sections: self.closed_sections.outcome(),
            closed_work: self.closed_work.outcome(),
            singular_maps: self.singular_maps,
            relative,
        }
    }
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// Whether sections γ_k are a solution: F_k is defined by the minus transform, the plus transform is
    /// checked.
    ///
    /// Every k is evaluated at every sample q.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::FamilyLength`] for fewer than two sections,
    /// [`HamiltonJacobiError::TooFewPoints`] without samples.
    pub fn check_sections<G>(
        &self,
        sections: &[G],
        samples: &[SVector<S, N>],
    ) -> Result<SolutionReport<N>, HamiltonJacobiError>
    where
        G: Section<N, Scalar = S>,
    {
        let mut report = Gathering::new(self.relative);
        self.for_every_place(sections.len(), 2, samples, |theory, k, q| {
            match theory.image_by_minus(k, &sections[k], q) {
                Ok(image) => theory.check_place(&mut report, k, q, &image, &sections[k], &sections[k + 1]),
                Err(error) => report.failure(error),
            }
        })?;
        Ok(report.report(self.relative, false, false))
    }

    /// Whether maps F_k and sections γ_k are a solution: both transforms are checked.
    ///
    /// # Errors
    /// Those of [`check_sections`](Self::check_sections); there must be a map for every section but the last.
    pub fn check_solution<M, G>(
        &self,
        maps: &[M],
        sections: &[G],
        samples: &[SVector<S, N>],
    ) -> Result<SolutionReport<N>, HamiltonJacobiError>
    where
        M: ConfigurationMap<N, Scalar = S>,
        G: Section<N, Scalar = S>,
    {
        if maps.len() + 1 < sections.len() {
            return Err(HamiltonJacobiError::FamilyLength { needed: sections.len() - 1, found: maps.len() });
        }
        let mut report = Gathering::new(self.relative);
        self.for_every_place(sections.len(), 2, samples, |theory, k, q| {
            let image = Image {
                q1: maps[k].image(q),
                derivative: maps[k].jacobian(q),
                spread: maps[k].image(q).abs() + maps[k].jacobian(q).abs() * q.abs(),
            };
            theory.check_place(&mut report, k, q, &image, &sections[k], &sections[k + 1]);
        })?;
        Ok(report.report(self.relative, true, false))
    }

    /// Whether functions S_k are a solution: γ_k = dS_k, F_k by the minus transform, W_k by
    /// [`virtual_work`](Self::virtual_work).
    ///
    /// # Errors
    /// Those of [`check_sections`](Self::check_sections).
    pub fn check_generating_functions<F: ScalarField<N, Scalar = S>>(
        &self,
        family: &[F],
        samples: &[SVector<S, N>],
    ) -> Result<SolutionReport<N>, HamiltonJacobiError> {
        let mut report = Gathering::new(self.relative);
        self.for_every_place(family.len(), 2, samples, |theory, k, q| {
            match theory.image_by_minus(k, &family[k], q) {
                Ok(image) => {
                    theory.check_place(&mut report, k, q, &image, &family[k], &family[k + 1]);
                    theory.check_hamiltonian(
                        &mut report.hamiltonian,
                        k,
                        q,
                        &image,
                        &family[k],
                        &family[k + 1],
                    );
                }
                Err(error) => report.failure(error),
            }
        })?;
        Ok(report.report(self.relative, false, true))
    }

    fn for_every_place(
        &self,
        family: usize,
        needed: usize,
        samples: &[SVector<S, N>],
        mut check: impl FnMut(&HamiltonJacobi<'_, L, R, N>, usize, &SVector<S, N>),
    ) -> Result<(), HamiltonJacobiError> {
        if family < needed {
            return Err(HamiltonJacobiError::FamilyLength { needed, found: family });
        }
        if samples.is_empty() {
            return Err(HamiltonJacobiError::TooFewPoints { needed: 1, found: 0 });
        }
        for k in 0..family - 1 {
            for q in samples {
                self.at_step(k, |theory| check(theory, k, q))?;
            }
        }
        Ok(())
    }

    /// F_k(q) by 𝔽⁻(q, F_k(q)) = γ_k(q), with DF_k = K01⁻¹ (Dγ_k − K00).
    fn image_by_minus<G>(
        &self,
        step: usize,
        section: &G,
        q: &SVector<S, N>,
    ) -> Result<Image<S, N>, HamiltonJacobiError>
    where
        G: Section<N, Scalar = S>,
    {
        let q1 = self.step(q, &section.covector(q), None).map_err(|error| error.at_step(step))?.q;
        let k = self.legendre(q, &q1);
        let by_p = invert(&k.p0_by_q1).map_err(super::ImplicitEquation::Derivative.at(step))?;
        let size = MomentumMagnitudes::of(&k, q, &q1);
        Ok(Image {
            q1,
            derivative: by_p * (section.jacobian(q) - k.p0_by_q0),
            spread: q1.abs() + by_p.abs() * (size.p0 + section::magnitude(section, q)),
        })
    }

    fn check_place<G>(
        &self,
        report: &mut Gathering<N>,
        step: usize,
        q: &SVector<S, N>,
        image: &Image<S, N>,
        before: &G,
        after: &G,
    ) where
        G: Section<N, Scalar = S>,
    {
        let (q1, df) = (&image.q1, &image.derivative);
        let objects = self.by.objects(q, q1);
        let (k, l, f) = (objects.legendre(), objects.lagrangian_derivatives(), objects.force_derivatives());
        let size = MomentumMagnitudes::of(&k, q, q1);
        let (gamma0, gamma1) = (before.covector(q), after.covector(q1));

        let at_q0 = size.p0 + section::magnitude(before, q) + k.p0_by_q1.abs() * image.spread;
        let spread = (k.p1_by_q1.abs() + after.jacobian(q1).abs()) * image.spread;
        let at_q1 = size.p1 + section::magnitude(after, q1) + spread;
        // The slopes of the sections enter what is forgiven, but not what is compared.
        let terms = size.p0 + gamma0.abs();
        report.minus.vector(step, q, &(k.momenta.p0 - gamma0), &terms, &at_q0);
        let terms = size.p1 + gamma1.abs();
        report.plus.vector(step, q, &(k.momenta.p1 - gamma1), &terms, &at_q1);

        let work = f.minus.value + df.tr_mul(&f.plus.value);
        let magnitude = at_q0 + df.abs().tr_mul(&at_q1);
        let terms = gamma0.abs() + l.d1.abs() + df.abs().tr_mul(&(gamma1.abs() + l.d2.abs()));
        let difference = df.tr_mul(&(gamma1 - l.d2)) - gamma0 - l.d1 - work;
        report.work.vector(step, q, &difference, &terms, &magnitude);
        report.no_work.vector(step, q, &work, &terms, &magnitude);

        let jacobian = before.jacobian(q);
        report.closed_sections.antisymmetric_part(step, q, &jacobian, &jacobian.abs());
        let pulled = f.minus.d1 + f.minus.d2 * df + df.tr_mul(&(f.plus.d1 + f.plus.d2 * df));
        let (size, df_size) = (k.p0_by_q0.abs(), df.abs());
        let magnitude = size
            + k.p0_by_q1.abs() * df_size
            + df_size.tr_mul(&(k.p1_by_q0.abs() + k.p1_by_q1.abs() * df_size));
        report.closed_work.antisymmetric_part(step, q, &pulled, &magnitude);
        report.singular_maps += usize::from(linear::require_regular(df).is_err());
    }

    fn check_hamiltonian<F>(
        &self,
        hamiltonian: &mut Worst<N>,
        step: usize,
        q: &SVector<S, N>,
        image: &Image<S, N>,
        before: &F,
        after: &F,
    ) where
        F: ScalarField<N, Scalar = S>,
    {
        let q1 = &image.q1;
        let gamma1 = after.gradient(q1);
        let work = after.value(q1) - before.value(q) - self.by.objects(q, q1).lagrangian();
        match self.discrete_hamiltonian_plus(q, &gamma1, Some(&self.mean_velocity(q, q1))) {
            Ok(h_plus) => {
                let value = after.value(q1) - before.value(q) - gamma1.dot(q1) + h_plus.value - work;
                let rounding = after.hessian(q1).abs() * image.spread;
                let terms = after.value(q1).abs()
                    + before.value(q).abs()
                    + gamma1.abs().dot(&q1.abs())
                    + h_plus.value.abs();
                let magnitude = terms
                    + gamma1.abs().dot(&image.spread)
                    + rounding.dot(&q1.abs())
                    + h_plus.d1.abs().dot(&q.abs())
                    + work.abs();
                hamiltonian.number(step, q, value, terms, magnitude);
            }
            Err(error) => hamiltonian.failure(error.at_step(step)),
        }
    }
}

impl<const N: usize> fmt::Display for SolutionReport<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.is_solution() { "a solution" } else { "NOT a solution" };
        writeln!(f, "corrected Hamilton–Jacobi problem: {verdict}")?;
        if let Some(minus) = &self.minus {
            line(f, "𝔽⁻(q, F_k(q)) = γ_k(q)", minus)?;
        }
        line(f, "𝔽⁺(q, F_k(q)) = γ_{k+1}(F_k(q))", &self.plus)?;
        line(f, "differential of S_{k+1}∘F_k − S_k = L_d + W_k", &self.work)?;
        if let Some(hamiltonian) = &self.hamiltonian {
            line(f, "S_{k+1} − S_k − γ_{k+1}·q1 + H⁺(q0, γ_{k+1}) = W_k", hamiltonian)?;
        }
        line(f, "γ_k closed", &self.closed_sections)?;
        line(f, "pull-back of d f_d by (id, F_k) = 0: W_k exists", &self.closed_work)?;
        line(f, "dW_k = 0: no virtual work (not part of the verdict)", &self.no_work)?;
        if self.singular_maps > 0 {
            writeln!(f, "  DF_k is singular at {} places: caustics", self.singular_maps)?;
        }
        tolerance_line(f, self.relative)
    }
}
