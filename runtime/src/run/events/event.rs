//! An event that was found, and its derivatives by the state before.

use nalgebra::SVector;

use super::{EventError, Passage};
use crate::numbers::Scalar;
use crate::step::{Discretised, Flow, PhaseMatrix, State};
use crate::system::{ActingForce, Lagrangian};

/// An event: when, where, which and how.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event<S, const N: usize> {
    /// Which function vanishes: its place among those that are watched.
    pub index: usize,
    /// How it passes 0.
    pub passage: Passage,
    /// The time of the run.
    pub time: f64,
    /// The state then: a step from [`from`](Self::from) of size [`elapsed`](Self::elapsed).
    pub state: State<S, N>,
    /// Its velocity.
    pub velocity: SVector<S, N>,
    /// The state of the run from which the step over the event was taken.
    pub from: State<S, N>,
    /// Its time.
    pub from_time: f64,
    /// How long after it the event is; negative in a run backwards.
    pub elapsed: S,
    /// The time of the run at which its system has its own.
    pub(super) since: f64,
}

/// The derivative of an event function g(q, p, t): what [`Event::derivatives`] asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventGradient<S, const N: usize> {
    /// ∂g/∂q.
    pub q: SVector<S, N>,
    /// ∂g/∂p.
    pub p: SVector<S, N>,
    /// ∂g/∂t.
    pub time: S,
}

/// The derivatives of an event by the state x0 = (q0, p0) from which its step was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventDerivatives<S, const N: usize> {
    /// ∂t/∂q0.
    pub time_by_q: SVector<S, N>,
    /// ∂t/∂p0.
    pub time_by_p: SVector<S, N>,
    /// ∂(q, p)/∂(q0, p0) of the state at the event, at its own time.
    pub a: PhaseMatrix<S, N>,
}

impl<S: Scalar, const N: usize> EventDerivatives<S, N> {
    /// The derivatives of this event by an earlier state x, given `a` = ∂x0/∂x, the product of the
    /// derivatives of the steps between.
    #[must_use]
    pub fn after(&self, a: &PhaseMatrix<S, N>) -> Self {
        Self {
            time_by_q: a.q_by_q.tr_mul(&self.time_by_q) + a.p_by_q.tr_mul(&self.time_by_p),
            time_by_p: a.q_by_p.tr_mul(&self.time_by_q) + a.p_by_p.tr_mul(&self.time_by_p),
            a: self.a * *a,
        }
    }
}

impl<S: Scalar, const N: usize> Event<S, N> {
    /// The energy of the state at the event. `system` is the one that the run was begun with, or that holds
    /// the input: a view is asked at the time of the event, not at its own.
    #[must_use]
    pub fn energy<L>(&self, system: &L) -> S
    where
        L: Lagrangian<N, Scalar = S>,
    {
        let elapsed = S::constant(self.time - self.since);
        system.later(elapsed, |system| system.energy(&self.state.q, &self.velocity))
    }

    /// The derivatives of time and state of the event by the state from which its step was taken, `g` being
    /// the derivative of the event function there:
    ///
    /// ```text
    /// dt = −∇g·A dx0 / ġ,   dx = A dx0 + ẋ dt,   ẋ = (v, ∂L/∂q + f_L),   ġ = ∇g·ẋ + ∂g/∂t
    /// ```
    ///
    /// with A of the partial step. They make the derivatives of return maps and sections, and of whatever
    /// ends at an event. A is exact; ẋ is that of the motion, from which the steps' own differs by their
    /// error. Where the system takes the time, `by` is of the view that the run was begun with, or that holds
    /// the input.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::run::events::{Crossing, EventGradient};
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    /// }
    /// let by = Oscillator {}.by(Gauss::<6>, 0.75);
    /// let start = State::from_velocity(&Oscillator {}, [1.0], [-0.5])?;
    /// let mut run = by.run(start);
    /// let event = run.watch(|at| [at.q[0] - 0.75]).next().unwrap()?;
    /// let plane = EventGradient { q: vector![1.0], p: vector![0.0], time: 0.0 };
    /// let derivatives = event.derivatives(&by, &plane)?;
    /// // q stays on the plane; the energy (q² + p²)/2 says what p does.
    /// assert!(derivatives.a.q_by_q[0].abs() < 1e-12);
    /// assert!((derivatives.a.p_by_q[0] - 1.0 / event.state.p[0]).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Discretised::linearized_step`]; [`EventError::Tangent`] where ġ = 0.
    pub fn derivatives<L, M>(
        &self,
        by: &Discretised<'_, L, M, N>,
        g: &EventGradient<S, N>,
    ) -> Result<EventDerivatives<S, N>, EventError>
    where
        L: Flow<M, N> + ActingForce<N, Scalar = S>,
    {
        let mean = (self.state.q - self.from.q) / self.elapsed;
        let (_, a) = by.system().later(S::constant(self.from_time - self.since), |system| {
            Flow::<M, N>::linearized_step(system, &self.from, self.elapsed, Some(&mean))
        })?;
        let (q, v) = (&self.state.q, &self.velocity);
        let rate = by.system().later(S::constant(self.time - self.since), |system| {
            system.lagrangian_gradient(q, v).d1 + system.acting_force(q, v)
        });
        let slope = g.q.dot(v) + g.p.dot(&rate) + g.time;
        let inverse = S::one() / slope;
        if !inverse.is_finite() {
            return Err(EventError::Tangent { index: self.index, time: self.time });
        }
        let time_by_q = (a.q_by_q.tr_mul(&g.q) + a.p_by_q.tr_mul(&g.p)) * -inverse;
        let time_by_p = (a.q_by_p.tr_mul(&g.q) + a.p_by_p.tr_mul(&g.p)) * -inverse;
        Ok(EventDerivatives {
            time_by_q,
            time_by_p,
            a: PhaseMatrix {
                q_by_q: a.q_by_q + v * time_by_q.transpose(),
                q_by_p: a.q_by_p + v * time_by_p.transpose(),
                p_by_q: a.p_by_q + rate * time_by_q.transpose(),
                p_by_p: a.p_by_p + rate * time_by_p.transpose(),
            },
        })
    }
}
