//! Derivatives of a step by its input and by parameters.
//!
//! Both act at the stages: an input moves G by ∂f/∂u, a parameter ∂L/∂v by ∂²L/∂v∂θ and G by ∂²L/∂q∂θ −
//! ∂²R/∂v∂θ + ∂f/∂θ.

use core::array;

use nalgebra::SVector;

use super::Gauss;
use super::segment::SolvedSegment;
use super::tangent::{Source, Tangent};
use crate::numbers::{Scalar, lanes::lane};
use crate::step::{DiscreteDriven, DiscreteParameters, StateBy, StepError};
use crate::system::{Driven, ForcedLagrangian, Parameters};

impl<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>
    SolvedSegment<'_, L, N, S>
{
    /// Evaluates `of` at every stage, on the system at the stage's own time.
    pub(super) fn at_stages<X>(&self, of: impl Fn(&L, &SVector<T, N>, &SVector<T, N>) -> X) -> [X; S] {
        let q = self.problem.configurations(&self.v);
        array::from_fn(|i| {
            let (q, v) = (lane(&q, i), lane(&self.v, i));
            self.problem.system.later(self.problem.elapsed(i), |system| of(system, &q, &v))
        })
    }

    /// How the step follows the input.
    pub(super) fn by_input<const M: usize>(&self) -> Result<Tangent<T, N, S, M>, StepError>
    where
        L: Driven<N, M>,
    {
        let rate = self.at_stages(|system, q, v| system.force_by_input(q, v));
        self.tangent(&Source { rate, ..Source::none() })
    }

    /// How the step follows the parameters.
    pub(super) fn by_parameters<const P: usize>(&self) -> Result<Tangent<T, N, S, P>, StepError>
    where
        L: Parameters<N, P>,
    {
        let gradients = self.at_stages(|system, q, v| system.lagrangian_by_parameters(q, v));
        let mut rate = gradients.map(|l| l.d1);
        if L::IS_FORCED {
            let forces = self.at_stages(|system, q, v| {
                system.force_by_parameters(q, v) - system.rayleigh_by_parameters(q, v).d2
            });
            for (rate, force) in rate.iter_mut().zip(forces) {
                *rate += force;
            }
        }
        self.tangent(&Source { momentum: gradients.map(|l| l.d2), rate, ..Source::none() })
    }
}

impl<T, L, const N: usize, const M: usize, const S: usize> DiscreteDriven<Gauss<S>, N, M> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T> + Driven<N, M>,
{
    fn by_input(at: &SolvedSegment<'_, L, N, S>) -> Result<StateBy<T, N, M>, StepError> {
        Ok(at.by_input()?.end)
    }
}

impl<T, L, const N: usize, const P: usize, const S: usize> DiscreteParameters<Gauss<S>, N, P> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T> + Parameters<N, P>,
{
    fn by_parameters(at: &SolvedSegment<'_, L, N, S>) -> Result<StateBy<T, N, P>, StepError> {
        Ok(at.by_parameters()?.end)
    }
}
