//! The objects of the theory on one segment.

use crate::numbers::{Derivatives, Scalar};
use crate::step::defect;
use crate::step::{
    Defect, DiscreteForce, DiscreteForceDerivatives, LegendreDerivatives, Momenta, Segment, StepError,
};
use crate::system::VectorField;

/// The discrete objects on one segment: L_d, f_d and both momenta, with their derivatives.
///
/// [`Discrete::on`](crate::step::Discrete::on) gives them, solved for where the rule has points within the
/// segment. None is looked at for numbers that are not finite:
/// [`DiscreteSegment`](crate::step::DiscreteSegment) does.
pub trait DiscreteObjects<S: Scalar, const N: usize> {
    /// The segment.
    fn segment(&self) -> &Segment<S, N>;

    /// L_d(q0, q1, h).
    fn discrete_lagrangian(&self) -> S;

    /// L_d with D1, D2, D11, D12, D22.
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] where points within the segment have no derivatives by its ends.
    fn discrete_lagrangian_derivatives(&self) -> Result<Derivatives<S, N>, StepError>;

    /// f_d = (f_d⁻, f_d⁺), of the Rayleigh function and the general force together; 0 where the system has
    /// neither.
    ///
    /// # Errors
    /// Those of [`discrete_lagrangian_derivatives`](Self::discrete_lagrangian_derivatives).
    fn discrete_force(&self) -> Result<DiscreteForce<S, N>, StepError>;

    /// f_d with its derivatives by q0 and q1.
    ///
    /// # Errors
    /// Those of [`discrete_lagrangian_derivatives`](Self::discrete_lagrangian_derivatives).
    fn discrete_force_derivatives(&self) -> Result<DiscreteForceDerivatives<S, N>, StepError>;

    /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
    fn momenta(&self) -> Momenta<S, N>;

    /// Energy on the segment: E_L at the points and velocities that the rule sees.
    fn energy(&self) -> S;

    /// Both momenta with their derivatives by q0 and q1.
    ///
    /// # Errors
    /// Those of [`discrete_lagrangian_derivatives`](Self::discrete_lagrangian_derivatives).
    fn legendre_derivatives(&self) -> Result<LegendreDerivatives<S, N>, StepError> {
        let l = self.discrete_lagrangian_derivatives()?;
        Ok(LegendreDerivatives::from_terms(&l, &self.discrete_force_derivatives()?))
    }

    /// The [`Defect`] of the segment along `xi`, and the sizes of the terms that each part is the sum of: NaN
    /// where one is lost to underflow.
    ///
    /// # Errors
    /// Those of [`discrete_lagrangian_derivatives`](Self::discrete_lagrangian_derivatives).
    fn defect(&self, xi: &dyn VectorField<N, Scalar = S>) -> Result<(Defect<S>, Defect<S>), StepError> {
        let (l, f) = (self.discrete_lagrangian_derivatives()?, self.discrete_force()?);
        let segment = self.segment();
        Ok(defect::at_the_ends(&l, &f, [&xi.vector(&segment.q0), &xi.vector(&segment.end())]))
    }

    /// Whether `xi` carries the force into itself: the components of ι_ξ df_d, with the sizes of their terms,
    /// handed to `component` one by one; at each stage those of ι_ξ df_L where the rule has interior points.
    ///
    /// # Errors
    /// Those of [`discrete_lagrangian_derivatives`](Self::discrete_lagrangian_derivatives).
    fn force_contraction(
        &self,
        xi: &dyn VectorField<N, Scalar = S>,
        component: &mut dyn FnMut(S, S),
    ) -> Result<(), StepError> {
        let f = self.discrete_force_derivatives()?;
        let segment = self.segment();
        defect::contraction(&f, [&xi.vector(&segment.q0), &xi.vector(&segment.end())], component);
        Ok(())
    }
}
