//! The marker of rules whose step is solved for v̄ itself.

use crate::step::{BoundedStep, Discrete, Discretised, State, StepError};

use super::{Fitted, FittedTrapezoidal, Midpoint, OneSided, Trapezoidal};

/// A rule whose step solves p0 = −D1 L_d − f_d⁻ for v̄ itself, so that an iteration is one evaluation of both
/// sides: the work of its step can be bounded in iterations
/// ([`step_within`](crate::Discretised::step_within)).
///
/// Gauss rules are none: each evaluation of their p0 solves for the stages within the segment.
///
/// ```compile_fail
/// use dalembert::{Discretise, Gauss, State, rayleigh_system};
/// #[rayleigh_system(rule = gauss)]
/// fn free(q: [f64; 1], v: [f64; 1]) -> f64 {
///     0.5 * v[0] * v[0] - 0.0 * q[0]
/// }
/// let start = State::from_velocity(&Free {}, [0.0], [1.0]).unwrap();
/// let _ = Free {}.by(Gauss::<2>, 0.1).step_within(&start, 3);
/// ```
#[diagnostic::on_unimplemented(
    message = "the work of a step by `{Self}` is not bounded by a number of iterations",
    label = "`step_within` is for rules that are solved for v̄ itself",
    note = "take `step`, whose iterations are bounded as well, or a rule such as `Midpoint`"
)]
pub trait SolvedForVelocity {}

impl SolvedForVelocity for Midpoint {}
impl SolvedForVelocity for Trapezoidal {}
impl SolvedForVelocity for Fitted {}
impl SolvedForVelocity for FittedTrapezoidal {}
impl SolvedForVelocity for OneSided {}

/// Steps of bounded work.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The step by at most `iterations` undamped Newton iterations, for a clock that does not wait:
    /// [`Discrete::step_within`].
    ///
    /// # Errors
    /// [`StepError`] where not even one iteration can be made; the state given is untouched.
    pub fn step_within(
        &self,
        state: &State<L::Scalar, N>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError>
    where
        R: SolvedForVelocity,
    {
        self.system.step_within(state, self.h, self.guess.as_ref(), iterations)
    }
}
