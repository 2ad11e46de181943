//! Which methods a choice is among, and their steps.

use super::Method;
use crate::rules::{Fitted, FittedTrapezoidal, Gauss, Midpoint, SelfAdjoint, Solver, Trapezoidal};
use crate::run::last_step::{LastStep, Remembered};
use crate::run::{Composition, Explicit, Splitting};
use crate::step::{Border, Flow, Fused, LinearizedStep, Memory, State, Step, StepError};
use crate::system::{ActingForce, ForcedLagrangian, Lagrangian};

/// The methods that a choice is among: a rule of order 2 stands for itself and its compositions;
/// [`WithSplittings`] and [`WithGauss`] add to those of another.
pub trait Methods<L: ActingForce<N>, const N: usize>: Copy {
    /// A step by any of the methods.
    type Step: MethodStep<L, N>;

    /// Whether there is the method.
    fn offers(method: Method) -> bool;

    /// The step of size `h` by `method`; nothing where the method is none of these.
    fn step(self, method: Method, h: L::Scalar) -> Option<Self::Step>;

    /// The step of size `h` by the rule, with its derivative; nothing where it has none.
    fn linearized(
        self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Option<LinearizedStep<L::Scalar, N>>;

    /// The state on the constraints that is nearest, of a system without any the state itself.
    fn nearest(self, system: &L, state: &State<L::Scalar, N>) -> Option<State<L::Scalar, N>>;
}

/// A step taken, and what it cost.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Taken<S, const N: usize> {
    /// Where it leads, and how it went.
    pub step: Step<S, N>,
    /// The cost in evaluations of the forces: of an implicit step those of its iterations, for all
    /// stages.
    pub evaluations: f64,
    /// The last two coefficients of the polynomial that a Gauss method has of the velocity over the step,
    /// which show what it does not resolve; nothing for other methods.
    pub unresolved: Option<[f64; 2]>,
}

/// A step by one of several methods, of one size, with what it keeps for the next.
pub trait MethodStep<L: Lagrangian<N>, const N: usize> {
    /// The step from `state`, `elapsed` after the time of `system`.
    ///
    /// # Errors
    /// Those of the step.
    fn advance(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<Taken<L::Scalar, N>, StepError>;

    /// Lets go of the state that the last step led to, as a step from another has to.
    fn forget(&mut self);

    /// The last step, to be looked into.
    fn last(&self) -> &dyn LastStep<L, N>;

    /// From here on equations are solved no further than an error of `error` after so many steps asks for,
    /// where a method has use for that; see
    /// [`Trajectory::solved_for`](crate::Trajectory::solved_for). `weight` is what an error of p counts
    /// beside one of q; 0 where it is not known.
    fn leave(&mut self, error: f64, steps: u64, weight: f64) {
        let _ = (error, steps, weight);
    }
}

/// The methods of `M`, and splittings into kicks and drifts: for systems whose trapezoidal rule is
/// [`Explicit`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithSplittings<M>(pub M);

/// The methods of `M`, and Gauss methods of 4 and 8 stages: for systems of `#[rayleigh_system(rule =
/// [trapezoidal, gauss])]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithGauss<M>(pub M);

/// A step by a rule, alone or composed.
#[allow(clippy::large_enum_variant, reason = "no allocator")]
pub enum Composed<L: Fused<R, N> + Flow<R, N>, R: SelfAdjoint, const N: usize> {
    /// The rule alone.
    Rule(OfSize<L, R, N>),
    /// Order 6.
    KahanLi6(OfSize<L, Composition<R, 9>, N>),
    /// Order 8.
    KahanLi8(OfSize<L, Composition<R, 17>, N>),
}

/// Steps by `M` of one size, with what they keep.
pub struct OfSize<L: Flow<M, N>, M, const N: usize> {
    h: L::Scalar,
    memory: Remembered<M, L::RunMemory>,
}

impl<L: Flow<M, N>, M, const N: usize> OfSize<L, M, N> {
    fn new(h: L::Scalar) -> Self {
        Self { h, memory: Default::default() }
    }

    /// Lets go of the last state; of a linear equation all else belongs to the step size.
    fn forget(&mut self, is_linear: bool) {
        if is_linear {
            self.memory.0.change_state();
        } else {
            self.memory = Default::default();
        }
    }

