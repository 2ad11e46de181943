//! All that the paper defines on a family S_k, held against a trajectory.

use core::fmt;

use nalgebra::SVector;

use super::lemma::Definition;
use super::printed::EquationValue;
use super::residual::{MomentumMagnitudes, Outcome, Worst, line, tolerance_line};
use super::{HamiltonJacobi, HamiltonJacobiError, section};
use crate::numbers::Scalar;
use crate::step::{Discrete, invert};
use crate::system::ScalarField;
use crate::theory::objects::del_residual;

/// The paper's statements about a family S_k, each with its residual on a trajectory q_0, …, q_K.
///
/// If the trajectory solves the forced discrete Euler–Lagrange equations, all of them are claimed to hold
/// together; they do where the net force f_d⁺(q_{j−1}, q_j) + f_d⁻(q_j, q_{j+1}) is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedReport<const N: usize> {
    /// Forced discrete Euler–Lagrange equation of the trajectory itself: if it fails, the rest says little.
    pub trajectory: Outcome<N>,
    /// Net force f_d⁺(q_{j−1}, q_j) + f_d⁻(q_j, q_{j+1}) at the nodes.
    pub net_force: Outcome<N>,
    /// γ⁻(q_j, q_{j+1}) = p_j.
    pub gamma_minus: Outcome<N>,
    /// γ⁺(q_j, q_{j+1}) = p_{j+1}.
    pub gamma_plus: Outcome<N>,
    /// (F_d^H)^{γ⁻}(q_{j−1}, q_j) = q_j.
    pub flow_gamma_minus: Outcome<N>,
    /// (F_d^H)^{γ⁺}(q_{j−1}, q_j) = q_{j+1}.
    pub flow_gamma_plus: Outcome<N>,
    /// F̃_d^H ∘ γ = γ ∘ (F_d^H)^γ, first half: the momentum that the flow gives against γ⁻ at the pair it
    /// leads to.
    pub gamma_related_minus: Outcome<N>,
    /// F̃_d^H ∘ γ = γ ∘ (F_d^H)^γ, second half: against γ⁺.
    pub gamma_related_plus: Outcome<N>,
    /// The right Hamilton–Jacobi equation.
    pub right_equation: Outcome<N>,
    /// The left Hamilton–Jacobi equation.
    pub left_equation: Outcome<N>,
    /// S_{j+1} − S_j = L_d, what both are if no configuration is eliminated from H_d^±.
    pub action_increment: Outcome<N>,
    /// The lemma's definition of 𝓕⁺ at x = q_{j+1}.
    pub lemma_plus: Outcome<N>,
    /// The lemma's definition of 𝓕⁻ at x = q_{j+1}.
    pub lemma_minus: Outcome<N>,
    /// Forced discrete Euler–Lagrange equation at q_j if 𝓕⁺ is taken literally: solved, and put for q_{j+1}.
    pub lemma_plus_forced: Outcome<N>,
    /// The unforced one, D2 L_d(q_{j−1}, q_j) + D1 L_d(q_j, 𝓕⁺) = 0.
    pub lemma_plus_unforced: Outcome<N>,
    /// Forced discrete Euler–Lagrange equation at q_j with 𝓕⁻ put for q_{j+1}.
    pub lemma_minus_forced: Outcome<N>,
    /// The theorem's 𝓕^←(q_j, q_{j+1}) = q_{j−1}.
    pub backward_flow: Outcome<N>,
    /// Relative tolerance used.
    pub relative: f64,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// Evaluates the paper's Hamilton–Jacobi theory as printed, S_k = `family[k]` on q_k =
    /// `configurations[k]`.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::TooFewPoints`] for fewer than three configurations,
    /// [`HamiltonJacobiError::FamilyLength`] if there are fewer functions than configurations. What
    /// cannot be evaluated is an error in its own field.
    pub fn as_printed<F: ScalarField<N, Scalar = S>>(
        &self,
        family: &[F],
        configurations: &[SVector<S, N>],
    ) -> Result<PrintedReport<N>, HamiltonJacobiError> {
        require_lengths(family.len(), configurations.len(), 3)?;
        let mut report = Gathering::new(self.relative);
        for (j, pair) in configurations.windows(2).enumerate() {
            let s = [&family[j], &family[j + 1]];
            self.at_step(j, |theory| theory.on_segment(&mut report, j, s, [&pair[0], &pair[1]]))?;
        }
        for (j, q) in configurations.windows(3).enumerate() {
            let s = [&family[j], &family[j + 1], &family[j + 2]];
            self.at_node(&mut report, j + 1, s, [&q[0], &q[1], &q[2]])?;
        }
        Ok(report.report(self.relative))
    }

    /// γ^± and both equations on (q_j, q_{j+1}).
    fn on_segment<F>(
        &self,
        report: &mut Gathering<N>,
        j: usize,
        [s0, s1]: [&F; 2],
        [q0, q1]: [&SVector<S, N>; 2],
    ) where
        F: ScalarField<N, Scalar = S>,
    {
        let k = self.legendre(q0, q1);
        let size = MomentumMagnitudes::of(&k, q0, q1);
        let gamma = self.gamma(s0, s1, q0, q1);
        let magnitude = size.p0 + section::magnitude(s0, q0);
        let terms = gamma.p0.abs() + size.p0;
        report.gamma_minus.vector(j, q0, &(gamma.p0 - k.momenta.p0), &terms, &magnitude);
        let magnitude = size.p1 + section::magnitude(s1, q1);
        let terms = gamma.p1.abs() + size.p1;
        report.gamma_plus.vector(j, q0, &(gamma.p1 - k.momenta.p1), &terms, &magnitude);
        match self.right_equation(s0, s1, q0, q1) {
            Ok(EquationValue { value, magnitude }) => {
                report.right_equation.number(j, q0, value, magnitude, magnitude);
            }
            Err(error) => report.right_equation.failure(error.at_step(j)),
        }
        match self.left_equation(s0, s1, q0, q1) {
            Ok(EquationValue { value, magnitude }) => {
                report.left_equation.number(j, q0, value, magnitude, magnitude);
            }
            Err(error) => report.left_equation.failure(error.at_step(j)),
        }
        let EquationValue { value, magnitude } = self.action_increment(s0, s1, q0, q1);
        report.action_increment.number(j, q0, value, magnitude, magnitude);
    }

    /// The flows, at q_j with both neighbours.
    fn at_node<F>(
        &self,
        report: &mut Gathering<N>,
        j: usize,
        [s0, s1, s2]: [&F; 3],
        [q0, q1, q2]: [&SVector<S, N>; 3],
    ) -> Result<(), HamiltonJacobiError>
    where
        F: ScalarField<N, Scalar = S>,
    {
        let (before, f_plus) = self.at_step(j - 1, |theory| {
            let objects = theory.by.objects(q0, q1);
            (objects.legendre(), objects.force().plus)
        })?;
        let (after, f_minus) = self.in_step(j, |theory| {
            let objects = theory.by.objects(q1, q2);
            (objects.legendre(), objects.force().minus)
        });
        let (size_before, size) =
            (MomentumMagnitudes::of(&before, q0, q1), MomentumMagnitudes::of(&after, q1, q2));
        let node = size_before.p1 + size.p0;
        report.trajectory.vector(j, q1, &(before.momenta.p1 - after.momenta.p0), &node, &node);
        report.net_force.vector(j, q1, &(f_plus + f_minus), &node, &node);

        let of_s1 = section::magnitude(s1, q1);
        match (invert(&before.p0_by_q1), invert(&after.p0_by_q1)) {
            (Ok(by_p_before), Ok(by_p)) => match self
                .in_step(j - 1, |theory| theory.paired_flow(s0, s1, q0, q1))
            {
                Ok(flow) => {
                    let reach = by_p_before.abs() * (size_before.p0 + section::magnitude(s0, q0));
                    let terms = q1.abs() + flow.minus.q.abs();
                    report.flow_gamma_minus.vector(j, q1, &(flow.minus.q - q1), &terms, &(q1.abs() + reach));
                    let there = self.in_step(j, |theory| theory.gamma(s1, s2, &flow.minus.q, &flow.plus.q));
                    let magnitude = size_before.p1
                        + section::magnitude(s1, &flow.minus.q)
                        + before.p1_by_q1.abs() * reach
                        + size.p0;
                    let terms = size_before.p1 + there.p0.abs();
                    report.gamma_related_minus.vector(j, q1, &(flow.minus.p - there.p0), &terms, &magnitude);

                    let reach = by_p.abs() * (size.p0 + of_s1);
                    let terms = q2.abs() + flow.plus.q.abs();
                    report.flow_gamma_plus.vector(j, q1, &(flow.plus.q - q2), &terms, &(q2.abs() + reach));
                    let magnitude =
                        size.p1 + section::magnitude(s2, &flow.plus.q) + after.p1_by_q1.abs() * reach;
                    let terms = size.p1 + there.p1.abs();
                    report.gamma_related_plus.vector(j, q1, &(flow.plus.p - there.p1), &terms, &magnitude);
                }
                Err(error) => report.flows_failed(error.at_step(j)),
            },
            (Err(cause), _) | (_, Err(cause)) => {
                report.flows_failed(super::ImplicitEquation::Derivative.at(j)(cause));
            }
        }

        let ends = q1.abs() + q2.abs();
        match self.in_step(j, |theory| theory.lemma_definition_plus(s2, q1, q2)) {
            Ok(Definition { residual, magnitude }) => {
                report.lemma_plus.vector(j, q1, &residual, &ends, &magnitude);
            }
            Err(error) => report.lemma_plus.failure(error.at_step(j)),
        }
        match self.in_step(j, |theory| theory.lemma_definition_minus(s1, q1, q2)) {
            Ok(Definition { residual, magnitude }) => {
                report.lemma_minus.vector(j, q1, &residual, &ends, &magnitude);
            }
            Err(error) => report.lemma_minus.failure(error.at_step(j)),
        }
        let guess = self.mean_velocity(q1, q2);
        let forced = |x: &SVector<S, N>| self.in_step(j - 1, |theory| del_residual(&theory.by, q0, q1, x));
        match self.in_step(j, |theory| theory.lemma_flow_plus(s2, q1, Some(&guess))) {
            Ok(x) => {
                report.lemma_plus_forced.vector(j, q1, &forced(&x), &node, &node);
                let unforced = self.in_step(j - 1, |theory| theory.unforced_residual(q0, q1, &x));
                report.lemma_plus_unforced.vector(j, q1, &unforced, &node, &node);
            }
            Err(error) => {
                report.lemma_plus_forced.failure(error.at_step(j));
                report.lemma_plus_unforced.failure(error.at_step(j));
            }
        }
        match self.in_step(j, |theory| theory.lemma_flow_minus(s1, q1, Some(&guess))) {
            Ok(x) => report.lemma_minus_forced.vector(j, q1, &forced(&x), &node, &node),
            Err(error) => report.lemma_minus_forced.failure(error.at_step(j)),
        }
        let back = self.in_step(j, |theory| theory.backward_flow(s1, s2, q1, q2));
        match (back, invert(&before.p1_by_q0)) {
            (Ok(x), Ok(by_p)) => {
                let magnitude = q0.abs() + by_p.abs() * (size_before.p1 + of_s1 + size.p0);
                report.backward_flow.vector(j, q1, &(x - q0), &(x.abs() + q0.abs()), &magnitude);
            }
            (Err(error), _) => report.backward_flow.failure(error.at_step(j)),
            (_, Err(cause)) => {
                report.backward_flow.failure(super::ImplicitEquation::Derivative.at(j)(cause));
            }
        }
        Ok(())
    }

    /// D2 L_d(q0, q1) + D1 L_d(q1, q2), the second a step later.
    pub(super) fn unforced_residual(
        &self,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
        q2: &SVector<S, N>,
    ) -> SVector<S, N> {
        self.by.objects(q0, q1).lagrangian_derivatives().d2
            + self.in_step(1, |theory| theory.by.objects(q1, q2).lagrangian_derivatives().d1)
    }
}

