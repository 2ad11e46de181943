//! Second derivatives of a step, contracted with a covector.
//!
//! With λ = (λ_q, λ_p) at (q1, p1), and multipliers μ_i of the stages' equations r_i = ∂L/∂v(Q_i, V_i) − P_i
//! that make λ·(q1, p1) + Σ μ_i·r_i stationary in the velocities, second derivatives of the stages themselves
//! drop out:
//!
//! ```text
//! Jᵀ μ = −∂(λ·(q1, p1))/∂V,   γ_i = h b_i λ_p − h Σ_j a_ji μ_j
//! ∂²(λ·(q1, p1)) = Σ_i D_iᵀ ∂²[μ_i·∂L/∂v + γ_i·G](Q_i, V_i, u) D_i,   D_i = ∂(Q_i, V_i, u)
//! ```
//!
//! Third derivatives of L and R appear contracted alone.

use core::array;

use nalgebra::{SMatrix, SVector};

use super::Gauss;
use super::linearised::StageVector;
use super::segment::SolvedSegment;
use super::tangent::{ByState, Source, Tangent};
use crate::numbers::{Hessian, Scalar};
use crate::step::{DiscreteSecondOrder, State, StepError, StepHessian};
use crate::system::{ForcedLagrangian, SecondOrder};

/// ∂²[μ_i·∂L/∂v + γ_i·G] at each stage.
type Curvatures<T, const N: usize, const M: usize, const S: usize> = [Hessian<T, N, M>; S];

impl<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>
    SolvedSegment<'_, L, N, S>
{
    /// Of `covector`·(q1, p1).
    fn curvatures<const M: usize>(&self, covector: &State<T, N>) -> Curvatures<T, N, M, S>
    where
        L: SecondOrder<N, M>,
    {
        let Self { problem, locals, .. } = self;
        let steps = &problem.steps;
        let slope: StageVector<T, N, S> = array::from_fn(|j| {
            let own = (covector.q + locals[j].rate_by_v.tr_mul(&covector.p)) * steps[j];
            (0..S).fold(own, |sum, i| {
                sum + locals[i].rate_by_q.tr_mul(&covector.p) * (steps[i] * problem.share(i, j))
            })
        });
        let multipliers = self.factored.solve_transposed(&slope.map(|slope| -slope));
        let rates: StageVector<T, N, S> = array::from_fn(|i| {
            (0..S).fold(covector.p * steps[i], |sum, j| sum - multipliers[j] * problem.share(j, i))
        });
        let points = self.at_stages(|_, q, v| (*q, *v));
        array::from_fn(|i| {
            let ((q, v), rate, zero) = (&points[i], &rates[i], SVector::zeros());
            problem.system.later(problem.elapsed(i), |system| {
                let l = system.lagrangian_along(q, v, rate, &multipliers[i]);
                if !L::IS_FORCED {
                    return l;
                }
                l + system.rayleigh_along(q, v, &zero, rate) * -T::one() + system.force_along(q, v, rate)
            })
        })
    }

    /// How the step follows the input, where there is one.
    fn by_held_input<const M: usize>(&self) -> Result<Tangent<T, N, S, M>, StepError>
    where
        L: SecondOrder<N, M>,
    {
        let rate = self.at_stages(|system, q, v| system.force_slope_by_input(q, v));
        self.tangent(&Source { rate, ..Source::none() })
    }

    /// Of `covector`·(q1, p1) by (q0, p0, u).
    fn hessian<const M: usize>(&self, covector: &State<T, N>) -> Result<StepHessian<T, N, M>, StepError>
    where
        L: SecondOrder<N, M>,
    {
        let ByState { q, p } = self.by_state()?;
        let curvatures = self.curvatures(covector);
        let all = pulled_back(&curvatures, &q, &p, &self.by_held_input()?);
        Ok(StepHessian { qq: all.d11, qp: all.d12, pp: all.d22, qu: all.d1u, pu: all.d2u, uu: all.duu })
    }
}

/// D_aᵀ ∂² D_b, summed over the stages: the part by (q, v).
fn block<T: Scalar, const N: usize, const M: usize, const S: usize, const A: usize, const B: usize>(
    curvatures: &Curvatures<T, N, M, S>,
    a: &Tangent<T, N, S, A>,
    b: &Tangent<T, N, S, B>,
) -> SMatrix<T, A, B> {
    curvatures.iter().enumerate().fold(SMatrix::zeros(), |sum, (i, c)| {
        sum + a.q[i].tr_mul(&(c.d11 * b.q[i] + c.d12 * b.v[i]))
            + a.v[i].tr_mul(&(c.d12.tr_mul(&b.q[i]) + c.d22 * b.v[i]))
    })
}

/// D_aᵀ ∂²/∂(q, v)∂u, summed over the stages.
fn with_input<T: Scalar, const N: usize, const M: usize, const S: usize, const A: usize>(
    curvatures: &Curvatures<T, N, M, S>,
    a: &Tangent<T, N, S, A>,
) -> SMatrix<T, A, M> {
    curvatures
        .iter()
        .enumerate()
        .fold(SMatrix::zeros(), |sum, (i, c)| sum + a.q[i].tr_mul(&c.d1u) + a.v[i].tr_mul(&c.d2u))
}

/// All second derivatives by two families x and y of directions and by the input.
fn pulled_back<T: Scalar, const N: usize, const M: usize, const S: usize>(
    curvatures: &Curvatures<T, N, M, S>,
    x: &Tangent<T, N, S, N>,
    y: &Tangent<T, N, S, N>,
    u: &Tangent<T, N, S, M>,
) -> Hessian<T, N, M> {
    let of_input = with_input(curvatures, u);
    let directly = curvatures.iter().fold(SMatrix::zeros(), |sum, c| sum + c.duu);
    Hessian {
        d11: block(curvatures, x, x),
        d12: block(curvatures, x, y),
        d22: block(curvatures, y, y),
        d1u: block(curvatures, x, u) + with_input(curvatures, x),
        d2u: block(curvatures, y, u) + with_input(curvatures, y),
        duu: block(curvatures, u, u) + of_input + of_input.transpose() + directly,
    }
}

impl<T, L, const N: usize, const M: usize, const S: usize> DiscreteSecondOrder<Gauss<S>, N, M> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T> + SecondOrder<N, M>,
{
    /// By q0 and p0 at once, from the stages.
    fn hessian(
        at: &SolvedSegment<'_, L, N, S>,
        covector: &State<T, N>,
    ) -> Result<StepHessian<T, N, M>, StepError> {
        at.hessian(covector)
    }
}
