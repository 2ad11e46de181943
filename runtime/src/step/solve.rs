//! From the equation of a step to the step.

use nalgebra::SVector;

use crate::numbers::{Scalar, nonlinear::Way};
use crate::step::cause::{explained, explained_by_lagrangian};
use crate::step::equation::{Equation, StepEquation};
use crate::step::massless::Massless;
use crate::step::{
    BoundedStep, Segment, State, Step, StepError, newton,
    newton::{NotSolved, Solution, StepProblem},
    require_regular,
};
use crate::system::{Lagrangian, Quantity, derivatives_apart};

/// [`Flow::step`](crate::step::Flow::step) by the step's `equation`.
#[inline]
pub(crate) fn step_by<L, const N: usize>(
    system: &L,
    equation: &impl StepEquation<L::Scalar, N>,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    guess: Option<&SVector<L::Scalar, N>>,
) -> Result<Step<L::Scalar, N>, StepError>
where
    L: Lagrangian<N> + ?Sized,
{
    require_step_size(h)?;
    let start = match guess {
        Some(v) => *v,
        None => first_guess(system, equation.kind(), equation.takes_massless(), state)?,
    };
    let solution = match newton::quick(equation, state, h, start) {
        Ok(solution) => solution,
        Err(reached) => {
            // A guess is the caller's: from elsewhere there may be another root.
            let way = match guess {
                Some(_) => Way::Damped { iterations: reached.iterations },
                None => Way::Every { iterations: reached.iterations, start: start.as_slice() },
            };
            solved_at_length(system, equation, (state, h, guess), way, &reached.v)?
        }
    };
    completed(equation, (state, h, guess), &solution)
}

/// The step from the state alone by [`Way::Every`], where what the quick method has led to does not hold
/// ([`is_held`](StepEquation::is_held)).
///
/// # Errors
/// Those of [`step_by`].
#[cold]
#[inline(never)]
pub(crate) fn step_at_length_by<L, const N: usize>(
    system: &L,
    equation: &impl StepEquation<L::Scalar, N>,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
) -> Result<Step<L::Scalar, N>, StepError>
where
    L: Lagrangian<N> + ?Sized,
{
    let start = first_guess(system, equation.kind(), equation.takes_massless(), state)?;
    let way = Way::Every { iterations: 0, start: start.as_slice() };
    let solution = solved_at_length(system, equation, (state, h, None), way, &start)?;
    completed(equation, (state, h, None), &solution)
}

/// A state, h and a guess.
type Asked<'a, S, const N: usize> = (&'a State<S, N>, S, Option<&'a SVector<S, N>>);

fn solved_at_length<L, const N: usize>(
    system: &L,
    equation: &impl StepEquation<L::Scalar, N>,
    (state, h, guess): Asked<'_, L::Scalar, N>,
    way: Way<'_, L::Scalar>,
    from: &SVector<L::Scalar, N>,
) -> Result<Solution<L::Scalar, N>, StepError>
where
    L: Lagrangian<N> + ?Sized,
{
    let problem = StepProblem { equation, state, h };
    problem.solved(way, from).map_err(|NotSolved { error, lost }| {
        let error = explained(error, &|| equation.cause(&lost?));
        in_arguments(state, guess)
            .unwrap_or_else(|| of_any_step(system, state, equation.takes_massless(), error))
    })
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn completed<S: Scalar, const N: usize>(
    equation: &impl StepEquation<S, N>,
    (state, h, guess): Asked<'_, S, N>,
    solution: &Solution<S, N>,
) -> Result<Step<S, N>, StepError> {
    // An argument that is not finite shows here or has failed above: none is looked at before.
    Step::completed(state, h, solution.unknown, &solution.momenta, solution.report).map_err(|error| {
        in_arguments(state, guess).unwrap_or_else(|| {
            explained(error, &|| equation.cause(&Segment { q0: state.q, v: solution.unknown, h }))
        })
    })
}

/// The velocity of `state`; where none is found, rest: a step may lead on, as from p = 0 at a singular point
/// of L. Rest as well where the equation is linear: one correction leads from there to the root, with the
/// least rounding.
#[cold]
#[inline(never)]
fn first_guess<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    kind: Equation,
    takes_massless: bool,
    state: &State<L::Scalar, N>,
) -> Result<SVector<L::Scalar, N>, StepError> {
    let rest = nalgebra::zero();
    if kind == Equation::Linear {
        state.require_finite()?;
        return require_regular(&derivatives_apart(system, &state.q, &rest).d22)
            .or_else(|error| match takes_massless {
                true => Massless::of(system, &state.q).require_determined(system, &state.q, &rest),
                false => Err(error),
            })
            .map(|()| rest)
            .map_err(|error| explained_by_lagrangian(system, &state.q, &rest, error));
    }
    match state.velocity_by(system, takes_massless) {
        Ok(v) if StepError::require_finite(&v, Quantity::Velocity).is_ok() => Ok(v),
        Err(
            error @ (StepError::DegenerateLagrangian { .. }
            | StepError::SingularCoordinates { .. }
            | StepError::NoDerivative { .. }
            | StepError::NonFinite { .. }),
        ) => Err(error),
        _ => Ok(rest),
    }
}

