//! Neither a step nor a trajectory allocates, whether steps succeed, are damped or fail.

use allocation_counter::measure;
use dalembert::nalgebra::{SVector, vector};
use dalembert::{
    Composition, Discretise, Gauss, Midpoint, Splitting, State, StepError, Trapezoidal, rayleigh_system,
};
use dalembert_tests::systems::{Chain, Charge, DoublePendulum, Pendulum};

fn assert_no_allocation(run: impl FnOnce()) {
    let count = measure(run);
    assert_eq!((count.count_total, count.bytes_total), (0, 0));
}

/// Positive control.
#[test]
fn the_counter_counts() {
    let count = measure(|| {
        std::hint::black_box(vec![1_u8; 100]);
    });
    assert_eq!((count.count_total, count.bytes_total), (1, 100));
}

#[test]
fn none_in_a_step() {
    let start = State::from_velocity(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2]).unwrap();
    assert_no_allocation(|| {
        let step = DoublePendulum::EXAMPLE.by(Midpoint, 0.1).step(&start).unwrap();
        DoublePendulum::EXAMPLE.by(Trapezoidal, 0.1).near(&step.velocity).step(&start).unwrap();
        DoublePendulum::EXAMPLE.by(Midpoint, 0.1).step_configurations(&start.q, &step.state.q).unwrap();
        step.state.energy(&DoublePendulum::EXAMPLE).unwrap();
    });
}

#[test]
fn none_in_a_trajectory() {
    let chain = State::from_velocity(&Chain::EXAMPLE, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0; 5]).unwrap();
    let charge = State::from_velocity(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]).unwrap();
    assert_no_allocation(|| {
        let mut chain = Chain::EXAMPLE.by(Midpoint, 0.1).run(chain);
        let mut charge = Charge::EXAMPLE.by(Trapezoidal, 0.1).run(charge);
        for _ in 0..200 {
            chain.next().unwrap().unwrap();
            charge.next().unwrap().unwrap();
        }
        charge.sample_every(10).take(10).for_each(|sample| assert!(sample.is_ok()));
    });
}

#[test]
fn none_in_a_composition_or_a_splitting() {
    let system = Pendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.1], [0.4]).unwrap();
    assert_no_allocation(|| {
        system
            .by(Composition::kahan_li_8(Midpoint), 0.1)
            .run(start)
            .take(50)
            .for_each(|s| assert!(s.is_ok()));
        system.by(Splitting::blanes_moan_6(), 0.1).run(start).take(50).for_each(|s| assert!(s.is_ok()));
    });
}

/// A pendulum with a motor in its joint and a moving pivot.
struct Motor {
    c: f64,
}

#[rayleigh_system(rule = [midpoint, gauss], parameters = c, step_derivatives = second)]
impl Motor {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn force(&self, q: [f64; 1], v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        [u[0] - self.c * v[0] + t.sin() * q[0].cos()]
    }
}

#[test]
fn none_in_the_derivatives_of_a_step() {
    let motor = Motor { c: 0.1 };
    let state = State::from_velocity(&motor, [1.1], [0.3]).unwrap();
    assert_no_allocation(|| {
        let driven = motor.driven([0.4], 0.2);
        let end = driven.by(Midpoint, 0.1).step(&state).unwrap().state;
        macro_rules! ask {
            ($step:expr) => {
                let step = $step.unwrap();
                step.by_state().unwrap();
                step.by_input::<1>().unwrap();
                step.by_parameters::<1>().unwrap();
                step.hessian::<1>(&state).unwrap();
            };
        }
        ask!(driven.by(Midpoint, 0.1).linearized(&state));
        ask!(driven.by(Midpoint, 0.1).segment(&state.q, &end.q).unwrap().linearized());
        ask!(driven.by(Gauss::<3>, 0.1).linearized(&state));
        ask!(driven.by(Gauss::<3>, 0.1).segment(&state.q, &end.q).unwrap().linearized());
        // Nor where there is none to be found.
        let nowhere = vector![f64::INFINITY];
        assert!(driven.by(Gauss::<3>, 0.1).segment(&state.q, &nowhere).is_err());
    });
}

/// Cubic drag, R = r v³/3.
#[rayleigh_system]
fn cubic_drag(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.0 * q[0], r * v[0].powi(3) / 3.0)
}

#[test]
fn none_in_a_step_that_fails() {
    let system = CubicDrag { m: 1.0, r: 1.0 };
    let state = State { q: SVector::zeros(), p: vector![-10.0] };
    assert_no_allocation(|| {
        let error = system.by(Midpoint, 1.0).step(&state).unwrap_err();
        assert!(matches!(error, StepError::NoRealSolution { .. }));
    });
}
