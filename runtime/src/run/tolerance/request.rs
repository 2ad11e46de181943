//! An error asked for, of the methods that a system offers.

use super::reached::{Reached, reached};
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

    /// The end of a run whose error is kept on the whole way, as far as its guard can tell.
    ///
    /// The first steps do not always show what comes: a run that starts at the apocentre of a long ellipse
    /// passes its error at the pericentre. So as long as a run ends in a breach, or a step of it fails,
    /// another one starts from the beginning. Its method and step size are chosen for an error that is
    /// smaller by as much as the guard found the last one too large; where no method is expected to reach
    /// that, the last one takes shorter steps. What is kept is the error asked for. Most motions need one run
    /// or two; eight are tried. The page `docs/error-asked-for.md` counts how often none of them keeps it: at
    /// kinks, as a rule.
    ///
    /// ```
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn kepler(q: [f64; 2], v: [f64; 2]) -> f64 {
    ///     0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
    /// }
    ///
    /// // From the apocentre of an ellipse with e = 0.8, once around.
    /// let start = State::from_velocity(&Kepler {}, [-1.8, 0.0], [0.0, -1.0 / 3.0])?;
    /// let period = std::f64::consts::TAU;
    /// let reached = Kepler {}.to_error(1e-9).until(period).end(&start)?;
    /// assert!((reached.state.q - start.q).amax() < 1e-9);
    /// println!("{} runs, the last by {}", reached.runs, reached.choice);
    /// // The same run, to be sampled.
    /// assert_eq!(reached.choice.trajectory().last().unwrap()?.state, reached.state);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ToleranceError::Breach`] or [`ToleranceError::Step`] of the last run where none keeps the error;
    /// others where no method is chosen to begin with.
    pub fn end<const N: usize>(
        self,
        start: &State<L::Scalar, N>,
    ) -> Result<Reached<'a, L, M, N>, ToleranceError>
    where
        L: Lagrangian<N>,
        M: Methods<L, N>,
    {
        let Request { system, methods, tolerance } = self.request;
        reached((system, methods), start, self.time, tolerance)
    }
}
