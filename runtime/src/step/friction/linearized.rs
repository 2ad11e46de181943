//! The derivatives of a step with friction that holds.
//!
//! With the derivatives K of the momenta without friction, D = (h/2) F ∂u/∂v column by column, and the
//! elements that stick in the first line, those that stick in the second,
//!
//! ```text
//! dp0 = K00 dq0 + K01 dq1 + d(D s)         du(q̄, v̄) = 0 of what sticks, s = u/|u| where it slides
//! K10 dq0 + K11 dq1 = d ∂L/∂v(q1, v1) + d(D s1)         du(q̄, v1) = 0 of what sticks
//! dp1 = d ∂L/∂v(q1, v1)
//! ```
//!
//! Elements that stick are a border of the equations, as constraints of velocity are. An element at its edge,
//! where the least change makes it slide or stick, has no derivative.

use nalgebra::{SMatrix, SVector};

use super::balanced::at_end;
use super::end::{Middle, balance, by_ends};
use super::equation::at_middle;
use super::line::{Line, leave};
use super::linearized_balance::{LinearizedBalance, MovedBalance};
use super::sliding::direction_of;
use super::state::State;
use crate::numbers::Scalar;
use crate::step::massless::Massless;
use crate::step::{
    ClosedForm, Discrete, LegendreDerivatives, MomentaBy, PhaseMatrix, Segment, StateBy, StepError,
};
use crate::system::{DryFriction, DryFrictionParameters, Parameters, Quantity};

/// The share of friction in the equations on the segment of a step.
pub struct LinearizedFriction<S: Scalar, const N: usize, const M: usize> {
    first: Line<S, N, M>,
    of_first: State<S, N, M>,
    /// d(D s) and du of what sticks by q0, without what q1 moves.
    impulse_by_q0: SMatrix<S, N, N>,
    slip_by_q0: SMatrix<S, M, N>,
    second: Line<S, N, M>,
    of_second: State<S, N, M>,
    /// q1 as v̄ has it, v1, and h/2.
    q: SVector<S, N>,
    v: SVector<S, N>,
    half: S,
    /// ½ d(D s1) and ½ du of what sticks in the second line, by q.
    half_impulse: SMatrix<S, N, N>,
    half_slip: SMatrix<S, M, N>,
    mass: SMatrix<S, N, N>,
    momentum_by_q: SMatrix<S, N, N>,
    /// ∂/∂q of the equations for v1, which are balances of forces in coordinates without mass.
    end_by_q: SMatrix<S, N, N>,
    massless: Massless<N>,
    /// Coordinates that the kinks alone hold.
    light: Option<Light<S, N, M>>,
}

/// The share of coordinates that the kinks alone hold: their line for v1 by q0 and q1, and their
/// places at the end.
struct Light<S: Scalar, const N: usize, const M: usize> {
    coordinates: Massless<N>,
    by_ends: [SMatrix<S, N, N>; 2],
    balance: LinearizedBalance<S, N, M>,
}

