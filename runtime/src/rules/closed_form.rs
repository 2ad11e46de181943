//! The discrete objects and the derivatives of steps by rules that have formulas, of every system whose step
//! [`Fused`] has.

use super::DisplacementRule;
use crate::numbers::Hessian;
use crate::step::{
    BorderParameters, DiscreteDriven, DiscreteObjects, DiscreteParameters, DiscreteSecondOrder, Fused,
    LinearizedSegment, SolvedForVelocity, State, StateBy, StepError, StepHessian,
};
use crate::system::{Driven, Parameters, SecondOrder};

/// [`ClosedForm`](crate::step::ClosedForm) by the `functions` of a rule.
macro_rules! closed_form {
    ($(#[$doc:meta])* [$($of:tt)*] $rule:ty, $functions:path $(, $system:ident)?) => {
        $(#[$doc])*
        impl<$($of)* L, const N: usize> crate::step::ClosedForm<$rule, N> for L
        where
            L: crate::step::Fused<$rule, N> $(+ crate::system::$system<N>)?,
        {
            fn discrete_lagrangian(&self, segment: &crate::step::Segment<L::Scalar, N>) -> L::Scalar {
                <$rule as $functions>::discrete_lagrangian(self, segment)
            }

            fn discrete_lagrangian_derivatives(
                &self,
                segment: &crate::step::Segment<L::Scalar, N>,
            ) -> crate::numbers::Derivatives<L::Scalar, N> {
                <$rule as $functions>::discrete_lagrangian_derivatives(self, segment)
            }

            fn discrete_force(
                &self,
                segment: &crate::step::Segment<L::Scalar, N>,
            ) -> crate::step::DiscreteForce<L::Scalar, N> {
                <$rule as $functions>::discrete_force(self, segment)
            }

            fn discrete_force_derivatives(
                &self,
                segment: &crate::step::Segment<L::Scalar, N>,
            ) -> crate::step::DiscreteForceDerivatives<L::Scalar, N> {
                <$rule as $functions>::discrete_force_derivatives(self, segment)
            }

            fn segment_energy(&self, segment: &crate::step::Segment<L::Scalar, N>) -> L::Scalar {
                <$rule as $functions>::segment_energy(self, segment)
            }

            fn at_nodes(
                &self,
                segment: &crate::step::Segment<L::Scalar, N>,
                visit: &mut dyn FnMut(&Self, &nalgebra::SVector<L::Scalar, N>, &nalgebra::SVector<L::Scalar, N>),
            ) {
                <$rule as $functions>::at_nodes(self, segment, visit);
            }
        }
    };
}

closed_form! {
    /// By nodes and weights.
    [R: DisplacementRule + SolvedForVelocity,] R, DisplacementRule
}
pub(super) use closed_form;

/// [`DiscreteRayleigh`](crate::step::DiscreteRayleigh) by the `functions` of the rule, for N coordinates, or
/// for so many.
macro_rules! discrete_rayleigh {
    ([$($of:tt)*] $rule:ty, $n:tt, $functions:path) => {
        impl<$($of)*> crate::step::DiscreteRayleigh<$rule, $n> for L
        where
            L: crate::step::Fused<$rule, $n> + crate::system::Rayleigh<$n>,
        {
            fn discrete_rayleigh(&self, segment: &crate::step::Segment<L::Scalar, $n>) -> L::Scalar {
                <$rule as $functions>::discrete_rayleigh(self, segment)
            }

            fn discrete_rayleigh_derivatives(
                &self,
                segment: &crate::step::Segment<L::Scalar, $n>,
            ) -> crate::numbers::Derivatives<L::Scalar, $n> {
                <$rule as $functions>::discrete_rayleigh_derivatives(self, segment)
            }
        }
    };
}

discrete_rayleigh! { [R: DisplacementRule + SolvedForVelocity, L, const N: usize] R, N, DisplacementRule }
pub(super) use discrete_rayleigh;

impl<R, L, const N: usize, const M: usize> DiscreteDriven<R, N, M> for L
where
    R: DisplacementRule + SolvedForVelocity,
    L: Fused<R, N> + Driven<N, M>,
{
    /// Of the general force alone.
    fn by_input(at: &LinearizedSegment<'_, L, R, N>) -> Result<StateBy<L::Scalar, N, M>, StepError> {
        at.answer(&R::force_by_input(at.on.segment(), at.on.system, L::force_by_input))
    }
}

impl<R, L, const N: usize, const P: usize> DiscreteParameters<R, N, P> for L
where
    R: DisplacementRule + SolvedForVelocity,
    L: Fused<R, N, Border: BorderParameters<L, R, N, P>> + Parameters<N, P>,
{
    fn by_parameters(at: &LinearizedSegment<'_, L, R, N>) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        let (system, segment) = (at.on.system, at.on.segment());
        let mut by = R::lagrangian_by_parameters(system, segment);
        if L::HAS_RAYLEIGH {
            by = by + R::rayleigh_by_parameters(system, segment);
        }
        if L::HAS_FORCE {
            by = by + R::force_by_parameters(system, segment);
        }
        at.answer_parameters(&by)
    }
}

impl<R, L, const N: usize, const M: usize> DiscreteSecondOrder<R, N, M> for L
where
    R: DisplacementRule + SolvedForVelocity,
    L: Fused<R, N> + SecondOrder<N, M>,
{
    fn hessian(
        at: &LinearizedSegment<'_, L, R, N>,
        covector: &State<L::Scalar, N>,
    ) -> Result<StepHessian<L::Scalar, N, M>, StepError> {
        let (system, segment) = (at.on.system, at.on.segment());
        let by_input = R::force_by_input(segment, system, L::force_slope_by_input);
        Ok(at.k.step_hessian(&at.q_by_p, &by_input.p0, covector, |along| {
            let mut hessian: Hessian<L::Scalar, N, M> = R::lagrangian_along(system, segment, along);
            if L::HAS_RAYLEIGH {
                hessian = hessian + R::rayleigh_along(system, segment, along);
            }
            if L::HAS_FORCE {
                hessian = hessian + R::force_along(system, segment, along);
            }
            hessian
        }))
    }
}
