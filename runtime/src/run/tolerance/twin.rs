//! An error carried along by two motions side by side: what a step of the rule makes of the state and of the
//! state with a share of the error. Of many coordinates that costs less than J's matrices.

use nalgebra::ComplexField;

use super::scale::Scale;
use super::{Method, MethodStep, Methods};
use crate::numbers::Scalar;
use crate::step::State;
use crate::system::ActingForce;

/// The angle in one step of the rule at most, by a rate that is one to two times that of the fastest mode.
const ANGLE: f64 = 2.0;

/// Steps of the rule for one of the run at most.
const MOST: f64 = 8.0;

/// A step of the rule, kept from one carrying to the next with its size.
pub(super) type Kept<M> = Option<(f64, M)>;

/// Steps of size `h` that one step of the rule may cover where the fastest mode turns at `rate`: `most`, or
/// fewer.
pub(super) fn stride(rate: f64, h: f64, most: u64) -> u64 {
    (ANGLE / (rate * h)).clamp(1.0, most as f64) as u64
}

/// The `error` at `state` carried on by `time`, and the cost in evaluations; `None` where the motions cannot
/// be followed.
pub(super) fn carried<L, M, const N: usize>(
    (system, methods): (&L, M),
    state: &State<L::Scalar, N>,
    error: &State<L::Scalar, N>,
    [elapsed, time, rate]: [f64; 3],
    scale: &Scale<L::Scalar, N>,
    kept: &mut Kept<M::Step>,
) -> Option<(State<L::Scalar, N>, f64)>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    let number = L::Scalar::constant;
    let parts = ComplexField::ceil(rate * time / ANGLE).clamp(1.0, MOST);
    let tau = time / parts;
    let apart = ComplexField::sqrt(L::Scalar::EPSILON.widen()) * scale.furthest.widen();
    let share = number(apart / scale.norm(error));
    let beside = State { q: state.q + error.q * share, p: state.p + error.p * share };
    let beside = system.later(number(elapsed), |system| methods.nearest(system, &beside))?;
    let mut evaluations = 0.0;
    if kept.as_ref().is_none_or(|(size, _)| *size != tau) {
        *kept = methods.step(Method::Rule, number(tau)).map(|step| (tau, step));
    }
    let (_, step) = kept.as_mut()?;
    let mut end = |mut state: State<L::Scalar, N>| {
        step.forget();
        for k in 0..parts as u32 {
            let taken = step.advance(system, elapsed + f64::from(k) * tau, &state).ok()?;
            evaluations += taken.evaluations;
            state = taken.step.state;
        }
        Some(state)
    };
    let (from, to) = (end(*state)?, end(beside)?);
    let carried = State { q: (to.q - from.q) / share, p: (to.p - from.p) / share };
    let is_finite = carried.q.iter().chain(&carried.p).all(|x| x.is_finite());
    is_finite.then_some((carried, evaluations))
}
