//! The flow of a discrete system: its step, and what a run of steps keeps.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{BoundedStep, LinearizedStep, State, Step, StepError};
use crate::system::{GeneratedDiffers, Lagrangian};

/// The flow of a system by the method `M`: (q0, p0) ↦ (q1, p1).
///
/// Rules have one, and what is made of their steps: a [`Composition`](crate::Composition), a
/// [`Splitting`](crate::Splitting). [`by`](crate::Discretise::by) asks for it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no step by `{M}`",
    label = "no step by `{M}`",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "otherwise list the rule in the attribute: `#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]`; one of your own, `impl dalembert::rules::DisplacementRule`, is stepped by `Quadrature(rule)`"
)]
pub trait Flow<M, const N: usize>: Lagrangian<N> {
    /// The memory of a run from step to step.
    type RunMemory: Memory<Self, M, N>;

    /// Whether steps are those of the motion where L does not hold the velocity of a coordinate that friction
    /// damps: where ∂²L/∂v² is singular otherwise, a step is refused.
    const TAKES_MASSLESS: bool = false;

    /// The step of size `h` from `state`. `guess` is a guess for v̄ = (q1 − q0)/h.
    ///
    /// # Errors
    /// A [`StepError`]; the state given is untouched.
    fn step(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
    ) -> Result<Step<Self::Scalar, N>, StepError>;

    /// The step with its derivative A = ∂(q1, p1)/∂(q0, p0).
    ///
    /// # Errors
    /// Those of [`step`](Self::step); [`StepError::SingularNewtonMatrix`] where it has no derivative.
    fn linearized_step(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
    ) -> Result<LinearizedStep<Self::Scalar, N>, StepError>;

    /// Verifies that the step of size `h` from `state` computes p0 and p1 as the derivatives of L_d and f_d
    /// say. With the standard library a run does so before its first step.
    ///
    /// A step that computes no momenta at once has nothing to compare.
    ///
    /// # Errors
    /// [`GeneratedDiffers`].
    #[cold]
    fn verify_momenta(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<(), GeneratedDiffers> {
        let _ = (state, h);
        Ok(())
    }
}

/// A flow whose step can be given a bounded number of iterations, each of them one evaluation of both sides
/// of p0 = −D1 L_d − f_d⁻.
///
/// Gauss rules have none: each evaluation of their p0 solves for the stages within the segment.
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
    message = "the work of a step by `{M}` is not bounded by a number of iterations",
    label = "`step_within` is for rules that are solved for v̄ itself",
    note = "take `step`, whose iterations are bounded as well, or a rule such as `Midpoint`"
)]
pub trait BoundedFlow<M, const N: usize>: Flow<M, N> {
    /// The step by at most `iterations` undamped Newton iterations: the best iterate, with the residual left
    /// and the last correction in its report. Without a `guess` the velocity of the state is solved for
    /// first.
    ///
    /// # Errors
    /// [`StepError`] where not even one iteration can be made; the state given is untouched.
    fn step_within(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<Self::Scalar, N>, StepError>;
}

/// The memory of a run from step to step, and how the next step uses it.
///
/// [`Default`] is the memory before the first step. What is remembered makes a step cheaper; it never decides
/// where the step leads, beyond rounding, or what a run was told to leave unsolved
/// ([`Trajectory::solved_for`](crate::Trajectory::solved_for)): a memory of other states or another step size
/// does no harm.
pub trait Memory<L: ?Sized, M, const N: usize>: Default
where
    L: Lagrangian<N>,
{
    /// The step of [`Flow::step`] from `state`.
    ///
    /// # Errors
    /// Those of [`Flow::step`]; what is remembered is then as before, and where the method is a rule
    /// ([`Linearizable`](crate::step::Linearizable)) nothing has been written.
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError>;

    /// Verifies the momenta that steps with this memory compute: [`Flow::verify_momenta`], and its own where
    /// it has some.
    ///
    /// # Errors
    /// [`GeneratedDiffers`].
    #[cold]
    fn verify_momenta(system: &L, state: &State<L::Scalar, N>, h: L::Scalar) -> Result<(), GeneratedDiffers>
    where
        L: Flow<M, N>,
    {
        system.verify_momenta(state, h)
    }

    /// Takes `velocity` for the mean velocity of the step before the first, of size `h`. Nothing where no
    /// guess serves.
    fn suggest(&mut self, velocity: &SVector<L::Scalar, N>, h: L::Scalar) {
        let _ = (velocity, h);
    }

    /// Takes over what is known of the state from which the next step starts, from the memory of the step
    /// that ended there. In a composition that is the one of the substep before.
    fn follow(&mut self, _previous: &Self) {}

    /// The next step is of a system with another input: what was remembered of forces no longer holds, and
    /// the Newton matrix may have changed. A memory that does not say better forgets all. A run with inputs
    /// says so at the end of each step.
    fn change_input(&mut self) {
        *self = Self::default();
    }

    /// The next step starts near where the last one ended, not there, as at a state corrected by a
    /// measurement. A memory that does not say better forgets all.
    fn change_state(&mut self) {
        *self = Self::default();
    }

    /// Shares of a step, ascending within (0, 1), at which the method itself knows q and v: those of
    /// [`at_nodes`](Self::at_nodes). None, unless it solves for points between the ends.
    const NODES: &'static [f64] = &[];

    /// Calls `visit` with the index of each node, with q there, and with v: of the last step, which led from
    /// `q0` by `h`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn at_nodes(
        &self,
        q0: &SVector<L::Scalar, N>,
        h: L::Scalar,
        visit: impl FnMut(usize, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        let _ = (q0, h, visit);
    }

    /// (q, v) at a `share` of the last step, which led from `q0` by `h`, by the polynomial through its nodes;
    /// `None` where it has none.
    #[inline]
    fn between(
        &self,
        q0: &SVector<L::Scalar, N>,
        h: L::Scalar,
        share: f64,
    ) -> Option<[SVector<L::Scalar, N>; 2]> {
        let _ = (q0, h, share);
        None
    }

    /// Where a step of size `elapsed` leads from `state`, from which the last one, of size `h`, was taken: by
    /// what is known of that, where it makes this one cheaper.
    #[inline]
    fn beginning(
        &self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        elapsed: L::Scalar,
    ) -> Option<State<L::Scalar, N>> {
        let _ = (system, state, h, elapsed);
        None
    }

    /// The velocity of `state`, where the method knows it without solving for it.
    #[inline]
    fn velocity(&self, state: &State<L::Scalar, N>) -> Option<SVector<L::Scalar, N>> {
        let _ = state;
        None
    }

    /// From here on equations are solved no further than an error of `error` after so many steps asks for,
    /// where the method has use for that: [`Trajectory::solved_for`](crate::Trajectory::solved_for).
    /// Derivatives that are taken with this memory are then those at what was left.
    fn leave_unsolved(&mut self, error: f64, steps: u64) {
        let _ = (error, steps);
    }

    /// The step from `state`, `elapsed` after the time of `system`: of the system as it is then
    /// ([`Lagrangian::later`](crate::Lagrangian::later)).
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance).
    #[inline]
    fn advance_later(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError>
    where
        L: Sized,
    {
        system.later(L::Scalar::constant(elapsed), |system| self.advance(system, state, h))
    }
}
