//! The border of a step's equation: what holds the motion beside L, R and f.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Factored;
use crate::step::{
    BoundedStep, LegendreDerivatives, Momenta, MomentaBy, PhaseMatrix, Segment, State, StateBy, Step,
    StepError,
};
use crate::system::Lagrangian;

/// The border of the equation of a step by rule `R`: what holds the motion beside L, R and f, and how the
/// step is solved with it. It alone knows how many multipliers there are.
///
/// A system names it: [`Free`](crate::step::Free), or [`Constraints`](crate::step::Constraints).
pub trait Border<L: Lagrangian<N> + ?Sized, R, const N: usize> {
    /// The border's share of the equations at a step, linearised and factored.
    type Linearized;

    /// The border's share of the equation of a step that is solved with a Newton matrix of an earlier one.
    type Underway;

    /// [`Flow::step`](crate::step::Flow::step).
    ///
    /// # Errors
    /// Those of [`Flow::step`](crate::step::Flow::step).
    fn step(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError>;

    /// [`BoundedFlow::step_within`](crate::step::BoundedFlow::step_within).
    ///
    /// # Errors
    /// Those of [`BoundedFlow::step_within`](crate::step::BoundedFlow::step_within).
    fn step_within(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError>;

    /// The border on the segment of a guess for the step, with the Newton matrix of an earlier one,
    /// `factored`; nothing where the general way has to say why.
    fn underway(
        system: &L,
        guess: &Segment<L::Scalar, N>,
        factored: &impl Factored<L::Scalar, N>,
    ) -> Option<Self::Underway>;

    /// The residual p0 − p of the equation with its border on a segment, where `momenta` are those without,
    /// and then those with it; the correction of v̄ is what the matrix makes of it.
    #[inline]
    fn residual(
        underway: &Self::Underway,
        system: &L,
        segment: &Segment<L::Scalar, N>,
        factored: &impl Factored<L::Scalar, N>,
        p: &SVector<L::Scalar, N>,
        momenta: &mut Momenta<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        let _ = (underway, system, segment, factored);
        momenta.p0 - p
    }

    /// The floor of a residual with what reactions add to it, where p0 is `without` and `with` them.
    #[inline]
    fn floor(
        floor: SVector<L::Scalar, N>,
        without: &SVector<L::Scalar, N>,
        with: &SVector<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        let _ = (without, with);
        floor
    }

    /// Whether the border is off on a segment by more than rounding, which the residual may not show.
    #[inline]
    fn is_off(underway: &Self::Underway, system: &L, segment: &Segment<L::Scalar, N>) -> bool {
        let _ = (underway, system, segment);
        false
    }

    /// The step that was solved for, complete; nothing where the general way has to say why.
    fn completed(system: &L, step: Step<L::Scalar, N>, h: L::Scalar) -> Option<Step<L::Scalar, N>>;

    /// The state that the border allows and that is nearest; nothing where there is none in reach.
    #[inline]
    fn nearest(system: &L, state: &State<L::Scalar, N>) -> Option<State<L::Scalar, N>> {
        let _ = system;
        Some(*state)
    }

    /// ∂q1/∂p0 at fixed q0, and the border's share of the equations on the `segment` of a step, where its
    /// momenta have the derivatives `k`; from the momentum `p0`, if it is a step that was taken.
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] where the step has no derivative, [`StepError::NonFinite`].
    fn linearized(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        p0: Option<&SVector<L::Scalar, N>>,
        k: &LegendreDerivatives<L::Scalar, N>,
    ) -> Result<(SMatrix<L::Scalar, N, N>, Self::Linearized), StepError>;

    /// A = ∂(q1, p1)/∂(q0, p0).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_state(
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
    ) -> Result<PhaseMatrix<L::Scalar, N>, StepError>;

    /// The derivatives of (q1, p1) by what moves the momenta so at fixed ends.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn answer<const P: usize>(
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError>;

    /// [`answer`](Self::answer) where it is an input that moves the momenta, and by `at_end` the forces at
    /// (q, v) of the end.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    #[inline]
    fn answer_input<const P: usize>(
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
        momenta: &MomentaBy<L::Scalar, N, P>,
        at_end: impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        let _ = at_end;
        Self::answer(k, q_by_p, at, momenta)
    }
}

/// A border whose constraints, if there are any, have derivatives by the P parameters of the system.
pub trait BorderParameters<L: Lagrangian<N> + ?Sized, R, const N: usize, const P: usize>:
    Border<L, R, N>
{
    /// The derivatives of (q1, p1) by the parameters, which move the momenta so at fixed ends.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn answer_parameters(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError>;
}
