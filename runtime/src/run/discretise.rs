//! The two beginnings of a run: `system.by(rule, h)`, or `system.to_error(tolerance)`.

use crate::run::tolerance::{OffersMethods, Request};
use crate::step::{Discretised, MethodOf};
use crate::system::Lagrangian;

/// Discretises every system: by a method and a step size, or for a tolerance.
pub trait Discretise<const N: usize>: Lagrangian<N> + Sized {
    /// This system discretised by `method` with step size `h`: what is asked of a discrete system is asked of
    /// the value returned.
    ///
    /// A method is a rule, a [`Composition`](crate::Composition) of one, or a
    /// [`Splitting`](crate::Splitting).
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], c: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * c * v[0] * v[0])
    /// }
    /// let pendulum = Pendulum { c: 0.1 };
    /// let start = State::from_velocity(&pendulum, [1.0], [0.0])?;
    /// let end = pendulum.by(Midpoint, 0.1).run(start).nth(99).unwrap()?.state;
    /// assert!(end.energy(&pendulum)? < start.energy(&pendulum)?);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[inline]
    fn by<M>(&self, method: M, h: Self::Scalar) -> Discretised<'_, Self, M, N>
    where
        M: MethodOf<Self, N>,
    {
        let _ = method;
        Discretised::new(self, h)
    }

    /// This system with an error of at most `tolerance` asked for, in units of q, of its state on the whole
    /// way: the method and the step size are chosen by the motion.
    ///
    /// [`tolerance`](crate::tolerance) says what is promised, how both are chosen, and how the run is
    /// guarded.
    ///
    /// ```
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], c: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * c * v[0] * v[0])
    /// }
    /// let pendulum = Pendulum { c: 0.1 };
    /// let start = State::from_velocity(&pendulum, [1.0], [0.0])?;
    /// let mut run = pendulum.to_error(1e-9).until(20.0).run(start)?;
    /// let end = run.by_ref().last().unwrap()?.state;
    /// assert!(run.breach().is_none() && end.energy(&pendulum)? < start.energy(&pendulum)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    fn to_error(&self, tolerance: f64) -> Request<'_, Self, Self::Methods>
    where
        Self: OffersMethods<N>,
    {
        Request::new(self, Self::Methods::default(), tolerance)
    }
}

impl<L: Lagrangian<N>, const N: usize> Discretise<N> for L {}
