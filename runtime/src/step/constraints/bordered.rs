//! The equation of a step with the constraints in it.

use nalgebra::{SMatrix, SVector};

use super::complement::Complement;
use super::independent::Independent;
use super::rows::Rows;
use crate::numbers::{Factored, Scalar};
use crate::step::Segment;
use crate::system::{Constrained, sizes};

/// The rounding of the reactions that lead from p0 `without` to p0 `with` them: where a system hangs at rest
/// they cancel forces of which nothing is left in p.
pub(super) fn rounding_of_reactions<S: Scalar, const N: usize>(
    without: &SVector<S, N>,
    with: &SVector<S, N>,
) -> SVector<S, N> {
    (without - with).abs() * (S::EPSILON * S::constant(4.0))
}

/// G(q0)ᵀ, M constraints on a segment and the Schur complement S, with a Newton matrix W.
///
/// F = r − G(q0)ᵀκ, κ = S⁻¹(∂c/∂v̄ W⁻¹r − c), has the same root with W and the constraints of another
/// segment: S goes with them.
#[derive(Clone, Copy, Debug)]
pub struct Bordered<S: Scalar, const N: usize, const M: usize> {
    directions: SMatrix<S, N, M>,
    rows: Rows<S, N, M>,
    complement: Complement<S, M>,
}

impl<S: Scalar, const N: usize, const M: usize> Bordered<S, N, M> {
    /// With W `factored`; nothing if an entry is not finite.
    pub(super) fn of<L>(
        system: &L,
        segment: &Segment<S, N>,
        directions: SMatrix<S, N, M>,
        factored: &impl Factored<S, N>,
    ) -> Option<Self>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        let rows = Rows::on(system, segment);
        let answers = factored.solve_columns(&directions);
        // Copies: what another function sees has a place of its own, out of which each step would move it.
        let independent = || Independent::of(&{ rows.gradients }, &{ directions }, &{ answers });
        let complement = Complement::of(&(rows.gradients * answers), independent)?;
        Some(Self { directions, rows, complement })
    }

    /// κ of what is `left` without constraints on the segment itself.
    pub(super) fn multipliers(&self, factored: &impl Factored<S, N>, left: &SVector<S, N>) -> SVector<S, M> {
        self.multipliers_by(factored, left, &self.rows.values)
    }

    fn multipliers_by(
        &self,
        factored: &impl Factored<S, N>,
        left: &SVector<S, N>,
        values: &SVector<S, M>,
    ) -> SVector<S, M> {
        self.complement.solve(&(self.rows.gradients * factored.solve(left) - values))
    }

    /// F on the segment itself.
    pub(super) fn residual(&self, factored: &impl Factored<S, N>, left: &SVector<S, N>) -> SVector<S, N> {
        left - self.directions * self.multipliers(factored, left)
    }

    /// F on the segment itself with κ refined once: rounded as the reactions are, whatever S is like.
    pub(super) fn refined(&self, factored: &impl Factored<S, N>, left: &SVector<S, N>) -> SVector<S, N> {
        self.refined_by(factored, *left, &self.rows.values)
    }

    fn refined_by(
        &self,
        factored: &impl Factored<S, N>,
        left: SVector<S, N>,
        values: &SVector<S, M>,
    ) -> SVector<S, N> {
        let once = left - self.directions * self.multipliers_by(factored, &left, values);
        once - self.directions * self.multipliers_by(factored, &once, values)
    }

    /// Sizes of the reactions, Σₖ |Gₖᵢ(q0) κₖ|.
    pub(super) fn reactions(&self, factored: &impl Factored<S, N>, left: &SVector<S, N>) -> SVector<S, N> {
        sizes(&self.directions, &self.multipliers(factored, left))
    }

    /// Whether more than rounding is left of a constraint on another segment.
    pub(super) fn is_off<L>(&self, system: &L, segment: &Segment<S, N>) -> bool
    where
        L: Constrained<N, M, Scalar = S>,
    {
        self.rows.is_off_on(system, segment)
    }

    /// W⁻¹G(q0)ᵀS⁻¹c on the segment itself; nothing where rounding explains c.
    pub(super) fn correction(&self, factored: &impl Factored<S, N>) -> Option<SVector<S, N>> {
        let values = &self.rows.values;
        self.rows.is_off().then(|| factored.solve(&(self.directions * self.complement.solve(values))))
    }

    /// A correction of v̄ without what leads off the constraints.
    pub(super) fn along(&self, factored: &impl Factored<S, N>, correction: &SVector<S, N>) -> SVector<S, N> {
        let kappa = self.complement.solve(&(self.rows.gradients * correction));
        correction - factored.solve(&(self.directions * kappa))
    }

    /// F on another segment, with κ refined once.
    pub(super) fn residual_near<L>(
        &self,
        system: &L,
        segment: &Segment<S, N>,
        factored: &impl Factored<S, N>,
        left: SVector<S, N>,
    ) -> SVector<S, N>
    where
        L: Constrained<N, M, Scalar = S>,
    {
        self.refined_by(factored, left, &self.rows.values(system, segment))
    }
}
