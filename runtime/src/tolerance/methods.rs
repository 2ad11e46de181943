//! Which methods a choice is among, and their runs.

use super::Method;
use crate::{
    ComposedTrajectory, Composition, Discrete, Explicit, Fitted, FittedTrapezoidal, ForcedLagrangian, Gauss,
    Kicks, Lagrangian, Midpoint, Splitting, State, StepError, Substeps, Trajectory, Trapezoidal,
};

/// The methods that a system offers to [`Method::for_tolerance`]: a rule of order 2 stands for itself and its compositions;
/// [`WithSplittings`] and [`WithGauss`] add to those of another.
pub trait Methods<L: Lagrangian<N>, const N: usize>: Copy {
    /// A run by any of the methods.
    type Run<'a>: MethodRun<L, N>
    where
        L: 'a;

    /// Whether there is the method.
    fn offers(method: Method) -> bool;

    /// The run of `system` by `method`; by the rule alone where the method is none of these.
    fn run<'a>(
        self,
        method: Method,
        system: &'a L,
        h: L::Scalar,
        state: State<L::Scalar, N>,
    ) -> Self::Run<'a>;
}

/// A run by one of several methods.
pub trait MethodRun<L: Lagrangian<N>, const N: usize> {
    /// The present state.
    fn state(&self) -> &State<L::Scalar, N>;

    /// One step; how many substeps of the rule it costs.
    ///
    /// # Errors
    /// Those of the step.
    fn advance(&mut self) -> Result<f64, StepError>;
}

/// The methods of `M`, and splittings into kicks and drifts: for systems whose trapezoidal rule is [`Explicit`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithSplittings<M>(pub M);

/// The methods of `M`, and Gauss methods of 4 and 8 stages: for systems of `#[rayleigh_system(rule = [trapezoidal, gauss])]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithGauss<M>(pub M);

/// A run by a rule, or composed.
pub enum Composed<'a, L: Discrete<R, N>, R, const N: usize> {
    /// The rule alone.
    Rule(ComposedTrajectory<'a, L, Substeps<L, R, N, 1>, N>),
    /// Order 6.
    KahanLi6(ComposedTrajectory<'a, L, Substeps<L, R, N, 9>, N>),
    /// Order 8.
    KahanLi8(ComposedTrajectory<'a, L, Substeps<L, R, N, 17>, N>),
}

impl<'a, L: Discrete<R, N>, R, const N: usize> Composed<'a, L, R, N> {
    fn new(rule: R, method: Method, system: &'a L, h: L::Scalar, state: State<L::Scalar, N>) -> Self {
        match method {
            Method::KahanLi6 => Self::KahanLi6(Composition::kahan_li_6(rule).trajectory(system, h, state)),
            Method::KahanLi8 => Self::KahanLi8(Composition::kahan_li_8(rule).trajectory(system, h, state)),
            _ => Self::Rule(Composition::alone(rule).trajectory(system, h, state)),
        }
    }
}

impl<L: Discrete<R, N>, R, const N: usize> MethodRun<L, N> for Composed<'_, L, R, N> {
    fn state(&self) -> &State<L::Scalar, N> {
        match self {
            Self::Rule(run) => run.state(),
            Self::KahanLi6(run) => run.state(),
            Self::KahanLi8(run) => run.state(),
        }
    }

    #[inline]
    fn advance(&mut self) -> Result<f64, StepError> {
        let (step, substeps) = match self {
            Self::Rule(run) => (run.next(), 1.0),
            Self::KahanLi6(run) => (run.next(), 9.0),
            Self::KahanLi8(run) => (run.next(), 17.0),
        };
        step.map_or(Ok(substeps), |step| step.map(|_| substeps))
    }
}

macro_rules! rules {
    ($($rule:ident)*) => {$(
        impl<L: Discrete<$rule, N>, const N: usize> Methods<L, N> for $rule {
            type Run<'a> = Composed<'a, L, Self, N> where L: 'a;

            fn offers(method: Method) -> bool {
                matches!(method, Method::Rule | Method::KahanLi6 | Method::KahanLi8)
            }

            fn run<'a>(
                self,
                method: Method,
                system: &'a L,
                h: L::Scalar,
                state: State<L::Scalar, N>,
            ) -> Self::Run<'a> {
                Composed::new(self, method, system, h, state)
            }
        }
    )*};
}

rules! { Midpoint Trapezoidal Fitted FittedTrapezoidal }

/// What a wrapper adds to the methods of another: its runs, and which of them a method asks for.
macro_rules! added {
    ($with:ident: $system:ident, $(#[$doc:meta])* $or:ident {
        $($(#[$what:meta])* $method:ident($run:ty): $start:expr, $cost:expr;)*
    }) => {
        $(#[$doc])*
        pub enum $or<'a, L: $system<N>, R, const N: usize> {
            $($(#[$what])* $method($run),)*
            /// Of the others.
            Other(R),
        }

        impl<L: $system<N>, R: MethodRun<L, N>, const N: usize> MethodRun<L, N> for $or<'_, L, R, N> {
            fn state(&self) -> &State<L::Scalar, N> {
                match self {
                    $(Self::$method(run) => run.state(),)*
                    Self::Other(run) => run.state(),
                }
            }

            #[inline]
            fn advance(&mut self) -> Result<f64, StepError> {
                match self {
                    $(Self::$method(run) => run.next().map_or(Ok(0.0), |step| step.map($cost)),)*
                    Self::Other(run) => run.advance(),
                }
            }
        }

        impl<L: $system<N>, M: Methods<L, N>, const N: usize> Methods<L, N> for $with<M> {
            type Run<'a> = $or<'a, L, M::Run<'a>, N> where L: 'a;

            fn offers(method: Method) -> bool {
                matches!(method, $(Method::$method)|*) || M::offers(method)
            }

            fn run<'a>(
                self,
                method: Method,
                system: &'a L,
                h: L::Scalar,
                state: State<L::Scalar, N>,
            ) -> Self::Run<'a> {
                match method {
                    $(Method::$method => $or::$method($start(system, h, state)),)*
                    _ => $or::Other(self.0.run(method, system, h, state)),
                }
            }
        }
    };
}

// A kick and a drift, without an equation and its verdict, count as half a substep.
added! { WithSplittings: Explicit,
    /// A run by a splitting, or by a method of others.
    SplitOr {
        /// Order 4.
        BlanesMoan4(ComposedTrajectory<'a, L, Kicks<L::Scalar, N, 6>, N>):
            |system, h, state| Splitting::blanes_moan_4().trajectory(system, h, state), |_| 3.0;
        /// Order 6.
        BlanesMoan6(ComposedTrajectory<'a, L, Kicks<L::Scalar, N, 11>, N>):
            |system, h, state| Splitting::blanes_moan_6().trajectory(system, h, state), |_| 5.5;
    }
}

// An iteration evaluates all stages, two at once in the narrowest vector registers: it counts as half as many substeps.
added! { WithGauss: ForcedLagrangian,
    /// A run by a Gauss method, or by a method of others.
    GaussOr {
        /// Order 8.
        Gauss4(Trajectory<'a, L, Gauss<4>, N>):
            |system, h, state| Trajectory::<_, Gauss<4>, N>::new(system, Gauss, h, state),
            |step| 2.0 * f64::from(step.report.iterations);
        /// Order 16.
        Gauss8(Trajectory<'a, L, Gauss<8>, N>):
            |system, h, state| Trajectory::<_, Gauss<8>, N>::new(system, Gauss, h, state),
            |step| 4.0 * f64::from(step.report.iterations);
    }
}