    #[inline]
    fn advance(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        self.memory.0.advance_later(system, elapsed, state, self.h)
    }
}

/// The cost of an iteration in a substep of a rule, in evaluations: the matrix, and the solution with it.
const ITERATION: f64 = 3.0;

impl<L: Fused<R, N> + Flow<R, N>, R: SelfAdjoint, const N: usize> MethodStep<L, N> for Composed<L, R, N> {
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<Taken<L::Scalar, N>, StepError> {
        let (step, substeps) = match self {
            Self::Rule(step) => (step.advance(system, elapsed, state)?, 1.0),
            Self::KahanLi6(step) => (step.advance(system, elapsed, state)?, 9.0),
            Self::KahanLi8(step) => (step.advance(system, elapsed, state)?, 17.0),
        };
        let iterations = f64::from(step.report.iterations);
        // An explicit step is one iteration with its verdict: two evaluations' worth, of which one is made.
        let evaluations = if L::LINEAR && !L::IS_CONSTRAINED {
            let more = (iterations - substeps).max(0.0);
            2.0 * substeps + (2.0 * ITERATION - 1.0) * more
        } else {
            substeps + ITERATION * iterations
        };
        Ok(Taken { step, evaluations, unresolved: None })
    }

    fn forget(&mut self) {
        match self {
            Self::Rule(step) => step.forget(L::LINEAR),
            Self::KahanLi6(step) => step.forget(L::LINEAR),
            Self::KahanLi8(step) => step.forget(L::LINEAR),
        }
    }