/// Fails unless there are `needed` configurations and a member of the family for each.
pub(super) fn require_lengths(
    family: usize,
    configurations: usize,
    needed: usize,
) -> Result<(), HamiltonJacobiError> {
    if configurations < needed {
        return Err(HamiltonJacobiError::TooFewPoints { needed, found: configurations });
    }
    if family < configurations {
        return Err(HamiltonJacobiError::FamilyLength { needed: configurations, found: family });
    }
    Ok(())
}

/// One row for each statement: the field, and how a table names it.
macro_rules! statements {
    ($($field:ident: $name:literal),+ $(,)?) => {
        struct Gathering<const N: usize> {
            $($field: Worst<N>,)+
        }

        impl<const N: usize> Gathering<N> {
            fn new(relative: f64) -> Self {
                Self { $($field: Worst::new(relative),)+ }
            }

            fn report(self, relative: f64) -> PrintedReport<N> {
                PrintedReport { $($field: self.$field.outcome(),)+ relative }
            }
        }

        impl<const N: usize> fmt::Display for PrintedReport<N> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                writeln!(f, "Hamilton–Jacobi theory as printed, on a trajectory")?;
                $(line(f, $name, &self.$field)?;)+
                tolerance_line(f, self.relative)
            }
        }
    };
}

statements! {
    trajectory: "forced discrete Euler–Lagrange equation",
    net_force: "net force f⁺(q_{j−1}, q_j) + f⁻(q_j, q_{j+1}) = 0",
    gamma_minus: "γ⁻(q_j, q_{j+1}) = DS_j − f⁻ = p_j",
    gamma_plus: "γ⁺(q_j, q_{j+1}) = DS_{j+1} + f⁺ = p_{j+1}",
    flow_gamma_minus: "(F_d^H)^{γ⁻}(q_{j−1}, q_j) = q_j",
    flow_gamma_plus: "(F_d^H)^{γ⁺}(q_{j−1}, q_j) = q_{j+1}",
    gamma_related_minus: "F̃_d^H ∘ γ = γ ∘ (F_d^H)^γ, first half",
    gamma_related_plus: "F̃_d^H ∘ γ = γ ∘ (F_d^H)^γ, second half",
    right_equation: "right equation S_{j+1} − S_j − γ⁺·q_{j+1} + H⁺ = 0",
    left_equation: "left equation S_{j+1} − S_j + γ⁻·q_j + H⁻ = 0",
    action_increment: "the same, q not eliminated: S_{j+1} − S_j = L_d",
    lemma_plus: "lemma, definition of 𝓕⁺ at q_{j+1}",
    lemma_minus: "lemma, definition of 𝓕⁻ at q_{j+1}",
    lemma_plus_forced: "lemma, forced Euler–Lagrange equation with 𝓕⁺",
    lemma_plus_unforced: "lemma, unforced Euler–Lagrange equation with 𝓕⁺",
    lemma_minus_forced: "lemma, forced Euler–Lagrange equation with 𝓕⁻",
    backward_flow: "theorem, 𝓕^←(q_j, q_{j+1}) = q_{j−1}",
}

impl<const N: usize> Gathering<N> {
    fn flows_failed(&mut self, error: HamiltonJacobiError) {
        for worst in [
            &mut self.flow_gamma_minus,
            &mut self.flow_gamma_plus,
            &mut self.gamma_related_minus,
            &mut self.gamma_related_plus,
        ] {
            worst.failure(error);
        }
    }
}
