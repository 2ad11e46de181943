//! The discrete objects on a solved segment.

use super::segment::{SolvedSegment, Variations};
use super::{defect, force};
use crate::numbers::{Derivatives, Scalar, lanes::lane};
use crate::step::{
    Defect, DiscreteForce, DiscreteForceDerivatives, DiscreteObjects, LegendreDerivatives, Momenta, Segment,
    StepError,
};
use crate::system::{ForcedLagrangian, VectorField};

impl<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize> DiscreteObjects<T, N>
    for SolvedSegment<'_, L, N, S>
{
    fn segment(&self) -> &Segment<T, N> {
        &self.segment
    }

    /// L_d = h Σ b_i L.
    fn discrete_lagrangian(&self) -> T {
        let stages = self.locals.iter().zip(&self.problem.steps);
        stages.fold(nalgebra::zero(), |sum: T, (local, &step)| sum + local.lagrangian * step)
    }

    fn discrete_lagrangian_derivatives(&self) -> Result<Derivatives<T, N>, StepError> {
        let (variations, force) = (self.variations()?, self.discrete_force_derivatives()?);
        Ok(Derivatives {
            value: self.discrete_lagrangian(),
            d1: self.slope(&variations.minus),
            d2: self.slope(&variations.plus),
            d11: -variations.p0_by_q0 - force.minus.d1,
            d12: -variations.p0_by_q1 - force.minus.d2,
            d22: variations.plus.end.p - force.plus.d2,
        })
    }

    fn discrete_force(&self) -> Result<DiscreteForce<T, N>, StepError> {
        if L::IS_FORCED { Ok(self.force(&self.variations()?)) } else { Ok(DiscreteForce::zero()) }
    }

    fn discrete_force_derivatives(&self) -> Result<DiscreteForceDerivatives<T, N>, StepError> {
        force::derivatives(self)
    }

    fn momenta(&self) -> Momenta<T, N> {
        let p0 = self.problem.p0.value;
        let change = self.weighted(|local| local.rate());
        Momenta { p0, p1: p0 + change }
    }

    /// Σ b_i E_L(Q_i, V_i).
    fn energy(&self) -> T {
        let sum = (0..S).fold(nalgebra::zero(), |sum: T, i| {
            let local = &self.locals[i];
            sum + (lane(&self.v, i).dot(&local.momentum) - local.lagrangian) * self.problem.steps[i]
        });
        sum / self.problem.h
    }

    fn legendre_derivatives(&self) -> Result<LegendreDerivatives<T, N>, StepError> {
        let Variations { minus, plus, p0_by_q0, p0_by_q1 } = self.variations()?;
        let (p1_by_q0, p1_by_q1) = (minus.end.p, plus.end.p);
        Ok(LegendreDerivatives { momenta: self.momenta(), p0_by_q0, p0_by_q1, p1_by_q0, p1_by_q1 })
    }

    fn defect(&self, xi: &dyn VectorField<N, Scalar = T>) -> Result<(Defect<T>, Defect<T>), StepError> {
        defect::at_the_stages(self, xi)
    }

    fn force_contraction(
        &self,
        xi: &dyn VectorField<N, Scalar = T>,
        component: &mut dyn FnMut(T, T),
    ) -> Result<(), StepError> {
        defect::force_contraction(self, xi, component);
        Ok(())
    }
}