impl<S: Scalar, const N: usize, const M: usize> LinearizedFriction<S, N, M> {
    pub(super) fn of<L, R>(
        system: &L,
        segment: &Segment<S, N>,
        p0: Option<&SVector<S, N>>,
        k: &LegendreDerivatives<S, N>,
    ) -> Result<(SMatrix<S, N, N>, Self), StepError>
    where
        L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M, Scalar = S>,
    {
        let (half, h) = (S::constant(0.5), segment.h);
        let slips = at_middle(system, segment);
        let directions = direction_of(&slips, h)?;
        let (by_v, by_q) = (slips.by_velocity / h, slips.by_configuration * half);
        let (by_q0, by_q1) = (by_q - by_v, by_q + by_v);
        let rest = system.later(h * half, |system| {
            system.slips(&(segment.q0 + segment.v * (h * half)), &nalgebra::zero())
        });
        let terms = |v: &SVector<S, N>| slips.by_velocity.abs() * v.abs() + rest.values.abs();
        let mut at = State::of(L::ELEMENTS, &slips.values, &directions, &terms(&segment.v));
        let matrix = k.p0_by_q1 + at.turning * by_q1;
        let first = Line::of(&matrix, &directions, &by_q1, &at.sticks)?;
        if let Some(p0) = p0 {
            let left = p0 - k.momenta.p0 - directions * at.forces;
            let held = first.complement.solve(&(first.rows * (first.inverse * left)));
            let entries = at.forces.as_mut_slice().iter_mut().zip(held.as_slice()).zip(at.sticks);
            entries.filter(|(_, stick)| *stick).for_each(|((force, held), _)| *force = *held);
            at.require_off_edge(L::ELEMENTS)?;
        }
        let curvature = |forces: &SVector<S, M>| {
            if L::IS_UNIFORM {
                return nalgebra::zero();
            }
            let middle = segment.q0 + segment.v * (h * half);
            system.later(h * half, |system| system.slip_curvature(&middle, forces)) * (h * half * half)
        };
        let bent: SMatrix<S, N, N> = curvature(&at.forces);
        let first =
            if L::IS_UNIFORM { first } else { Line::of(&(matrix + bent), &directions, &by_q1, &at.sticks)? };
        let impulse_by_q0 = at.turning * by_q0 + bent;
        let of_first = at;

        // The velocity at the end.
        let w = k.momenta.p1;
        let (middle, q1) = (segment.q0 + segment.v * (h * half), segment.q0 + segment.v * h);
        let end = super::end(system, segment, &w)?;
        let slips_at_end = system.later(h * half, |system| system.slips(&middle, &end.v));
        let mut at = State::of(L::ELEMENTS, &slips_at_end.values, &directions, &terms(&end.v));
        at.forces = end.held.forces;
        at.sticks = end.held.sticks;
        at.require_off_edge(L::ELEMENTS)?;
        let l = system.later(h, |system| system.lagrangian_derivatives(&q1, &end.v));
        let (of_end, by_ends) = system.later(h * half, |system| {
            let middle = Middle { system, h, q: middle, v: segment.v };
            let massless = (&end.massless, &end.light);
            let line = system.later(h * half, |at_end| balance(at_end, massless, &q1, &end.v, &middle));
            (line, end.light.are_any().then(|| by_ends(&end.light, &end.v, &middle)))
        });
        let second = Line::of(
            &(of_end.by_v + at.turning * slips_at_end.by_velocity),
            &directions,
            &slips_at_end.by_velocity,
            &at.sticks,
        )?;
        let light = by_ends.map(|by_ends| -> Result<_, StepError> {
            let at = at_end(system, segment, &end)?;
            let balance =
                system.later(h, |system| LinearizedBalance::of(system, &end.light, h * half, &at, &end.v))?;
            Ok(Light { coordinates: end.light, by_ends, balance })
        });
        let light = light.transpose()?;
        let half_impulse = at.turning * (slips_at_end.by_configuration * half) + curvature(&at.forces);
        let (mut half_slip, mut slip_by_q0) = (slips_at_end.by_configuration * half, by_q0);
        leave(&mut half_slip, &at.sticks);
        leave(&mut slip_by_q0, &of_first.sticks);
        let linearized = Self {
            first,
            of_first,
            impulse_by_q0,
            slip_by_q0,
            second,
            of_second: at,
            q: q1,
            v: end.v,
            half: h * half,
            half_impulse,
            half_slip,
            mass: l.d22,
            momentum_by_q: l.d12.transpose(),
            end_by_q: of_end.by_q,
            massless: end.massless,
            light,
        };
        let q_by_p = linearized.first.solve(&SMatrix::identity(), &nalgebra::zero());
        Ok((q_by_p, linearized))
    }

    /// The derivative of the end, from those of the start and of what moves the equations at fixed ends.
    fn carried<const K: usize>(
        &self,
        k: &LegendreDerivatives<S, N>,
        start: &StateBy<S, N, K>,
        moved: &Moved<S, N, M, K>,
    ) -> Result<StateBy<S, N, K>, StepError> {
        let right = start.p - (k.p0_by_q0 + self.impulse_by_q0) * start.q - moved.p0;
        let q = self.first.solve(&right, &-(self.slip_by_q0 * start.q + moved.slip));
        let both = start.q + q;
        let w = self.massless.without(&(k.p1_by_q0 * start.q + k.p1_by_q1 * q + moved.p1)) - moved.balance;
        let mut right = w - self.end_by_q * q - self.half_impulse * both;
        if let Some(Light { coordinates, by_ends: [by_q0, by_q1], .. }) = &self.light {
            // Momenta have the forces at the middle.
            right += coordinates.rows(&moved.p1) - by_q0 * start.q - by_q1 * q;
        }
        let v = self.second.solve(&right, &-(self.half_slip * both + moved.end_slip));
        let p = self.mass * v + self.momentum_by_q * q + moved.momentum;
        let q = match &self.light {
            Some(light) => light.balance.by((&start.q, &q), &v, &moved.places),
            None => q,
        };
        StepError::require_finite(&q, Quantity::Derivatives)?;
        StepError::require_finite(&p, Quantity::Derivatives)?;
        Ok(StateBy { q, p })
    }

    /// The equations for v1 but for coordinates that the kinks alone hold.
    fn beside_light<const K: usize>(&self, equations: SMatrix<S, N, K>) -> SMatrix<S, N, K> {
        self.light.as_ref().map_or(equations, |light| light.coordinates.without(&equations))
    }

