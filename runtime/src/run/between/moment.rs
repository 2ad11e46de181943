//! A system at one moment.

use core::fmt;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{State, reactions_at};
use crate::system::{ActingForce, Constrained, EventFunctions, Lagrangian};

/// A system at one moment: q, and what is asked of it besides.
#[derive(Clone, Copy)]
pub struct Moment<'a, L, const N: usize>
where
    L: Lagrangian<N>,
{
    /// The time of the run.
    pub time: f64,
    /// Configuration.
    pub q: SVector<L::Scalar, N>,
    velocity: Option<SVector<L::Scalar, N>>,
    momentum: Option<SVector<L::Scalar, N>>,
    system: &'a L,
    /// The time of the run at which the system has its own time.
    since: f64,
}

impl<'a, L, const N: usize> Moment<'a, L, N>
where
    L: Lagrangian<N>,
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn interpolated(
        system: &'a L,
        [time, since]: [f64; 2],
        q: SVector<L::Scalar, N>,
        velocity: SVector<L::Scalar, N>,
    ) -> Self {
        Self { time, q, velocity: Some(velocity), momentum: None, system, since }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(in crate::run) fn of(
        system: &'a L,
        [time, since]: [f64; 2],
        state: &State<L::Scalar, N>,
        velocity: Option<SVector<L::Scalar, N>>,
    ) -> Self {
        Self { time, q: state.q, velocity, momentum: Some(state.p), system, since }
    }

    /// The velocity v. Of a state it is solved for (NaN where there is none), of an interpolation it is
    /// known.
    #[must_use]
    #[inline]
    pub fn velocity(&self) -> SVector<L::Scalar, N> {
        match (self.velocity, self.momentum) {
            (Some(velocity), _) => velocity,
            (None, Some(p)) => {
                let state = State { q: self.q, p };
                let velocity = |system: &L| state.velocity(system);
                let unknown = |_| SVector::repeat(L::Scalar::constant(f64::NAN));
                self.ask(velocity).unwrap_or_else(unknown)
            }
            (None, None) => SVector::repeat(L::Scalar::constant(f64::NAN)),
        }
    }

    /// The momentum p. Of a state it is known, of an interpolation it is ∂L/∂v(q, v).
    #[must_use]
    #[inline]
    pub fn momentum(&self) -> SVector<L::Scalar, N> {
        match self.momentum {
            Some(momentum) => momentum,
            None => {
                let v = self.velocity();
                self.ask(|system| system.lagrangian_gradient(&self.q, &v).d2)
            }
        }
    }

    /// The values then of the event functions that the block of the system states:
    /// `run.watch(|at| at.events())` watches for them.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// struct Ball {
    ///     height: f64,
    /// }
    /// #[rayleigh_system]
    /// impl Ball {
    ///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * v[0] * v[0] - q[0]
    ///     }
    ///     fn events(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 2] {
    ///         [q[0] - self.height, v[0]]
    ///     }
    /// }
    /// let ball = Ball { height: 0.375 };
    /// let start = State::from_velocity(&ball, [0.0], [1.0])?;
    /// let mut run = ball.by(Midpoint, 0.1).run(start);
    /// let found: Vec<_> = run.watch(|at| at.events()).until(2.0).collect::<Result<_, _>>()?;
    /// // Up at t = 1/2, at the top at 1, down at 3/2.
    /// let found: Vec<_> = found.iter().map(|event| (event.index, event.time)).collect();
    /// assert_eq!(found.len(), 3);
    /// for ((index, time), expected) in found.iter().zip([(0, 0.5), (1, 1.0), (0, 1.5)]) {
    ///     assert!(*index == expected.0 && (time - expected.1).abs() < 1e-13);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn events<const K: usize>(&self) -> [L::Scalar; K]
    where
        L: EventFunctions<N, K>,
    {
        let v = self.velocity();
        self.ask(|system| system.events(&self.q, &v))
    }

    /// The answer of the system, as it is then.
    pub fn ask<T>(&self, ask: impl FnOnce(&L) -> T) -> T {
        self.system.later(L::Scalar::constant(self.time - self.since), ask)
    }

    /// The multipliers of the constraints then, [`State::reactions`]; NaN where there are none. A constraint
    /// no longer holds where its own vanishes, if it is a stop, which pushes and does not pull.
    #[must_use]
    pub fn reactions<const M: usize>(&self) -> SVector<L::Scalar, M>
    where
        L: Constrained<N, M> + ActingForce<N>,
    {
        let (q, v) = (&self.q, &self.velocity());
        self.ask(|system| reactions_at(system, q, v))
            .unwrap_or_else(|_| SVector::repeat(L::Scalar::constant(f64::NAN)))
    }

    /// Both as a state.
    #[must_use]
    pub fn state(&self) -> State<L::Scalar, N> {
        State { q: self.q, p: self.momentum() }
    }
}

impl<L: Lagrangian<N>, const N: usize> fmt::Debug for Moment<'_, L, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, q, velocity, momentum, .. } = self;
        let mut shown = f.debug_struct("Moment");
        shown.field("time", time).field("q", q).field("velocity", velocity).field("momentum", momentum);
        shown.finish()
    }
}
