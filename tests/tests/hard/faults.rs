//! User functions that panic, and runs that break off: what was computed stays.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU32, Ordering};

use dalembert::nalgebra::{SVector, vector};
use dalembert::{
    Derivatives, Discrete, DisplacementRule, Lagrangian, Midpoint, Momenta, State, StepKernel, Trajectory,
};

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

impl Discrete<Midpoint, 1> for Panicking {
    type Matrix = dalembert::nalgebra::SMatrix<f64, 1, 1>;
    type Memory = dalembert::VelocityHistory<f64, 1>;

    fn discrete_lagrangian(&self, q0: &SVector<f64, 1>, q1: &SVector<f64, 1>, h: f64) -> f64 {
        Midpoint::discrete_lagrangian(self, q0, q1, h)
    }

    fn discrete_lagrangian_derivatives(
        &self,
        q0: &SVector<f64, 1>,
        q1: &SVector<f64, 1>,
        h: f64,
    ) -> Derivatives<f64, 1> {
        Midpoint::discrete_lagrangian_derivatives(self, q0, q1, h)
    }

    fn step_kernel(&self, q0: &SVector<f64, 1>, v: &SVector<f64, 1>, h: f64) -> StepKernel<f64, 1> {
        Midpoint::lagrangian_kernel(self, q0, v, h)
    }

    fn momenta(&self, q0: &SVector<f64, 1>, v: &SVector<f64, 1>, h: f64) -> Momenta<f64, 1> {
        Midpoint::lagrangian_momenta(self, q0, v, h)
    }

    fn segment_energy(&self, q0: &SVector<f64, 1>, q1: &SVector<f64, 1>, h: f64) -> f64 {
        Midpoint::segment_energy(self, q0, q1, h)
    }
}

/// Wherever in a step the user's function panics, the trajectory holds the last state, and goes on from it as if nothing had
/// happened.
#[test]
fn a_user_function_that_panics() {
    let start = State { q: vector![0.4], p: vector![0.9] };
    let calm = Panicking { calls: AtomicU32::new(0), at: u32::MAX };
    let expected: Vec<_> =
        Trajectory::new(&calm, Midpoint, 0.1, start).take(20).map(|step| step.unwrap().state).collect();
    let calls = calm.calls.load(Ordering::Relaxed);
    assert!(calls > 40);
    for at in 0..calls {
        let system = Panicking { calls: AtomicU32::new(0), at };
        let mut trajectory = Trajectory::new(&system, Midpoint, 0.1, start);
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