    pub(super) fn by_state(&self, k: &LegendreDerivatives<S, N>) -> Result<PhaseMatrix<S, N>, StepError> {
        let (one, zero) = (SMatrix::identity(), SMatrix::zeros());
        let by_q = self.carried(k, &StateBy { q: one, p: zero }, &Moved::none())?;
        let by_p = self.carried(k, &StateBy { q: zero, p: one }, &Moved::none())?;
        Ok(PhaseMatrix { q_by_q: by_q.q, p_by_q: by_q.p, q_by_p: by_p.q, p_by_p: by_p.p })
    }

    /// By what moves the momenta, and the forces at (q, v) of the end.
    pub(super) fn answer<const P: usize>(
        &self,
        k: &LegendreDerivatives<S, N>,
        momenta: &MomentaBy<S, N, P>,
        at_end: impl Fn(&SVector<S, N>, &SVector<S, N>) -> SMatrix<S, N, P>,
    ) -> Result<StateBy<S, N, P>, StepError> {
        let mut moved = Moved { p0: momenta.p0, p1: momenta.p1, ..Moved::none() };
        if self.massless.are_any() {
            let forces = self.massless.rows(&at_end(&self.q, &self.v));
            moved.balance = self.beside_light(-forces * self.half);
        }
        if let Some(light) = &self.light {
            moved.places.balance = -light.balance.at(at_end);
        }
        self.carried(k, &StateBy { q: nalgebra::zero(), p: nalgebra::zero() }, &moved)
    }

    /// The derivatives of (q1, p1) by the parameters, which move slips and limits besides.
    pub(super) fn answer_parameters<L, const P: usize>(
        &self,
        system: &L,
        segment: &Segment<S, N>,
        k: &LegendreDerivatives<S, N>,
        momenta: &MomentaBy<S, N, P>,
    ) -> Result<StateBy<S, N, P>, StepError>
    where
        L: DryFrictionParameters<N, M, P, Scalar = S> + Parameters<N, P>,
    {
        let (half, q1) = (self.half, self.q);
        let middle = segment.q0 + segment.v * half;
        let by = |v: &SVector<S, N>, at: &State<S, N, M>| {
            let mut by = system.later(half, |system| system.slips_by_parameters(&middle, v, &at.forces));
            let impulse = by.force * half + at.turning * by.values;
            leave(&mut by.values, &at.sticks);
            (impulse, by.values)
        };
        let (impulse, slip) = by(&segment.v, &self.of_first);
        let (end_impulse, end_slip) = by(&self.v, &self.of_second);
        let (momentum, balance) = system.later(segment.h, |system| {
            let l = system.lagrangian_by_parameters(&q1, &self.v);
            let forces = || {
                let smooth = if L::HAS_SMOOTH {
                    -system.rayleigh_by_parameters(&q1, &self.v).d2
                } else {
                    nalgebra::zero()
                };
                l.d1 + smooth + system.force_by_parameters(&q1, &self.v)
            };
            (l.d2, self.beside_light(self.massless.balance_by(&l.d2, forces, half)))
        });
        let moved = Moved {
            p0: momenta.p0 + impulse,
            slip,
            p1: momenta.p1,
            balance: balance + end_impulse,
            end_slip,
            momentum,
            places: self.light.as_ref().map_or_else(MovedBalance::none, |light| {
                system.later(segment.h, |system| light.balance.by_parameters(system))
            }),
        };
        self.carried(k, &StateBy { q: nalgebra::zero(), p: nalgebra::zero() }, &moved)
    }
}

/// The derivatives of the equations by what moves them at fixed ends.
struct Moved<S, const N: usize, const M: usize, const K: usize> {
    /// p0 of the first line, and the slips of what sticks in it.
    p0: SMatrix<S, N, K>,
    slip: SMatrix<S, M, K>,
    /// w, the rest of the second line at fixed v1, and the slips of what sticks in it.
    p1: SMatrix<S, N, K>,
    balance: SMatrix<S, N, K>,
    end_slip: SMatrix<S, M, K>,
    /// ∂L/∂v at fixed (q1, v1).
    momentum: SMatrix<S, N, K>,
    /// The balance at the end.
    places: MovedBalance<S, N, M, K>,
}

impl<S: Scalar, const N: usize, const M: usize, const K: usize> Moved<S, N, M, K> {
    fn none() -> Self {
        let (of_momenta, of_slips) = (SMatrix::zeros(), SMatrix::zeros());
        Self {
            p0: of_momenta,
            slip: of_slips,
            p1: of_momenta,
            balance: of_momenta,
            end_slip: of_slips,
            momentum: of_momenta,
            places: MovedBalance::none(),
        }
    }
}
