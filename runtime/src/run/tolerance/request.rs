//! An error asked for, of the methods that a system offers.

use super::{Choice, GuardedTrajectory, Method, Methods, ToleranceError};
use crate::step::State;
use crate::system::Lagrangian;

/// A system that offers methods where an error is asked for: those of the rules that its attribute lists.
///
/// `#[rayleigh_system]` writes it for every system with a self-adjoint rule of order 2, which stands for
/// itself and its compositions. Splittings come with an explicit trapezoidal rule, Gauss methods with
/// `gauss`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` offers no method to an error asked for",
    label = "no self-adjoint rule of order 2 is listed for this system",
    note = "list one: `#[rayleigh_system(rule = midpoint)]`, or `rule = [trapezoidal, gauss]` for small errors"
)]
pub trait OffersMethods<const N: usize>: Lagrangian<N> + Sized {
    /// The methods.
    type Methods: Methods<Self, N> + Default;
}

/// An error asked for of a system: [`to_error`](crate::Discretise::to_error).
#[derive(Clone, Copy, Debug)]
#[must_use = "nothing is chosen before `until`"]
pub struct Request<'a, L, M> {
    system: &'a L,
    methods: M,
    tolerance: f64,
}

/// An error asked for of a system over a time: [`Request::until`].
#[derive(Clone, Copy, Debug)]
#[must_use = "nothing is chosen before `choice` or `run`"]
pub struct TimedRequest<'a, L, M> {
    request: Request<'a, L, M>,
    time: f64,
}

impl<'a, L, M> Request<'a, L, M> {
    pub(crate) fn new(system: &'a L, methods: M, tolerance: f64) -> Self {
        Self { system, methods, tolerance }
    }

    /// Of these methods alone.
    pub fn among<W>(self, methods: W) -> Request<'a, L, W> {
        Request { system: self.system, methods, tolerance: self.tolerance }
    }

    /// Over the time `time`.
    pub fn until(self, time: f64) -> TimedRequest<'a, L, M> {
        TimedRequest { request: self, time }
    }
}

impl<'a, L, M> TimedRequest<'a, L, M> {
    /// The method and step size for the motion from `start`, with the reasons.
    ///
    /// # Errors
    /// A [`ToleranceError`].
    pub fn choice<const N: usize>(
        self,
        start: &State<L::Scalar, N>,
    ) -> Result<Choice<'a, L, M, N>, ToleranceError>
    where
        L: Lagrangian<N>,
        M: Methods<L, N>,
    {
        let Request { system, methods, tolerance } = self.request;
        Method::for_tolerance(system, methods, start, self.time, tolerance)
    }

    /// The run from `start` by the method and step size chosen for it, with its guard.
    ///
    /// # Errors
    /// A [`ToleranceError`].
    pub fn run<const N: usize>(
        self,
        start: State<L::Scalar, N>,
    ) -> Result<GuardedTrajectory<'a, L, M, N>, ToleranceError>
    where
        L: Lagrangian<N>,
        M: Methods<L, N>,
    {
        self.choice(&start).map(|choice| choice.trajectory())
    }
}
