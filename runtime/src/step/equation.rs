//! The equation of a step as its solver asks it.

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::cause::cause_of;
use crate::step::massless::inertia;
use crate::step::{Discrete, Ending, Fused, Momenta, OfFormula, Segment, StepError, StepKernel};

/// The kind of the equation p0(q, v) = p, as known before it is solved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Equation {
    /// Linear in v: the first correction leads to the root.
    Linear,
    /// Any equation.
    General,
}

/// The equation p0(q0, v̄) = p of a step, with the functions that its solver asks for.
pub(crate) trait StepEquation<S: Scalar, const N: usize> {
    /// The form of the Newton matrix.
    type Matrix: NewtonMatrix<S, N>;

    /// p0 and ∂p0/∂v̄.
    fn kernel(&self, segment: &Segment<S, N>) -> StepKernel<S, N, Self::Matrix>;

    /// p0 and p1.
    fn momenta(&self, segment: &Segment<S, N>) -> Momenta<S, N>;

    /// The correction of v̄ that the matrix of the last kernel makes of a residual, where the equation has
    /// that matrix factored already.
    #[inline]
    fn correction(&self, residual: &SVector<S, N>) -> Option<SVector<S, N>> {
        let _ = residual;
        None
    }

    /// A correction without what leads off the constraints on the segment, where there are any; no number
    /// where they are singular.
    fn along_constraints(
        &self,
        segment: &Segment<S, N>,
        correction: &SVector<S, N>,
    ) -> Option<SVector<S, N>> {
        let _ = (segment, correction);
        None
    }

    /// Whether what the residual does not see holds at its root.
    fn is_held(&self, segment: &Segment<S, N>) -> bool {
        let _ = segment;
        true
    }

    /// The mass that the velocity has in p0 at the start of a segment, and what friction makes of it where
    /// there is none: the metric that tells which of two velocities is longer.
    fn inertia(&self, segment: &Segment<S, N>) -> SMatrix<S, N, N>;

    /// Sizes of the terms that cancel in p0.
    fn cancelling(&self, segment: &Segment<S, N>) -> SVector<S, N> {
        let _ = segment;
        nalgebra::zero()
    }

    /// Sizes of what may hold a coordinate beside p, v and forces: beside it their roundings are none.
    fn holding(&self, segment: &Segment<S, N>) -> SVector<S, N> {
        let _ = segment;
        nalgebra::zero()
    }

    /// The floor of a residual with what is added to that of the terms of p0.
    #[inline]
    fn floor(&self, floor: SVector<S, N>) -> SVector<S, N> {
        floor
    }

    /// From here on values are compared with one another: kernel and momenta have to be functions of the
    /// segment alone.
    fn compare(&self) {}

    /// The kind of the equation.
    fn kind(&self) -> Equation
    where
        Self: Sized,
    {
        Equation::General
    }

    /// Whether it is one for coordinates without mass too: [`Flow::TAKES_MASSLESS`](crate::step::Flow).
    fn takes_massless(&self) -> bool
    where
        Self: Sized,
    {
        false
    }

    /// The cause of numbers that are not finite.
    fn cause(&self, segment: &Segment<S, N>) -> Option<StepError>
    where
        Self: Sized,
    {
        let _ = segment;
        None
    }
}

/// The equation of a system by a rule that is solved for v̄ itself, with the momenta that `E` takes.
pub(crate) struct OfRule<'a, L: ?Sized, R, E = OfFormula> {
    system: &'a L,
    rule: PhantomData<fn() -> (R, E)>,
}

impl<'a, L: ?Sized, R, E> OfRule<'a, L, R, E> {
    #[inline]
    pub(crate) fn new(system: &'a L) -> Self {
        Self { system, rule: PhantomData }
    }
}

impl<L, R, E, const N: usize> StepEquation<L::Scalar, N> for OfRule<'_, L, R, E>
where
    L: Fused<R, N> + Discrete<R, N> + ?Sized,
    E: Ending<L, R, N>,
{
    type Matrix = L::Matrix;

    #[inline]
    fn kernel(&self, segment: &Segment<L::Scalar, N>) -> StepKernel<L::Scalar, N, L::Matrix> {
        self.system.step_kernel(segment)
    }

    #[inline]
    fn momenta(&self, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        E::momenta(self.system, segment)
    }

    #[inline]
    fn inertia(&self, segment: &Segment<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        inertia(self.system, &segment.q0, &segment.v, segment.h)
    }

    #[inline]
    fn cancelling(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        Fused::<R, N>::cancelling_terms(self.system, segment)
    }

    #[inline]
    fn kind(&self) -> Equation {
        if <L as Fused<R, N>>::LINEAR { Equation::Linear } else { Equation::General }
    }

    #[inline]
    fn takes_massless(&self) -> bool {
        L::TAKES_MASSLESS
    }

    #[inline]
    fn cause(&self, segment: &Segment<L::Scalar, N>) -> Option<StepError> {
        cause_of(self.system, self.system.without_derivative_on(segment))
    }
}

/// An equation alone, momentum(q, v) = p, at whose root no other momentum is asked for.
pub(crate) struct Alone<K, P, I> {
    /// The momentum and its Newton matrix at (q, v).
    pub(crate) kernel: K,
    /// The momentum.
    pub(crate) momentum: P,
    /// The mass matrix.
    pub(crate) inertia: I,
}

impl<S, M, K, P, I, const N: usize> StepEquation<S, N> for Alone<K, P, I>
where
    S: Scalar,
    M: NewtonMatrix<S, N>,
    K: Fn(&SVector<S, N>, &SVector<S, N>) -> StepKernel<S, N, M>,
    P: Fn(&SVector<S, N>, &SVector<S, N>) -> SVector<S, N>,
    I: Fn(&SVector<S, N>, &SVector<S, N>) -> SMatrix<S, N, N>,
{
    type Matrix = M;

    #[inline]
    fn kernel(&self, segment: &Segment<S, N>) -> StepKernel<S, N, M> {
        (self.kernel)(&segment.q0, &segment.v)
    }

    #[inline]
    fn momenta(&self, segment: &Segment<S, N>) -> Momenta<S, N> {
        let p = (self.momentum)(&segment.q0, &segment.v);
        Momenta { p0: p, p1: p }
    }

    #[inline]
    fn inertia(&self, segment: &Segment<S, N>) -> SMatrix<S, N, N> {
        (self.inertia)(&segment.q0, &segment.v)
    }
}