/// [`BoundedFlow::step_within`](crate::step::BoundedFlow::step_within), likewise.
pub(crate) fn step_within_by<L, const N: usize>(
    system: &L,
    equation: &impl StepEquation<L::Scalar, N>,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    guess: Option<&SVector<L::Scalar, N>>,
    iterations: u32,
) -> Result<BoundedStep<L::Scalar, N>, StepError>
where
    L: Lagrangian<N> + ?Sized,
{
    require_step_size(h)?;
    state.require_finite()?;
    let guess = match guess {
        Some(v) => *v,
        None => first_guess(system, equation.kind(), equation.takes_massless(), state)?,
    };
    StepError::require_finite(&guess, Quantity::Velocity)?;
    let (solution, converged) = newton::bounded(equation, iterations, state, h, guess)?;
    let step =
        Step::completed(state, h, solution.unknown, &solution.momenta, solution.report).map_err(|error| {
            explained(error, &|| equation.cause(&Segment { q0: state.q, v: solution.unknown, h }))
        })?;
    Ok(BoundedStep { step, converged })
}

/// The first argument that is not finite: the cause, where a step has failed.
#[cold]
fn in_arguments<S: Scalar, const N: usize>(
    state: &State<S, N>,
    guess: Option<&SVector<S, N>>,
) -> Option<StepError> {
    let of_guess = || guess.map_or(Ok(()), |v| StepError::require_finite(v, Quantity::Velocity));
    state.require_finite().and_then(|()| of_guess()).err()
}

/// The `error` of a step that a shorter one would have too, in place of one that asks for it: the state has
/// no velocity.
#[cfg_attr(feature = "std", cold)]
#[cfg_attr(feature = "std", inline(never))]
#[cfg_attr(not(feature = "std"), inline(always))]
pub(crate) fn of_any_step<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    takes_massless: bool,
    error: StepError,
) -> StepError {
    let asks_for_another = matches!(
        error,
        StepError::SingularNewtonMatrix { .. }
            | StepError::NoRealSolution { .. }
            | StepError::NotConverged { .. }
    );
    if !cfg!(feature = "std") || !asks_for_another {
        return error;
    }
    match state.velocity_by(system, takes_massless) {
        Err(
            of_state @ (StepError::DegenerateLagrangian { .. }
            | StepError::SingularCoordinates { .. }
            | StepError::NoVelocity { .. }),
        ) => of_state,
        _ => error,
    }
}

/// The step `found`, from a guess if there was one. A guess that leads nowhere is not the step's fault: then
/// the step `without`.
///
/// Both are asked for where they are needed: a function that asks for both would be another copy of the
/// solver.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn or_without_guess<S, const N: usize>(
    has_guess: bool,
    mut found: Result<Step<S, N>, StepError>,
    without: impl FnOnce() -> Result<Step<S, N>, StepError>,
) -> Result<Step<S, N>, StepError> {
    if has_guess && found.is_err() {
        found = without();
    }
    found
}

/// Fails where `h` is 0 or not finite.
///
/// # Errors
/// [`StepError::StepSize`].
#[inline]
pub fn require_step_size<S: Scalar>(h: S) -> Result<(), StepError> {
    if h.is_finite() && h != S::zero() { Ok(()) } else { Err(StepError::StepSize { h: h.widen() }) }
}
