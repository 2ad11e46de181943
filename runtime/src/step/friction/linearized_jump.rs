//! The derivatives of a jump.
//!
//! ```text
//! (K dδ + K dq − ∂F/∂v dv)_Y + d(D s) = 0        K = −∂F/∂q + ∂(D s)/∂q, du(q + δ, δ) = 0 of what sticks
//! ```
//!
//! An element that slides through a step is at its limit at the end of it, by a jump of roundings: it slides
//! there too, from wherever friction bears the forces. One that comes to its limit there alone is at its edge.

use nalgebra::{SMatrix, SVector};

use super::element::{Element, elements};
use super::end::forces;
use super::equation::direction_of;
use super::jump::{Jump, OF_FORCES, slips_of};
use super::line::Line;
use super::linearized::EDGE;
use super::rates::Released;
use crate::numbers::Scalar;
use crate::step::StepError;
use crate::step::massless::Massless;
use crate::system::{DryFriction, DryFrictionParameters, Parameters};

/// The equations of a jump, linearised.
pub(super) struct LinearizedJump<S: Scalar, const N: usize, const M: usize> {
    light: Massless<N>,
    /// The place after it, δ, v and s.
    q: SVector<S, N>,
    by: SVector<S, N>,
    v: SVector<S, N>,
    forces: SVector<S, M>,
    line: Line<S, N, M>,
    /// K, and −∂F/∂v, in rows of Y.
    by_q: SMatrix<S, N, N>,
    by_v: SMatrix<S, N, N>,
    /// ∂u/∂q, and Σ D ∂s/∂u where a length slides.
    slip_by_q: SMatrix<S, M, N>,
    turning: SMatrix<S, N, M>,
}

impl<S: Scalar, const N: usize, const M: usize> LinearizedJump<S, N, M> {
    /// Of the `jump` at (q, v), where elements `slid` along these forces before it.
    ///
    /// # Errors
    /// [`StepError::AtLimitOfFriction`], [`StepError::SingularNewtonMatrix`].
    #[cold]
    #[inline(never)]
    pub(super) fn of<L>(
        system: &L,
        light: &Massless<N>,
        jump: &Jump<S, N, M>,
        v: &SVector<S, N>,
        slid: &SVector<S, M>,
    ) -> Result<Self, StepError>
    where
        L: DryFriction<N, M, Scalar = S>,
    {
        let Jump { q, by, held } = jump;
        let acting = forces(system, q, v);
        let slips = slips_of(system, light, q, by);
        let directions = direction_of(&slips, S::constant(OF_FORCES))?;
        let mut by_q = -acting.d1;
        if !L::IS_UNIFORM {
            by_q += system.slip_curvature(q, &held.forces);
        }
        let at_rest = system.slips(q, &nalgebra::zero()).by_configuration;
        let slip_by_q = slips.by_configuration - at_rest;
        let mut released = Released {
            directions,
            rows: slips.by_velocity + light.columns(&slip_by_q),
            slip: nalgebra::zero(),
            sticks: held.sticks,
        };
        for element in elements(L::ELEMENTS) {
            let is_stuck = element.head(&released.sticks) == Some(true);
            if is_stuck && element.length(&held.forces) > S::one() - S::constant(EDGE) {
                if element.dot(slid, &held.forces) <= S::zero() {
                    return Err(StepError::AtLimitOfFriction { component: element.first });
                }
                element.of_mut(&mut released.sticks).for_each(|stick| *stick = false);
            }
        }
        // A length that slides by roundings turns by none of its own.
        let least = by.amax() * S::EPSILON.sqrt() + q.amax() * (S::EPSILON / S::EPSILON.sqrt());
        let is_rigid = |element: Element| element.length(&slips.values) <= least;
        let mut turning: SMatrix<S, N, M> = nalgebra::zero();
        for element in elements(L::ELEMENTS).filter(|element| element.size > 1 && !is_rigid(*element)) {
            if element.head(&released.sticks) == Some(false) {
                let s = element.part(&held.forces);
                let across = directions - directions * s * s.transpose();
                let own = element.of_mut(&mut turning.data.0).zip(element.of(&across.data.0));
                own.for_each(|(column, across)| {
                    let length = element.length(&slips.values);
                    column.iter_mut().zip(across).for_each(|(entry, across)| *entry = *across / length);
                });
            }
        }
        let bent = turning * released.rows;
        released.release(L::ELEMENTS, &held.forces, is_rigid);
        let matrix = light.block(&(by_q + bent));
        let line = Line::of(&matrix, &released.directions, &released.rows, &released.sticks)?;
        Ok(Self {
            light: *light,
            q: *q,
            by: *by,
            v: *v,
            forces: held.forces,
            line,
            by_q: light.rows(&by_q),
            by_v: -light.rows(&acting.d2),
            slip_by_q,
            turning,
        })
    }

    /// dδ, where q and v move so, and the balance and the slips by themselves.
    pub(super) fn by<const K: usize>(
        &self,
        q: &SMatrix<S, N, K>,
        v: &SMatrix<S, N, K>,
        moved: &MovedJump<S, N, M, K>,
    ) -> SMatrix<S, N, K> {
        let slip = self.slip_by_q * q + moved.slip;
        let balance = self.by_q * q + self.by_v * v + self.light.rows(&(moved.balance + self.turning * slip));
        let stuck = self.line.left(&-slip);
        self.light.rows(&self.line.solve(&-balance, &stuck))
    }

    /// What is asked at the end of the jump.
    pub(super) fn at<T>(&self, asked: impl Fn(&SVector<S, N>, &SVector<S, N>) -> T) -> T {
        asked(&self.q, &self.v)
    }

    /// What parameters move at fixed (q, v).
    pub(super) fn by_parameters<L, const P: usize>(&self, system: &L) -> MovedJump<S, N, M, P>
    where
        L: DryFrictionParameters<N, M, P, Scalar = S> + Parameters<N, P>,
    {
        let acting = system.lagrangian_by_parameters(&self.q, &self.v).d1
            + system.force_by_parameters(&self.q, &self.v);
        let by = system.slips_by_parameters(&self.q, &self.by, &self.forces);
        let at_rest = system.slips_by_parameters(&self.q, &nalgebra::zero(), &self.forces);
        MovedJump { balance: by.force - acting, slip: by.values - at_rest.values }
    }
}

/// What moves the balance −F + D s of a jump and its slips.
pub(super) struct MovedJump<S, const N: usize, const M: usize, const K: usize> {
    pub(super) balance: SMatrix<S, N, K>,
    pub(super) slip: SMatrix<S, M, K>,
}

impl<S: Scalar, const N: usize, const M: usize, const K: usize> MovedJump<S, N, M, K> {
    pub(super) fn none() -> Self {
        Self { balance: nalgebra::zero(), slip: nalgebra::zero() }
    }
}
