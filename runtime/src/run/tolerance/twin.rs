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

#[cfg(test)]
mod tests {
    use super::super::phase::times;
    use super::*;
    use crate::{Discretise, Midpoint, rayleigh_system};

    /// A load on a rope that is let out.
    struct Crane;

    #[rayleigh_system]
    impl Crane {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1]) - 9.81 * q[1]
        }

        fn constraints(&self, q: [f64; 2], t: f64) -> [f64; 1] {
            let length = 1.0 + 0.5 * t;
            [q[0] * q[0] + q[1] * q[1] - length * length]
        }
    }

    /// An error at the time `elapsed` as a twin carries it over two steps of the rule, as the derivatives of
    /// these do, and as it was.
    fn carried_two_ways(elapsed: f64) -> [State<f64, 2>; 3] {
        let h = 0.1;
        let start = State::nearest(&Crane.at_time(elapsed), [0.6, -0.8], [0.4, 0.1]).unwrap();
        let error = State { q: [3e-7, 1e-7].into(), p: [-2e-7, 5e-7].into() };
        let (mut state, mut by_steps) = (start, error);
        for k in 0..2 {
            let later = Crane.at_time(elapsed + f64::from(k) * h);
            let (step, a) = later.by(Midpoint, h).linearized_step(&state).unwrap();
            (state, by_steps) = (step.state, times(&a, &by_steps));
        }
        let (view, scale) = (Crane.at_time(0.0), Scale::new(&start));
        let span = [elapsed, 2.0 * h, 0.9 * ANGLE / h];
        let (by_twin, _) = carried((&view, Midpoint), &start, &error, span, &scale, &mut None).unwrap();
        [by_twin, by_steps, error]
    }

    #[test]
    fn a_twin_is_put_on_the_constraints_of_its_own_time() {
        for elapsed in [0.0, 0.8, 3.0] {
            let [by_twin, by_steps, before] = carried_two_ways(elapsed);
            let apart = |a: &State<f64, 2>, b: &State<f64, 2>| (a.q - b.q).amax().max((a.p - b.p).amax());
            assert!(apart(&by_twin, &by_steps) < 1e-12, "{elapsed}: {by_twin:?} {by_steps:?}");
            // Positive control: an error that is not carried is another.
            assert!(apart(&before, &by_steps) > 1e-7);
        }
    }
}