    fn last(&self) -> &dyn LastStep<L, N> {
        match self {
            Self::Rule(step) => &step.memory,
            Self::KahanLi6(step) => &step.memory,
            Self::KahanLi8(step) => &step.memory,
        }
    }
}

macro_rules! rules {
    ($($rule:ident)*) => {$(
        impl<L: Fused<$rule, N> + Flow<$rule, N> + ActingForce<N>, const N: usize> Methods<L, N> for $rule {
            type Step = Composed<L, Self, N>;

            fn offers(method: Method) -> bool {
                matches!(method, Method::Rule | Method::KahanLi6 | Method::KahanLi8)
            }

            fn step(self, method: Method, h: L::Scalar) -> Option<Self::Step> {
                match method {
                    Method::Rule => Some(Composed::Rule(OfSize::new(h))),
                    Method::KahanLi6 => Some(Composed::KahanLi6(OfSize::new(h))),
                    Method::KahanLi8 => Some(Composed::KahanLi8(OfSize::new(h))),
                    _ => None,
                }
            }

            fn linearized(
                self,
                system: &L,
                state: &State<L::Scalar, N>,
                h: L::Scalar,
            ) -> Option<LinearizedStep<L::Scalar, N>> {
                Flow::<Self, N>::linearized_step(system, state, h, None).ok()
            }

            fn nearest(self, system: &L, state: &State<L::Scalar, N>) -> Option<State<L::Scalar, N>> {
                <L::Border as Border<L, Self, N>>::nearest(system, state)
            }
        }
    )*};
}

rules! { Midpoint Trapezoidal Fitted FittedTrapezoidal }

/// Defines the steps of a wrapper that adds methods to those of another, and its [`Methods`].
macro_rules! added {
    ($with:ident: $system:ident, $(#[$doc:meta])* $or:ident {
        $($(#[$what:meta])* $method:ident($step:ty): $advance:expr, $forget:expr, $leave:expr;)*
    }) => {
        $(#[$doc])*
        #[allow(clippy::large_enum_variant, reason = "no allocator")]
        pub enum $or<L: $system<N>, R, const N: usize> {
            $($(#[$what])* $method($step),)*
            /// Of the others.
            Other(R),
        }

        impl<L: $system<N>, R: MethodStep<L, N>, const N: usize> MethodStep<L, N> for $or<L, R, N> {
            #[inline]
            fn advance(
                &mut self,
                system: &L,
                elapsed: f64,
                state: &State<L::Scalar, N>,
            ) -> Result<Taken<L::Scalar, N>, StepError> {
                match self {
                    $(Self::$method(step) => $advance(step, system, elapsed, state),)*
                    Self::Other(step) => step.advance(system, elapsed, state),
                }
            }

            fn forget(&mut self) {
                match self {
                    $(Self::$method(step) => $forget(step),)*
                    Self::Other(step) => step.forget(),
                }
            }

            fn last(&self) -> &dyn LastStep<L, N> {
                match self {
                    $(Self::$method(step) => &step.memory,)*
                    Self::Other(step) => step.last(),
                }
            }

            fn leave(&mut self, error: f64, steps: u64, weight: f64) {
                match self {
                    $(Self::$method(step) => $leave(step, error, steps, weight),)*
                    Self::Other(step) => step.leave(error, steps, weight),
                }
            }
        }

        impl<L: $system<N> + ActingForce<N>, M: Methods<L, N>, const N: usize> Methods<L, N> for $with<M> {
            type Step = $or<L, M::Step, N>;

            fn offers(method: Method) -> bool {
                matches!(method, $(Method::$method)|*) || M::offers(method)
            }

            fn step(self, method: Method, h: L::Scalar) -> Option<Self::Step> {
                match method {
                    $(Method::$method => Some($or::$method(OfSize::new(h))),)*
                    _ => self.0.step(method, h).map($or::Other),
                }
            }

            fn linearized(
                self,
                system: &L,
                state: &State<L::Scalar, N>,
                h: L::Scalar,
            ) -> Option<LinearizedStep<L::Scalar, N>> {
                self.0.linearized(system, state, h)
            }

            fn nearest(self, system: &L, state: &State<L::Scalar, N>) -> Option<State<L::Scalar, N>> {
                self.0.nearest(system, state)
            }
        }
    };
}

/// S kicks and the drifts between them.
#[inline]
fn kicked<L: Explicit<N>, const N: usize, const S: usize>(
    step: &mut OfSize<L, Splitting<S>, N>,
    system: &L,
    elapsed: f64,
    state: &State<L::Scalar, N>,
) -> Result<Taken<L::Scalar, N>, StepError> {
    let step = step.advance(system, elapsed, state)?;
    let evaluations = Splitting::<S>::gradients(L::IS_TIMED) as f64;
    Ok(Taken { step, evaluations, unresolved: None })
}

/// The cost of the derivatives of a stage's forces, in evaluations, and that of its share of a matrix of n
/// rows, over n².
const DERIVATIVE: f64 = 5.0;
const FACTORING: f64 = 1.0 / 32.0;

/// The cost of a sweep of simplified Newton's method, in evaluations, with sweeps of the fixed point that
/// were in vain, and that of solving for n modes, over n².
const BY_MODES: f64 = 4.0;
const SOLVING: f64 = 1.0 / 15.0;

#[inline]
fn staged<L: ForcedLagrangian<N>, const N: usize, const S: usize>(
    step: &mut OfSize<L, Gauss<S>, N>,
    system: &L,
    elapsed: f64,
    state: &State<L::Scalar, N>,
) -> Result<Taken<L::Scalar, N>, StepError> {
    let taken = step.advance(system, elapsed, state)?;
    let iterations = f64::from(taken.report.iterations);
    let entries = |stages: usize| (stages * N * stages * N) as f64;
    let by_stage = match step.memory.0.solver() {
        Solver::FixedPoint => iterations,
        Solver::Simplified => iterations * (BY_MODES + SOLVING * entries(1)),
        // All stages are differentiated before each iteration and after the last, and their matrix is
        // factored.
        Solver::Newton => DERIVATIVE + iterations * (DERIVATIVE + FACTORING * entries(S)),
    };
    Ok(Taken { step: taken, evaluations: S as f64 * by_stage, unresolved: Some(step.memory.0.unresolved()) })
}

added! { WithSplittings: Explicit,
    /// A step by a splitting, or by a method of others.
    SplitOr {
        /// Order 4.
        BlanesMoan4(OfSize<L, Splitting<6>, N>): kicked, keep, solve_nothing;
        /// Order 6.
        BlanesMoan6(OfSize<L, Splitting<11>, N>): kicked, keep, solve_nothing;
        /// Order 8.
        BlanesCasasEscorihuela8(OfSize<L, Splitting<19>, N>): kicked, keep, solve_nothing;
    }
}

added! { WithGauss: ForcedLagrangian,
    /// A step by a Gauss method, or by a method of others.
    GaussOr {
        /// Order 8.
        Gauss4(OfSize<L, Gauss<4>, N>): staged, forget_stages, leave_stages;
        /// Order 16.
        Gauss8(OfSize<L, Gauss<8>, N>): staged, forget_stages, leave_stages;
    }
}

/// A splitting keeps nothing of a state that its own step does not ask for.
fn keep<L: Explicit<N>, const N: usize, const S: usize>(_: &mut OfSize<L, Splitting<S>, N>) {}

/// A splitting solves no equations.
fn solve_nothing<L: Explicit<N>, const N: usize, const S: usize>(
    _: &mut OfSize<L, Splitting<S>, N>,
    _: f64,
    _: u64,
    _: f64,
) {
}

fn forget_stages<L: ForcedLagrangian<N>, const N: usize, const S: usize>(step: &mut OfSize<L, Gauss<S>, N>) {
    step.memory.0.forget();
}

fn leave_stages<L: ForcedLagrangian<N>, const N: usize, const S: usize>(
    step: &mut OfSize<L, Gauss<S>, N>,
    error: f64,
    steps: u64,
    weight: f64,
) {
    step.memory.0.leave(error, steps, weight);
}
