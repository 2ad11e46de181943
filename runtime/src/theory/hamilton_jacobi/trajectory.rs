//! The paper's sections along one trajectory, where S_k is the discrete action of the trajectory itself.

use core::fmt;

use nalgebra::SVector;

use super::residual::{MomentumMagnitudes, Outcome, Worst, line, tolerance_line};
use super::{HamiltonJacobi, HamiltonJacobiError, PrintedAndCorrected};
use crate::numbers::Scalar;
use crate::step::Discrete;

/// The sections γ^± along one trajectory, for the two readings of DS_k and for the paper's example.
///
/// With n_k = f_d⁺(q_{k−1}, q_k) + f_d⁻(q_k, q_{k+1}), the net force at the node:
///
/// ```text
/// DS_k := D2 L_d(q_{k−1}, q_k)      γ⁺ = p_{k+1} always,     γ⁻ = p_k − n_k
/// DS_k := −D1 L_d(q_k, q_{k+1})     γ⁻ = p_k always,         γ⁺ = p_k + n_k  (at q_k)
/// γ⁻ := D1 G_d, S_d^k and S_d^{k+1} the actions along the trajectory, as in the paper's example:    γ⁻ = p_k − 2 n_k
/// ```
///
/// "Printed" is γ = p, "corrected" is γ = p with the multiple of n_k. Both readings agree iff n_k = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectoryReport<const N: usize> {
    /// Forced discrete Euler–Lagrange equation of the trajectory; the corrected forms suppose it.
    pub trajectory: Outcome<N>,
    /// Net force n_k against 0.
    pub net_force: Outcome<N>,
    /// γ⁺ with DS_k := D2 L_d(q_{k−1}, q_k): the right equation's reading.
    pub right_plus: Outcome<N>,
    /// γ⁻ with the same DS_k.
    pub right_minus: PrintedAndCorrected<N>,
    /// γ⁻ with DS_k := −D1 L_d(q_k, q_{k+1}): the left equation's reading.
    pub left_minus: Outcome<N>,
    /// γ⁺ at q_k with the same DS_k.
    pub left_plus: PrintedAndCorrected<N>,
    /// The example's γ⁻ = D1 G_d = 2 D2 L_d(q_{k−1}, q_k) + D1 L_d(q_k, q_{k+1}) − f_d⁻(q_k, q_{k+1}).
    pub example_minus: PrintedAndCorrected<N>,
    /// Relative tolerance used.
    pub relative: f64,
}

impl<S, L, R, const N: usize> HamiltonJacobi<'_, L, R, N>
where
    S: Scalar,
    L: Discrete<R, N, Scalar = S>,
{
    /// Evaluates γ^± along one trajectory, S_k being its own discrete action.
    ///
    /// # Errors
    /// [`HamiltonJacobiError::TooFewPoints`] for fewer than three configurations.
    pub fn along_trajectory(
        &self,
        configurations: &[SVector<S, N>],
    ) -> Result<TrajectoryReport<N>, HamiltonJacobiError> {
        if configurations.len() < 3 {
            return Err(HamiltonJacobiError::TooFewPoints { needed: 3, found: configurations.len() });
        }
        let new = || Worst::new(self.relative);
        let mut plain = [new(), new(), new(), new()];
        let mut pairs = [[new(), new()], [new(), new()], [new(), new()]];
        for (index, q) in configurations.windows(3).enumerate() {
            let (k, [q0, q1, q2]) = (index + 1, [&q[0], &q[1], &q[2]]);
            let (before, f_plus, d2) = self.at_step(index, |theory| {
                let objects = theory.by.objects(q0, q1);
                (objects.legendre(), objects.force().plus, objects.lagrangian_derivatives().d2)
            })?;
            let (after, f_minus, d1) = self.in_step(k, |theory| {
                let objects = theory.by.objects(q1, q2);
                (objects.legendre(), objects.force().minus, objects.lagrangian_derivatives().d1)
            });
            let (p_plus, p_minus) = (before.momenta.p1, after.momenta.p0);
            let net = f_plus + f_minus;
            let magnitude = (MomentumMagnitudes::of(&before, q0, q1).p1
                + MomentumMagnitudes::of(&after, q1, q2).p0
                + net.abs())
                * S::constant(2.0);

            let singles = [p_plus - p_minus, net, d2 + f_plus - p_plus, -d1 - f_minus - p_minus];
            for (worst, residual) in plain.iter_mut().zip(&singles) {
                worst.vector(k, q1, residual, &magnitude, &magnitude);
            }
            let right_minus = d2 - f_minus - p_minus;
            let left_plus = -d1 + f_plus - p_plus;
            let example = d2 * S::constant(2.0) + d1 - f_minus - p_minus;
            let twice = net * S::constant(2.0);
            let misses =
                [[right_minus, right_minus + net], [left_plus, left_plus - net], [example, example + twice]];
            for (pair, miss) in pairs.iter_mut().zip(&misses) {
                pair[0].vector(k, q1, &miss[0], &magnitude, &magnitude);
                pair[1].vector(k, q1, &miss[1], &magnitude, &magnitude);
            }
        }
        let [trajectory, net_force, right_plus, left_minus] = plain.map(Worst::outcome);
        let [right_minus, left_plus, example_minus] = pairs.map(|[printed, corrected]| PrintedAndCorrected {
            printed: printed.outcome(),
            corrected: corrected.outcome(),
        });
        Ok(TrajectoryReport {
            trajectory,
            net_force,
            right_plus,
            right_minus,
            left_minus,
            left_plus,
            example_minus,
            relative: self.relative,
        })
    }
}

impl<const N: usize> fmt::Display for TrajectoryReport<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "sections γ^± along one trajectory; n_k = f⁺(q_{{k−1}}, q_k) + f⁻(q_k, q_{{k+1}})")?;
        line(f, "forced discrete Euler–Lagrange equation", &self.trajectory)?;
        line(f, "net force n_k = 0", &self.net_force)?;
        writeln!(f, "  DS_k := D2 L_d(q_{{k−1}}, q_k)")?;
        line(f, "    γ⁺ = p_{k+1}", &self.right_plus)?;
        line(f, "    γ⁻ = p_k                (printed)", &self.right_minus.printed)?;
        line(f, "    γ⁻ = p_k − n_k          (corrected)", &self.right_minus.corrected)?;
        writeln!(f, "  DS_k := −D1 L_d(q_k, q_{{k+1}})")?;
        line(f, "    γ⁻ = p_k", &self.left_minus)?;
        line(f, "    γ⁺ = p_k                (printed)", &self.left_plus.printed)?;
        line(f, "    γ⁺ = p_k + n_k          (corrected)", &self.left_plus.corrected)?;
        writeln!(f, "  γ⁻ := D1 G_d, actions along the trajectory (example)")?;
        line(f, "    γ⁻ = p_k                (printed)", &self.example_minus.printed)?;
        line(f, "    γ⁻ = p_k − 2 n_k        (corrected)", &self.example_minus.corrected)?;
        tolerance_line(f, self.relative)
    }
}
