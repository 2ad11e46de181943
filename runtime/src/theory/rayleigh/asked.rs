//! Where the checkers of steps look: the states given, states beside them, each at a time of its own.

use crate::numbers::Scalar;
use crate::step::{Discretised, Flow, PhaseMatrix, State, StepError};
use crate::theory::restriction::{Ends, onto};
use crate::theory::samples::{Sizes, Stopped, around, at_segment, different};

/// The derivatives of a step at some states, on constraints as far as they are tangent to them.
pub(super) struct Asked<S, const N: usize> {
    /// At the states given, then beside the first of them, where a step can be taken.
    pub(super) derivatives: Vec<PhaseMatrix<S, N>>,
    /// How many of the states given lie apart, counted up to two.
    pub(super) different: usize,
    /// Whether the step moves one of them all by more than a derivative resolves.
    pub(super) moves: bool,
}

/// Why states are not asked.
pub(super) enum Unasked {
    /// The step of the state of this number, given, fails.
    Step(usize, StepError),
    /// The caller has ended the check.
    Stopped,
}

impl From<Stopped> for Unasked {
    fn from(Stopped: Stopped) -> Self {
        Self::Stopped
    }
}

/// The errors of a checker of steps from those of [`ask`].
macro_rules! from_unasked {
    ($error:ident) => {
        impl From<Unasked> for $error {
            fn from(unasked: Unasked) -> Self {
                match unasked {
                    Unasked::Step(sample, error) => Self::Step { sample, error },
                    Unasked::Stopped => Self::Stopped,
                }
            }
        }
    };
}
pub(super) use from_unasked;

/// Asks for the derivatives of the step at the `states`, the k-th k h after the time of the system, and at
/// states [`around`] the first of them, each a step later still: with one state a view is asked at 2N + 1
/// times.
///
/// # Errors
/// [`Unasked`].
pub(super) fn ask<L, M, const N: usize>(
    by: &Discretised<'_, L, M, N>,
    states: &[State<L::Scalar, N>],
) -> Result<Asked<L::Scalar, N>, Unasked>
where
    L: Flow<M, N>,
{
    let step_of = |by: &Discretised<'_, L, M, N>, state: &State<L::Scalar, N>| {
        let (step, a) = by.linearized_step(state)?;
        let ends = Ends::of(by, &state.q, &step.state.q)?;
        Ok::<_, StepError>((step, ends.map_or(a, |ends| ends.restricted(&a))))
    };
    let (mut derivatives, mut ends) = (Vec::new(), Vec::new());
    for (k, state) in states.iter().enumerate() {
        let (step, a) =
            at_segment(by, k, |by| step_of(by, state))?.map_err(|error| Unasked::Step(k, error))?;
        derivatives.push(a);
        ends.push(step.state);
    }
    // A coordinate that starts at 0 has the size that a step gives it.
    let sizes = Sizes::of(states.iter().chain(&ends).copied());
    let mut moves = states.iter().zip(&ends).any(|(state, end)| sizes.are_apart(state, end));
    for (k, state) in around(states, &sizes, [1.0, 1.0]).iter().enumerate() {
        let taken = at_segment(by, states.len() + k, |by| {
            let state = State { q: onto(by.system, &state.q)?, ..*state };
            Ok::<_, StepError>((state, step_of(by, &state)?))
        })?;
        // Beside the states given a system may end.
        if let Ok((state, (step, a))) = taken
            && is_finite(&a)
        {
            derivatives.push(a);
            moves |= Sizes::of([state, step.state]).are_apart(&state, &step.state);
        }
    }
    Ok(Asked { derivatives, different: different(states, &sizes, 2), moves })
}

fn is_finite<S: Scalar, const N: usize>(a: &PhaseMatrix<S, N>) -> bool {
    [&a.q_by_q, &a.q_by_p, &a.p_by_q, &a.p_by_p]
        .iter()
        .all(|block| block.iter().all(|entry| entry.widen().is_finite()))
}
