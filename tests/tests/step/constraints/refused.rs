//! Questions on constraints that have no answer, and errors that say why.

use dalembert::nalgebra::SVector;
use dalembert::{Discretise, Midpoint, State, StepError, Trapezoidal};

use super::{Spherical, on_the_sphere};

#[test]
fn reactions_are_those_of_the_state_and_the_step_size_of_the_step() -> Result<(), StepError> {
    let (q, v) = on_the_sphere();
    let system = Spherical { c: 0.4 };
    let start = State::from_velocity(&system, q, v)?;
    let (by, coarse) = (system.by(Midpoint, 0.01), system.by(Midpoint, 0.02));
    let (step, long) = (by.step(&start)?, coarse.step(&start)?);
    // Positive control: the question of each step itself has an answer, of all steps of a run.
    let answered: [SVector<f64, 1>; 2] = [by.reactions(&start, &step)?, coarse.reactions(&start, &long)?];
    assert!((answered[0] - answered[1]).amax() < 0.2, "{answered:?}");
    let mut state = start;
    for step in by.run(start).take(2_000) {
        let step = step?;
        let _: SVector<f64, 1> = by.reactions(&state, &step)?;
        state = step.state;
    }
    for (by, step, h, taken) in [(by, long, 0.01, 0.02), (coarse, step, 0.02, 0.01)] {
        let error = by.reactions::<1>(&start, &step).unwrap_err();
        let StepError::OtherStep { h: asked, taken: found } = error else { panic!("{error}") };
        assert!(asked == h && (found - taken).abs() < 1e-15, "{error}");
        assert!(error.to_string().contains("with the step size that it was taken with"), "{error}");
    }
    // A step back, one a millionth longer, and one from another state.
    let slightly = system.by(Midpoint, 0.01 * (1.0 + 1e-6)).step(&start)?;
    let later = by.step(&step.state)?;
    for other in [by.with_step(-0.01).step(&start)?, slightly, later] {
        let error = by.reactions::<1>(&start, &other).unwrap_err();
        assert!(matches!(error, StepError::OtherStep { .. }), "{error}");
    }
    let by = system.by(Trapezoidal, 0.01);
    assert!(by.reactions::<1>(&start, &system.by(Trapezoidal, 0.02).step(&start)?).is_err());
    Ok(())
}
