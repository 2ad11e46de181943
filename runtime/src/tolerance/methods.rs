//! Which methods a choice is among, and their runs.

use super::Method;
use crate::{
    ComposedTrajectory, Composition, Discrete, Fitted, FittedTrapezoidal, ForcedLagrangian, Gauss,
    Lagrangian, Midpoint, State, StepError, Trajectory, Trapezoidal,
};

/// The methods that a system offers to [`Method::for_tolerance`]: a rule of order 2 stands for itself and its compositions,
/// [`WithGauss`] adds Gauss methods.
pub trait Methods<L: Lagrangian<N>, const N: usize>: Copy {
    /// A run by any of the methods.
    type Run<'a>: MethodRun<L, N>
    where
        L: 'a;

    /// Whether there are [`Method::Gauss4`] and [`Method::Gauss8`].
    const HAS_GAUSS: bool;

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

/// The rule of order 2, its compositions, and Gauss methods of 4 and 8 stages: for systems of
/// `#[rayleigh_system(rule = [trapezoidal, gauss])]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithGauss<R>(pub R);

/// A run by a rule, or composed.
pub enum Composed<'a, L: Discrete<R, N>, R, const N: usize> {
    /// The rule alone.
    Rule(ComposedTrajectory<'a, L, R, N, 1>),
    /// Order 6.
    KahanLi6(ComposedTrajectory<'a, L, R, N, 9>),
    /// Order 8.
    KahanLi8(ComposedTrajectory<'a, L, R, N, 17>),
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
            const HAS_GAUSS: bool = false;

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

/// A run by a rule, composed, or by a Gauss method.
pub enum ComposedOrGauss<'a, L: Discrete<R, N> + ForcedLagrangian<N>, R, const N: usize> {
    /// The rule and its compositions.
    Composed(Composed<'a, L, R, N>),
    /// Order 8.
    Gauss4(Trajectory<'a, L, Gauss<4>, N>),
    /// Order 16.
    Gauss8(Trajectory<'a, L, Gauss<8>, N>),
}

impl<L: Discrete<R, N> + ForcedLagrangian<N>, R, const N: usize> MethodRun<L, N>
    for ComposedOrGauss<'_, L, R, N>
{
    fn state(&self) -> &State<L::Scalar, N> {
        match self {
            Self::Composed(run) => run.state(),
            Self::Gauss4(run) => run.state(),
            Self::Gauss8(run) => run.state(),
        }
    }

    /// An iteration evaluates all stages, two at once in the narrowest vector registers: it counts as half as many substeps.
    #[inline]
    fn advance(&mut self) -> Result<f64, StepError> {
        let (step, stages) = match self {
            Self::Composed(run) => return run.advance(),
            Self::Gauss4(run) => (run.next(), 4.0),
            Self::Gauss8(run) => (run.next(), 8.0),
        };
        step.map_or(Ok(0.0), |step| step.map(|step| 0.5 * stages * f64::from(step.report.iterations)))
    }
}

impl<L, R, const N: usize> Methods<L, N> for WithGauss<R>
where
    L: Discrete<R, N> + ForcedLagrangian<N>,
    R: Copy,
{
    type Run<'a>
        = ComposedOrGauss<'a, L, R, N>
    where
        L: 'a;
    const HAS_GAUSS: bool = true;

    fn run<'a>(
        self,
        method: Method,
        system: &'a L,
        h: L::Scalar,
        state: State<L::Scalar, N>,
    ) -> Self::Run<'a> {
        match method {
            Method::Gauss4 => {
                ComposedOrGauss::Gauss4(Trajectory::<_, Gauss<4>, N>::new(system, Gauss, h, state))
            }
            Method::Gauss8 => {
                ComposedOrGauss::Gauss8(Trajectory::<_, Gauss<8>, N>::new(system, Gauss, h, state))
            }
            _ => ComposedOrGauss::Composed(Composed::new(self.0, method, system, h, state)),
        }
    }
}
