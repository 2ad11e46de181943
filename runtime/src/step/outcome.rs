//! A step taken, and how it went.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::step::{Momenta, PhaseMatrix, State, StepError};

/// How a step went.
///
/// | question | answer |
/// |---|---|
/// | how much work | `iterations`, `damped` |
/// | how well the equation is solved | `residual` against `floor`: at most 4 floors, in every coordinate |
/// | what is left of v̄ | at most about the square of `last_correction`, relative to v̄ |
/// | how well it was posed: condition of the Newton matrix, branch of the root | on request, [`Discretised::certificate`](crate::Discretised::certificate), so that steps do not pay for it |
///
/// **A step is solved**, by every rule, with or without a memory, and with `converged` of [`BoundedStep`],
/// where in each coordinate the residual is at most 4 round-off floors; the floor is that of the solution
/// returned, finite, and small beside the terms of the equation. It is 4ε (|p| + Σ |J||v̄|) with the Newton
/// matrix J, plus, where forces cancel, what the last places of q and v̄ do to the residual, measured. The
/// state returned then satisfies the rule's equations with q, v̄ and p changed by some units of their
/// last places. Whatever does not is an error; no step is taken on a residual that merely stopped falling.
///
/// **But for runs with a tolerance**, [`to_error`](crate::Discretise::to_error) and
/// [`Trajectory::solved_for`](crate::Trajectory::solved_for): steps of theirs by a Gauss rule may leave what
/// that error allows. `floor` is that allowance then, and `residual` what is left, as the contraction
/// measured foretells.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report<S> {
    /// Corrections: of v̄ by Newton's method, or by a matrix kept; by Gauss rules of all stages at once, by
    /// fixed point or Newton's method.
    pub iterations: u32,
    /// Iterations whose Newton step had to be shortened.
    pub damped: u32,
    /// |𝔽⁻(q0, q1) − p0| at the solution, as evaluated there, of the coordinate where it is largest in units of its floor.
    pub residual: S,
    /// The round-off floor that this residual was held against, in units of the same momentum.
    pub floor: S,
    /// Largest entry of the last correction of v̄.
    pub last_correction: S,
}

impl<S: Scalar> Report<S> {
    /// Of a step for which no equation was solved.
    #[inline]
    pub(crate) fn of_no_equation() -> Self {
        let none = S::zero();
        Self { iterations: 0, damped: 0, residual: none, floor: none, last_correction: none }
    }
}

/// A step taken: the new state, the mean velocity over the segment, and how the solver fared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S, const N: usize> {
    /// (q1, p1).
    pub state: State<S, N>,
    /// v̄ = (q1 − q0)/h, a good guess for the next step.
    pub velocity: SVector<S, N>,
    /// How the solver fared.
    pub report: Report<S>,
}

impl<S: Scalar, const N: usize> Step<S, N> {
    /// The step from `state` with mean velocity `velocity`, if it leads to finite numbers.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn completed(
        state: &State<S, N>,
        h: S,
        velocity: SVector<S, N>,
        momenta: &Momenta<S, N>,
        report: Report<S>,
    ) -> Result<Self, StepError> {
        // Added to the p0 given: the residual of the solver, always of one sign, would make it drift.
        let next = State { q: state.q + velocity * h, p: state.p + (momenta.p1 - momenta.p0) };
        next.require_reached()?;
        Ok(Self { state: next, velocity, report })
    }
}

/// A step, and its derivative A = ∂(q1, p1)/∂(q0, p0).
pub type LinearizedStep<S, const N: usize> = (Step<S, N>, PhaseMatrix<S, N>);

/// The equation of a step at the step that was taken; see
/// [`Discrete::equation_at`](crate::Discrete::equation_at).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquationAt<S, const N: usize> {
    /// p0.
    pub p0: SVector<S, N>,
    /// The Newton matrix ∂p0/∂v̄.
    pub matrix: SMatrix<S, N, N>,
    /// ∂²L/∂v² at q0 and the mean velocity.
    pub mass: SMatrix<S, N, N>,
    /// Whether the determinant of the equations has the sign that it has for small h.
    pub on_the_branch_of_the_flow: bool,
}

/// A step by a bounded number of iterations: the best iterate, and whether it is the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundedStep<S, const N: usize> {
    /// The step of the best iterate; its report has the residual that is left and the last correction.
    pub step: Step<S, N>,
    /// Whether the residual is at its round-off floor, so that the step is that of
    /// [`Discretised::step`](crate::Discretised::step).
    pub converged: bool,
}
