//! Derivatives of a step by its input and by parameters.
//!
//! Both act at the stages: an input moves G by ∂f/∂u, a parameter ∂L/∂v by ∂²L/∂v∂θ and G by ∂²L/∂q∂θ −
//! ∂²R/∂v∂θ + ∂f/∂θ. Between given ends p0 moves too, by −K01 ∂q1/∂θ, so that q1 stays.

use core::array;

use nalgebra::{SMatrix, SVector};

use super::segment::Segment;
use super::tangent::{ByState, Source, Tangent};
use super::{Gauss, nan, solved_segment};
use crate::numbers::{Scalar, lanes::lane};
use crate::step::{
    DiscreteDriven, DiscreteParameters, Linearization, MomentaBy, State, StateBy, Step, StepError,
};
use crate::system::{Driven, ForcedLagrangian, Parameters};

impl<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize> Segment<'_, L, N, S> {
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

    /// The derivatives of the momenta at fixed (q0, q1), from a tangent at fixed (q0, p0).
    fn momenta_by<const K: usize>(&self, by: &Tangent<T, N, S, K>) -> Result<MomentaBy<T, N, K>, StepError> {
        let ByState { p, .. } = self.by_state()?;
        let p0 = -(crate::step::invert(&p.end.q)? * by.end.q);
        Ok(MomentaBy { p0, p1: by.end.p + p.end.p * p0 })
    }

    fn driven<const M: usize>(&self) -> Result<Linearization<T, N, M>, StepError>
    where
        L: Driven<N, M>,
    {
        Ok(Linearization { a: self.by_state()?.matrix(), b: self.by_input()?.end })
    }
}

fn unsolved<T: Scalar, const N: usize, const K: usize>() -> MomentaBy<T, N, K> {
    MomentaBy { p0: SMatrix::repeat(nan()), p1: SMatrix::repeat(nan()) }
}

impl<T, L, const N: usize, const M: usize, const S: usize> DiscreteDriven<Gauss<S>, N, M> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T> + Driven<N, M>,
{
    /// NaN where the segment has no solution that Newton's method finds.
    fn momenta_by_input(&self, q0: &SVector<T, N>, v: &SVector<T, N>, h: T) -> MomentaBy<T, N, M> {
        let solved = Segment::<'_, L, N, S>::new(self, q0, v, h);
        solved.and_then(|segment| segment.momenta_by(&segment.by_input()?)).unwrap_or_else(|_| unsolved())
    }

    fn linearization_with_input(
        &self,
        q0: &SVector<T, N>,
        q1: &SVector<T, N>,
        h: T,
    ) -> Result<Linearization<T, N, M>, StepError> {
        Segment::<'_, L, N, S>::between(self, q0, q1, h)?.driven()
    }

    /// By the stages of the step itself.
    fn linearized_step_with_input(
        &self,
        state: &State<T, N>,
        h: T,
        guess: Option<&SVector<T, N>>,
    ) -> Result<(Step<T, N>, Linearization<T, N, M>), StepError> {
        let (step, segment) = solved_segment::<_, _, N, S>(self, state, h, guess)?;
        Ok((step, segment.driven()?))
    }
}

impl<T, L, const N: usize, const P: usize, const S: usize> DiscreteParameters<Gauss<S>, N, P> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T> + Parameters<N, P>,
{
    /// NaN where the segment has no solution that Newton's method finds.
    fn momenta_by_parameters(&self, q0: &SVector<T, N>, v: &SVector<T, N>, h: T) -> MomentaBy<T, N, P> {
        let solved = Segment::<'_, L, N, S>::new(self, q0, v, h);
        solved
            .and_then(|segment| segment.momenta_by(&segment.by_parameters()?))
            .unwrap_or_else(|_| unsolved())
    }

    fn state_by_parameters(
        &self,
        q0: &SVector<T, N>,
        q1: &SVector<T, N>,
        h: T,
    ) -> Result<StateBy<T, N, P>, StepError> {
        Ok(Segment::<'_, L, N, S>::between(self, q0, q1, h)?.by_parameters()?.end)
    }

    /// By the stages of the step itself.
    fn step_by_parameters(
        &self,
        state: &State<T, N>,
        h: T,
        guess: Option<&SVector<T, N>>,
    ) -> Result<(Step<T, N>, StateBy<T, N, P>), StepError> {
        let (step, segment) = solved_segment::<_, _, N, S>(self, state, h, guess)?;
        Ok((step, segment.by_parameters()?.end))
    }
}
