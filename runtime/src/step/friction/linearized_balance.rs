//! The derivatives of places at which friction bears the forces.
//!
//! ```text
//! (K dq − ∂F/∂v dv̄)_Y + d(D s) = 0        K = −∂F/∂q + ∂(D s)/∂q, du(q, v) = 0 of what sticks
//! ```

use nalgebra::{SMatrix, SVector};

use super::balanced::{Balanced, OF_FORCES};
use super::end::forces;
use super::line::Line;
use super::sliding::direction_of;
use super::state::State;
use crate::numbers::Scalar;
use crate::step::StepError;
use crate::step::massless::Massless;
use crate::system::{DryFriction, DryFrictionParameters, Parameters};

/// The balance at the end of a step, linearised.
pub(super) struct LinearizedBalance<S: Scalar, const N: usize, const M: usize> {
    light: Massless<N>,
    /// Half of h.
    half: S,
    /// The places, v with the velocities of others in it, those at which F is, and s.
    q: SVector<S, N>,
    v: SVector<S, N>,
    of_forces: SVector<S, N>,
    forces: SVector<S, M>,
    line: Line<S, N, M>,
    /// K, and −∂F/∂v, in rows of Y.
    by_q: SMatrix<S, N, N>,
    by_v: SMatrix<S, N, N>,
    /// ∂u/∂v, ∂u/∂q, and Σ D ∂s/∂u where a length slides.
    slip_by_v: SMatrix<S, M, N>,
    slip_by_q: SMatrix<S, M, N>,
    turning: SMatrix<S, N, M>,
}

impl<S: Scalar, const N: usize, const M: usize> LinearizedBalance<S, N, M> {
    /// Of the places at the end of a step of 2 `half`, with F at the velocities `of_forces`.
    ///
    /// # Errors
    /// [`StepError::AtLimitOfFriction`], [`StepError::SingularNewtonMatrix`].
    #[cold]
    #[inline(never)]
    pub(super) fn of<L>(
        system: &L,
        light: &Massless<N>,
        half: S,
        at: &Balanced<S, N, M>,
        of_forces: &SVector<S, N>,
    ) -> Result<Self, StepError>
    where
        L: DryFriction<N, M, Scalar = S>,
    {
        let Balanced { q, v, held } = at;
        let of_forces = light.without(of_forces);
        let acting = forces(system, q, &of_forces);
        let slips = system.slips(q, v);
        let directions = light.rows(&direction_of(&slips, S::constant(OF_FORCES))?);
        let terms = slips.by_velocity.abs() * v.abs() + system.slips(q, &nalgebra::zero()).values.abs();
        let mut state = State::of(L::ELEMENTS, &slips.values, &directions, &terms);
        (state.forces, state.sticks) = (held.forces, held.sticks);
        state.require_off_edge(L::ELEMENTS)?;
        let mut by_q = -acting.d1;
        if !L::IS_UNIFORM {
            by_q += system.slip_curvature(q, &held.forces);
        }
        // By the velocity of Y, which moves places by half of h.
        let rows = light.columns(&(slips.by_velocity + slips.by_configuration * half));
        let matrix = light.block(&(by_q * half + state.turning * rows));
        Ok(Self {
            light: *light,
            half,
            q: *q,
            v: *v,
            of_forces,
            forces: held.forces,
            line: Line::of(&matrix, &directions, &rows, &held.sticks)?,
            by_q: light.rows(&by_q),
            by_v: -light.rows(&acting.d2),
            slip_by_v: slips.by_velocity,
            slip_by_q: slips.by_configuration,
            turning: state.turning,
        })
    }

    /// dq1, from those of q0, of q1 without this balance, of the velocities at which F is, and of what moves
    /// the balance and the slips by themselves.
    pub(super) fn by<const K: usize>(
        &self,
        (q0, q1): (&SMatrix<S, N, K>, &SMatrix<S, N, K>),
        of_forces: &SMatrix<S, N, K>,
        moved: &MovedBalance<S, N, M, K>,
    ) -> SMatrix<S, N, K> {
        let half = S::constant(0.5);
        let from = self.light.without(q1) + self.light.rows(&((q0 + q1) * half));
        let others = self.light.without(&(q1 - q0)) * (half / self.half);
        let slip = self.slip_by_v * others + self.slip_by_q * from + moved.slip;
        let pushed = self.by_v * self.light.without(of_forces) + moved.balance + self.turning * slip;
        let balance = self.by_q * from + self.light.rows(&pushed);
        let v = self.line.solve(&-balance, &self.line.left(&-slip));
        from + self.light.rows(&v) * self.half
    }

    /// Asks where the balance is.
    pub(super) fn at<T>(&self, asked: impl Fn(&SVector<S, N>, &SVector<S, N>) -> T) -> T {
        asked(&self.q, &self.of_forces)
    }

    /// The moves by parameters at fixed (q, v).
    pub(super) fn by_parameters<L, const P: usize>(&self, system: &L) -> MovedBalance<S, N, M, P>
    where
        L: DryFrictionParameters<N, M, P, Scalar = S> + Parameters<N, P>,
    {
        let (q, v) = (&self.q, &self.of_forces);
        let acting = system.lagrangian_by_parameters(q, v).d1 + system.force_by_parameters(q, v);
        let by = system.slips_by_parameters(q, &self.v, &self.forces);
        MovedBalance { balance: by.force - acting, slip: by.values }
    }
}

/// Moves of the balance −F + D s and its slips.
pub(super) struct MovedBalance<S, const N: usize, const M: usize, const K: usize> {
    pub(super) balance: SMatrix<S, N, K>,
    pub(super) slip: SMatrix<S, M, K>,
}

impl<S: Scalar, const N: usize, const M: usize, const K: usize> MovedBalance<S, N, M, K> {
    pub(super) fn none() -> Self {
        Self { balance: nalgebra::zero(), slip: nalgebra::zero() }
    }
}
