//! User functions that panic, and runs that break off: what was computed stays.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU32, Ordering};

use dalembert::nalgebra::{SVector, vector};
use dalembert::rules::{DisplacementRule, Fused};
use dalembert::step::{Momenta, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Discretise, Lagrangian, Midpoint, State, Trajectory};

/// A pendulum whose Lagrangian panics at a given call.
struct Panicking {
    calls: AtomicU32,
    at: u32,
}

impl Lagrangian<1> for Panicking {
    type Scalar = f64;

    fn lagrangian(&self, q: &SVector<f64, 1>, v: &SVector<f64, 1>) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn lagrangian_derivatives(&self, q: &SVector<f64, 1>, v: &SVector<f64, 1>) -> Derivatives<f64, 1> {
        let call = self.calls.fetch_add(1, Ordering::Relaxed);
        assert!(call != self.at, "a user's assertion");
        Derivatives {
            value: self.lagrangian(q, v),
            d1: vector![-q[0].sin()],
            d2: *v,
            d11: [[-q[0].cos()]].into(),
            d12: [[0.0]].into(),
            d22: [[1.0]].into(),
        }
    }
}

impl ActingForce<1> for Panicking {}

impl Fused<Midpoint, 1> for Panicking {
    type Matrix = dalembert::nalgebra::SMatrix<f64, 1, 1>;
    type Memory = dalembert::run::VelocityHistory<f64, 1>;
    type Border = dalembert::step::Free;

    fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
        Midpoint::lagrangian_kernel(self, segment)
    }

    fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
        Midpoint::lagrangian_momenta(self, segment)
    }
}

/// Wherever in a step the user's function panics, the trajectory holds the last state, and goes on from it as
/// if nothing had happened.
#[test]
fn a_user_function_that_panics() {
    let start = State { q: vector![0.4], p: vector![0.9] };
    let calm = Panicking { calls: AtomicU32::new(0), at: u32::MAX };
    let expected: Vec<_> =
        calm.by(Midpoint, 0.1).run(start).take(20).map(|step| step.unwrap().state).collect();
    let calls = calm.calls.load(Ordering::Relaxed);
    assert!(calls > 40);
    for at in 0..calls {
        let system = Panicking { calls: AtomicU32::new(0), at };
        let mut trajectory = system.by(Midpoint, 0.1).run(start);
        let mut states = Vec::new();
        let mut panics = 0;
        while states.len() < 20 {
            let before = *trajectory.state();
            let time = trajectory.time();
            match catch_unwind(AssertUnwindSafe(|| trajectory.next())) {
                Ok(step) => states.push(step.unwrap().unwrap().state),
                Err(_) => {
                    panics += 1;
                    assert_eq!((*trajectory.state(), trajectory.time()), (before, time));
                }
            }
        }
        assert_eq!((panics, &states), (1, &expected), "at call {at}");
    }
}

/// A run saved as text, in the middle, and read again goes on bit by bit as the one that was not interrupted;
/// also one that had changed its step size, and one whose state is odd.
#[test]
fn a_saved_run_goes_on_bit_by_bit() {
    let system = dalembert_tests::systems::DoublePendulum::EXAMPLE;
    for start in [[1.1, -0.6], [1e-310, 1.0 / 3.0], [-0.0, 1e15 + 0.125]] {
        let start = State { q: start.into(), p: vector![0.1, -1.0 / 7.0] };
        let mut run = system.by(Midpoint, 0.1).run(start);
        run.by_ref().take(37).for_each(|step| assert!(step.is_ok()));
        run.change_step_size(0.07);
        run.by_ref().take(13).for_each(|step| assert!(step.is_ok()));
        let text = serde_json::to_string(&run.checkpoint()).unwrap();
        let mut resumed = Trajectory::resume(&system, Midpoint, serde_json::from_str(&text).unwrap());
        assert_eq!(resumed.time().to_bits(), run.time().to_bits());
        for _ in 0..200 {
            let (a, b) = (run.next().unwrap().unwrap(), resumed.next().unwrap().unwrap());
            assert_eq!(a.state.q.map(f64::to_bits), b.state.q.map(f64::to_bits));
            assert_eq!(a.state.p.map(f64::to_bits), b.state.p.map(f64::to_bits));
        }
        assert_eq!(resumed.time().to_bits(), run.time().to_bits());
    }
    // The control: text that broke off is an error, not a state.
    let checkpoint =
        system.by(Midpoint, 0.1).run(State { q: vector![0.1, 0.2], p: vector![0.3, 0.4] }).checkpoint();
    let text = serde_json::to_string(&checkpoint).unwrap();
    for end in 0..text.len() {
        assert!(serde_json::from_str::<dalembert::Checkpoint<f64, 2>>(&text[..end]).is_err(), "{end}");
    }
}
