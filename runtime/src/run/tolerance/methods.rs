//! Which methods a choice is among, and their steps.

use nalgebra::SVector;

use super::Method;
use crate::numbers::Scalar;
use crate::rules::{Fitted, FittedTrapezoidal, Gauss, Midpoint, StageHistory, Trapezoidal};
use crate::run::{ComposedStep, Composition, Explicit, Kicks, Splitting, Substeps};
use crate::step::{Discrete, LegendreDerivatives, Memory, State, StepError};
use crate::system::{ForcedLagrangian, Lagrangian};

/// The methods that a system offers to [`Method::for_tolerance`]: a rule of order 2 stands for itself and its
/// compositions; [`WithSplittings`] and [`WithGauss`] add to those of another.
pub trait Methods<L: Lagrangian<N>, const N: usize>: Copy {
    /// A step by any of the methods.
    type Step: MethodStep<L, N>;

    /// Whether there is the method.
    fn offers(method: Method) -> bool;

    /// The step of size `h` by `method`; nothing where the method is none of these.
    fn step(self, method: Method, h: L::Scalar) -> Option<Self::Step>;

    /// Both momenta on the segment (`q0`, `q1`) by the rule of order 2, with their derivatives.
    fn legendre_derivatives(
        self,
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> LegendreDerivatives<L::Scalar, N>;

    /// Whether a force acts on the segment (`q0`, `q1`).
    fn is_forced(
        self,
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> bool;
}

/// A step taken, and what it cost.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Taken<S, const N: usize> {
    /// Where it leads.
    pub state: State<S, N>,
    /// What it cost in evaluations of the forces: of an implicit step those of its iterations, all stages
    /// counted.
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
pub enum Composed<L: Discrete<R, N>, R, const N: usize> {
    /// The rule alone.
    Rule(Substeps<L, R, N, 1>),
    /// Order 6.
    KahanLi6(Substeps<L, R, N, 9>),
    /// Order 8.
    KahanLi8(Substeps<L, R, N, 17>),
}

/// What a substep of a rule costs in evaluations for each iteration: the matrix, and the solution with it.
const ITERATION: f64 = 3.0;

impl<L: Discrete<R, N>, R, const N: usize> MethodStep<L, N> for Composed<L, R, N> {
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<Taken<L::Scalar, N>, StepError> {
        let mut evaluations = 0.0;
        // An explicit step is one iteration with its verdict: two evaluations' worth, of which one is made.
        let mut count = |iterations: u32| {
            evaluations +=
                if iterations <= 1 && L::LINEAR { 2.0 } else { 1.0 + ITERATION * f64::from(iterations) };
        };
        let state = match self {
            Self::Rule(step) => step.advance_counted(system, elapsed, state, &mut count),
            Self::KahanLi6(step) => step.advance_counted(system, elapsed, state, &mut count),
            Self::KahanLi8(step) => step.advance_counted(system, elapsed, state, &mut count),
        }?;
        Ok(Taken { state, evaluations, unresolved: None })
    }

    fn forget(&mut self) {
        // What a linear equation's step keeps is asked for by the state, or belongs to the step size alone.
        if L::LINEAR {
            return;
        }
        match self {
            Self::Rule(step) => ComposedStep::forget(step),
            Self::KahanLi6(step) => ComposedStep::forget(step),
            Self::KahanLi8(step) => ComposedStep::forget(step),
        }
    }
}

macro_rules! rules {
    ($($rule:ident)*) => {$(
        impl<L: Discrete<$rule, N>, const N: usize> Methods<L, N> for $rule {
            type Step = Composed<L, Self, N>;

            fn offers(method: Method) -> bool {
                matches!(method, Method::Rule | Method::KahanLi6 | Method::KahanLi8)
            }

            fn step(self, method: Method, h: L::Scalar) -> Option<Self::Step> {
                match method {
                    Method::Rule => Some(Composed::Rule(Substeps::new(&Composition::alone(self), h))),
                    Method::KahanLi6 => Some(Composed::KahanLi6(Substeps::new(&Composition::kahan_li_6(self), h))),
                    Method::KahanLi8 => Some(Composed::KahanLi8(Substeps::new(&Composition::kahan_li_8(self), h))),
                    _ => None,
                }
            }

            fn legendre_derivatives(
                self,
                system: &L,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> LegendreDerivatives<L::Scalar, N> {
                Discrete::<$rule, N>::legendre_derivatives(system, q0, q1, h)
            }

            fn is_forced(
                self,
                system: &L,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> bool {
                let force = Discrete::<$rule, N>::discrete_force(system, q0, q1, h);
                force.minus.iter().chain(force.plus.iter()).any(|&entry| entry != nalgebra::zero())
            }
        }
    )*};
}

rules! { Midpoint Trapezoidal Fitted FittedTrapezoidal }

/// What a wrapper adds to the methods of another: its steps, and which of them a method asks for.
macro_rules! added {
    ($with:ident: $system:ident, $(#[$doc:meta])* $or:ident {
        $($(#[$what:meta])* $method:ident($step:ty): $start:expr, $advance:expr, $forget:expr;)*
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
        }

        impl<L: $system<N>, M: Methods<L, N>, const N: usize> Methods<L, N> for $with<M> {
            type Step = $or<L, M::Step, N>;

            fn offers(method: Method) -> bool {
                matches!(method, $(Method::$method)|*) || M::offers(method)
            }

            fn step(self, method: Method, h: L::Scalar) -> Option<Self::Step> {
                match method {
                    $(Method::$method => Some($or::$method($start(h))),)*
                    _ => self.0.step(method, h).map($or::Other),
                }
            }

            fn legendre_derivatives(
                self,
                system: &L,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> LegendreDerivatives<L::Scalar, N> {
                self.0.legendre_derivatives(system, q0, q1, h)
            }

            fn is_forced(
                self,
                system: &L,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> bool {
                self.0.is_forced(system, q0, q1, h)
            }
        }
    };
}

/// S kicks and the drifts between them.
fn kicked<L: Explicit<N>, const N: usize, const S: usize>(
    step: &mut Kicks<L::Scalar, N, S>,
    system: &L,
    elapsed: f64,
    state: &State<L::Scalar, N>,
) -> Result<Taken<L::Scalar, N>, StepError> {
    let state = ComposedStep::<L, N>::advance(step, system, elapsed, state)?;
    Ok(Taken { state, evaluations: S as f64, unresolved: None })
}

/// What the derivatives of a stage's forces cost in evaluations, and what its share of a matrix of n rows
/// does, over n².
const DERIVATIVE: f64 = 2.0;
const FACTORING: f64 = 1.0 / 60.0;

/// A Gauss step with the stages of the last one.
#[derive(Clone, Copy, Debug)]
pub struct Stagewise<T, const N: usize, const S: usize> {
    h: T,
    history: StageHistory<T, N, S>,
}

impl<T: Scalar, const N: usize, const S: usize> Stagewise<T, N, S> {
    fn new(h: T) -> Self {
        Self { h, history: StageHistory::default() }
    }

    fn forget(&mut self) {
        self.history = StageHistory::default();
    }
}

fn staged<L: ForcedLagrangian<N>, const N: usize, const S: usize>(
    step: &mut Stagewise<L::Scalar, N, S>,
    system: &L,
    elapsed: f64,
    state: &State<L::Scalar, N>,
) -> Result<Taken<L::Scalar, N>, StepError> {
    let memory: &mut StageHistory<L::Scalar, N, S> = &mut step.history;
    let taken = Memory::<L, Gauss<S>, N>::advance_later(memory, system, elapsed, state, step.h)?;
    let iterations = f64::from(taken.report.iterations);
    // By Newton's method all stages are differentiated before each iteration and after the last, and their
    // matrix is factored.
    let by_stage = if step.history.is_by_newton() {
        let entries = (S * N * S * N) as f64;
        DERIVATIVE + iterations * (DERIVATIVE + FACTORING * entries)
    } else {
        iterations
    };
    Ok(Taken {
        state: taken.state,
        evaluations: S as f64 * by_stage,
        unresolved: Some(step.history.unresolved()),
    })
}

fn forget_force<T: Scalar, const N: usize, const S: usize>(step: &mut Kicks<T, N, S>) {
    step.forget_force();
}

added! { WithSplittings: Explicit,
    /// A step by a splitting, or by a method of others.
    SplitOr {
        /// Order 4.
        BlanesMoan4(Kicks<L::Scalar, N, 6>): |h| Kicks::new(Splitting::blanes_moan_4(), h), kicked, forget_force;
        /// Order 6.
        BlanesMoan6(Kicks<L::Scalar, N, 11>): |h| Kicks::new(Splitting::blanes_moan_6(), h), kicked, forget_force;
    }
}

added! { WithGauss: ForcedLagrangian,
    /// A step by a Gauss method, or by a method of others.
    GaussOr {
        /// Order 8.
        Gauss4(Stagewise<L::Scalar, N, 4>): Stagewise::new, staged, Stagewise::forget;
        /// Order 16.
        Gauss8(Stagewise<L::Scalar, N, 8>): Stagewise::new, staged, Stagewise::forget;
    }
}
