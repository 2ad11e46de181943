//! Runs on constraints: a tolerance, events, states between steps; each beside a motion in minimal
//! coordinates.

use dalembert::nalgebra::{Vector2, Vector3, vector};
use dalembert::{Composition, Discretise, Gauss, Midpoint, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;
use dalembert_tests::systems::{Hoist, HoistByAngle, rope};

/// At rest beside the rope, at an angle of .8.
fn start() -> Result<State<f64, 2>, StepError> {
    let (s, c) = 0.8_f64.sin_cos();
    State::from_velocity(&Hoist.at_time(0.0), [2.0 * s, -2.0 * c], [-0.35 * s, 0.35 * c])
}

fn angle(q: &Vector2<f64>) -> f64 {
    f64::atan2(q[0], -q[1])
}

/// The angle at a time, to 1e-13.
fn exact(time: f64) -> Result<f64, StepError> {
    let view = HoistByAngle.at_time(0.0);
    let steps = (time / 0.1).ceil() as usize;
    let start = State::from_velocity(&view, [0.8], [0.0])?;
    Ok(view.by(Gauss::<8>, time / steps as f64).run(start).nth(steps - 1).unwrap()?.state.q[0])
}

#[test]
fn an_error_asked_for_is_kept_on_constraints() -> Result<(), StepError> {
    let (system, start, time) = (Hoist, start()?, 6.0);
    let view = system.at_time(0.0);
    let mut most = 0.0_f64;
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9] {
        let reached = view.to_error(tolerance).until(time).end(&start).unwrap();
        // The error of q itself: the rope is as long as it should be.
        let error = (angle(&reached.state.q) - exact(time)?).abs() * rope(time)[0];
        assert!(error <= tolerance && reached.expected <= tolerance, "{tolerance:e}: {error:e}");
        assert!((reached.state.q.norm() - rope(time)[0]).abs() < 1e-14);
        most = most.max(error / tolerance);
    }
    // Positive control: runs err by about what is asked for, not by much less.
    assert!(most > 1e-3, "{most:e}");
    Ok(())
}

#[test]
fn events_and_states_between_steps_are_on_the_constraints() -> Result<(), StepError> {
    let (system, start) = (Hoist, start()?);
    let view = system.at_time(0.0);
    let mut run = view.by(Composition::kahan_li_8(Midpoint), 0.05).run(start);
    let mut passed = 0;
    for event in run.watch(|at| [at.q[0]]).until(8.0) {
        let event = event.unwrap();
        assert!(exact(event.time)?.abs() < 1e-11, "{} {:e}", event.time, exact(event.time)?);
        passed += 1;
    }
    assert!(passed > 4, "{passed}");
    // A step of another size leads to a state between, on the rope as it is then.
    let mut run = view.by(Composition::kahan_li_8(Midpoint), 0.05).run(start);
    let mut dense = run.dense();
    for _ in 0..12 {
        dense.next().unwrap()?;
        let [_, to] = dense.interval().unwrap();
        let (time, between) = (to - 0.017, dense.state_at(to - 0.017).unwrap());
        assert!((between.q.norm() - rope(time)[0]).abs() < 1e-14, "{time}");
        assert!((angle(&between.q) - exact(time)?).abs() < 1e-11, "{time}");
    }
    Ok(())
}

/// A slider, at the end of a rod of length `rod` on a crank of length 1 whose angle is given.
struct SliderCrank {
    rod: f64,
    rate: f64,
}

#[rayleigh_system]
impl SliderCrank {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + 0.3 * v[2] * v[2]) - q[1]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.1 * v[2] * v[2]
    }

    fn constraints(&self, q: [f64; 3], t: f64) -> [f64; 3] {
        [
            q[0] - self.rate * t - 0.1 * (3.0 * t).sin(),
            q[0].sin() - self.rod * q[1].sin(),
            q[0].cos() + self.rod * q[1].cos() - q[2],
        ]
    }
}

impl SliderCrank {
    fn place(&self, t: f64) -> Vector3<f64> {
        let crank = self.rate * t + 0.1 * (3.0 * t).sin();
        let rod = (crank.sin() / self.rod).asin();
        vector![crank, rod, crank.cos() + self.rod * rod.cos()]
    }
}

/// Where all that moves is prescribed, as for the torque that a machine needs, no error is too small.
#[test]
fn a_motion_that_is_prescribed_keeps_any_error() -> Result<(), Box<dyn core::error::Error>> {
    let mut draws = Draws::new(3);
    for _ in 0..if cfg!(debug_assertions) { 4 } else { 100 } {
        let system = SliderCrank { rod: draws.between(1.5, 3.0), rate: draws.between(0.5, 3.0) };
        let view = system.at_time(0.0);
        let start = State::nearest(&view, system.place(0.0), Vector3::zeros())?;
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let end = view.to_error(tolerance).until(3.0).end(&start)?.state;
            assert!((end.q - system.place(3.0)).amax() < 1e-13, "{tolerance:e}: {end:?}");
        }
    }
    Ok(())
}
