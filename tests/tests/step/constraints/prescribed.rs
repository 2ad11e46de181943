//! Constraints that depend on time, beside coordinates that the time prescribes.

use dalembert::{Composition, Discretise, Gauss, Midpoint, State, StepError, Trapezoidal};
use dalembert_tests::systems::{Hoist, HoistByAngle, rope};

fn start() -> ([f64; 2], [f64; 2]) {
    let [length, rate] = rope(0.0);
    let (angle, turn) = (0.8_f64, 0.5);
    let (s, c) = (angle.sin(), angle.cos());
    ([length * s, -length * c], [rate * s + length * turn * c, -rate * c + length * turn * s])
}

#[test]
fn a_load_on_a_moving_rope_goes_as_its_angle_does() -> Result<(), StepError> {
    let view = HoistByAngle.at_time(0.0);
    let by_angle = State::from_velocity(&view, [0.8], [0.5])?;
    let angle = view.by(Gauss::<6>, 0.1).run(by_angle).nth(39).unwrap()?.state.q[0];
    let (q, v) = start();
    let view = Hoist.at_time(0.0);
    let on_rope = State::from_velocity(&view, q, v)?;
    let error = |state: State<f64, 2>| (f64::atan2(state.q[0], -state.q[1]) - angle).abs();
    let midpoint = [100, 200].map(|steps| {
        error(view.by(Midpoint, 4.0 / steps as f64).run(on_rope).nth(steps - 1).unwrap().unwrap().state)
    });
    let trapezoidal = [100, 200].map(|steps| {
        error(view.by(Trapezoidal, 4.0 / steps as f64).run(on_rope).nth(steps - 1).unwrap().unwrap().state)
    });
    for [coarse, fine] in [midpoint, trapezoidal] {
        assert!((1.97..2.03).contains(&(coarse / fine).log2()), "{coarse:e} {fine:e}");
    }
    let mut run = view.by(Composition::kahan_li_8(Midpoint), 0.02).run(on_rope);
    let last = run.nth(199).unwrap()?.state;
    assert!(error(last) < 1e-12, "{:e}", error(last));
    // At the end of each substep the rope is as long as it should be.
    assert!((last.q.norm() - rope(4.0)[0]).abs() < 4.0 * f64::EPSILON);
    Ok(())
}

#[test]
fn a_start_that_the_rope_leaves_behind_is_refused() -> Result<(), StepError> {
    let (q, _) = start();
    let view = Hoist.at_time(0.0);
    let still = State::from_velocity(&view, q, [0.0; 2]).unwrap_err();
    // 2 l·l̇, by which the rope alone moves the constraint.
    assert!(
        matches!(still, StepError::LeavesConstraint { rate, .. } if (rate - 1.4).abs() < 1e-14),
        "{still}"
    );
    let later = State::from_velocity(&Hoist.at_time(0.5), q, [0.0; 2]).unwrap_err();
    assert!(matches!(later, StepError::OffConstraint { .. }), "{later}");
    let nearest = State::nearest(&view, q, [0.0; 2])?;
    assert!((nearest.q.dot(&nearest.p) / 1.5 - rope(0.0)[0] * rope(0.0)[1]).abs() < 1e-14);
    Ok(())
}
