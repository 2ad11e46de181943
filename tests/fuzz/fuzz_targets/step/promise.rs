//! What a step promises: finite numbers, and a residual within 4096 of its round-off floors, or explained by
//! what one rounding of q or v changes.
//!
//! Written apart from the solver, from its documentation. The solver holds each component against its own
//! floor, by the matrix of the iterate before the last correction; the one at the root can be smaller by any
//! factor where a component of the force happens to vanish. All coordinates of a system here have the same
//! unit, and it is held to the largest residual and floor.

use dalembert::State;
use dalembert::nalgebra::{SVector, zero};
use dalembert::step::{Fused, NewtonMatrix, Segment, Step};
use dalembert::system::Scalar;

/// Floors within which a residual that has stopped falling is accepted.
const STAGNATION: f64 = 4096.0;

/// Floors, estimated or measured, within which it is a root's. Between the matrix that the solver held it
/// against and the one at the root the floor may differ.
const ROOT: f64 = 4.0;
const SLACK: f64 = 16.0;

/// Checks the step itself.
pub fn finite<S: Scalar, const N: usize>(state: &State<S, N>, h: S, step: &Step<S, N>) {
    let all = [&state.q, &state.p, &step.state.q, &step.state.p, &step.velocity];
    assert!(
        all.iter().all(|vector| vector.iter().all(|entry| entry.is_finite())),
        "{state:?} {h:?} {step:?}"
    );
    assert!(h.is_finite() && h != S::zero(), "{state:?} {h:?} {step:?}");
    let report = &step.report;
    assert!(report.residual.is_finite() && report.residual >= S::zero(), "{step:?}");
    assert!(report.iterations <= 101 && report.damped <= report.iterations, "{step:?}");
    // Where rounding alone is left, the correction says nothing, and may overflow.
    let is_rounding = report.residual.widen() <= ROOT * report.floor.widen();
    assert!(report.last_correction.is_finite() || is_rounding, "{step:?}");
    let limit = report.floor.widen() * STAGNATION;
    assert!(report.residual == S::zero() || report.residual.widen() <= limit, "{step:?}");
}

/// Checks that the velocity of the step solves its equation, and that the report says how well.
pub fn solved<L, R, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    step: &Step<L::Scalar, N>,
) where
    L: Fused<R, N>,
{
    let (q, v) = (&state.q, &step.velocity);
    let p0 = |q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>| {
        system.momenta(&Segment { q0: *q, v: *v, h }).p0
    };
    let residual = (p0(q, v) - state.p).abs();
    assert!(
        residual.iter().any(|entry| *entry == step.report.residual),
        "{residual} is not that of {step:?}"
    );
    let epsilon = L::Scalar::EPSILON.widen();
    let matrix = system.step_kernel(&Segment { q0: *q, v: *v, h }).matrix;
    let value = p0(q, v);
    let mut rounding: SVector<L::Scalar, N> = zero();
    for i in 0..N {
        for factor in [1.0 + epsilon, 1.0 - epsilon] {
            let factor = L::Scalar::constant(factor);
            let (mut moved_q, mut moved_v) = (*q, *v);
            moved_q[i] *= factor;
            moved_v[i] *= factor;
            rounding += (p0(&moved_q, v) - value).abs() + (p0(q, &moved_v) - value).abs();
        }
    }
    let largest = |of: &dyn Fn(usize) -> f64| (0..N).map(of).fold(0.0, f64::max);
    let floor = largest(&|i| {
        let terms: f64 =
            (0..N).map(|j| (matrix.entry(i, j).widen() * v[j].widen() * 4.0 * epsilon).abs()).sum();
        terms + 4.0 * epsilon * state.p[i].widen().abs() + L::Scalar::SMALLEST_NORMAL.widen()
    });
    let limit = SLACK * (STAGNATION * floor).max(ROOT * (floor + largest(&|i| rounding[i].widen())));
    let size = largest(&|i| residual[i].widen());
    // Where the matrix at the root overflows there is nothing to hold it against.
    assert!(size <= limit || !limit.is_finite(), "{size:e} > {limit:e}\n{state:?} {h:?}\n{step:?}");
}
