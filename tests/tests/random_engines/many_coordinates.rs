//! Dual numbers of as many coordinates as they are let: the stack of a thread holds them, and the derivatives
//! are those written out.

use std::thread;

use dalembert::nalgebra::SVector;
use dalembert::step::Step;
use dalembert::{
    Discretise, Gauss, Lagrangian, Midpoint, Rayleigh, State, StepError, Trapezoidal, rayleigh_system,
};

macro_rules! chain {
    ($name:ident, $engine:ident) => {
        struct $name;

        #[rayleigh_system(derivatives = $engine, rule = [midpoint, trapezoidal, gauss])]
        impl $name {
            fn lagrangian(&self, q: [f64; 32], v: [f64; 32]) -> f64 {
                let mut l = 0.0;
                for i in 0..32 {
                    l += 0.5 * v[i] * v[i] + q[i].cos();
                }
                for i in 1..32 {
                    let d = q[i] - q[i - 1];
                    l -= (1.0 + d * d).sqrt() + 0.1 * v[i] * v[i - 1] * d;
                }
                l
            }

            fn rayleigh(&self, q: [f64; 32], v: [f64; 32]) -> f64 {
                let mut r = 0.0;
                for i in 0..32 {
                    r += 0.05 * (1.0 + q[i] * q[i]) * v[i] * v[i];
                }
                r
            }
        }
    };
}

chain!(ByDualNumbers, num_dual);
chain!(Expanded, expanded);

/// The largest difference of two families of numbers.
fn difference<'a>(a: impl IntoIterator<Item = &'a f64>, b: impl IntoIterator<Item = &'a f64>) -> f64 {
    a.into_iter().zip(b).fold(0.0, |largest, (a, b)| largest.max((a - b).abs()))
}

fn start() -> State<f64, 32> {
    let q = SVector::<f64, 32>::from_fn(|i, _| (0.7 * i as f64).sin());
    let v = SVector::<f64, 32>::from_fn(|i, _| (1.3 * i as f64).cos());
    State::from_velocity(&ByDualNumbers, q, v).unwrap()
}

/// On a thread with a stack of so many MiB.
fn on_a_stack_of(mebibytes: usize, run: fn()) {
    thread::Builder::new().stack_size(mebibytes << 20).spawn(run).unwrap().join().unwrap();
}

#[test]
fn thirty_two_coordinates_by_dual_numbers_fit_into_a_thread_and_are_right() {
    on_a_stack_of(2, || {
        let state = start();
        let (q, v) = (state.q, state.velocity(&Expanded).unwrap());
        let (a, b) = (ByDualNumbers.lagrangian_derivatives(&q, &v), Expanded.lagrangian_derivatives(&q, &v));
        assert!(difference(&a.d1, &b.d1) < 1e-14 && difference(&a.d2, &b.d2) < 1e-14);
        for (a, b) in [(a.d11, b.d11), (a.d12, b.d12), (a.d22, b.d22)] {
            assert!(difference(&a, &b) < 1e-14);
        }
        assert_eq!(a.value, b.value);
        let (a, b) = (ByDualNumbers.rayleigh_gradient(&q, &v), Expanded.rayleigh_gradient(&q, &v));
        assert!(difference(&a.d1, &b.d1) < 1e-14 && difference(&a.d2, &b.d2) < 1e-14);
    });
    on_a_stack_of(2, || {
        same(ByDualNumbers.by(Midpoint, 0.05).step(&start()), Expanded.by(Midpoint, 0.05).step(&start()));
    });
    on_a_stack_of(2, || {
        same(
            ByDualNumbers.by(Trapezoidal, 0.05).step(&start()),
            Expanded.by(Trapezoidal, 0.05).step(&start()),
        );
    });
    // Without optimisation the matrix of all stages is copied on its way, whoever makes the derivatives.
    on_a_stack_of(if cfg!(debug_assertions) { 8 } else { 2 }, || {
        same(ByDualNumbers.by(Gauss::<2>, 0.05).step(&start()), Expanded.by(Gauss::<2>, 0.05).step(&start()));
    });
}

fn same(a: Result<Step<f64, 32>, StepError>, b: Result<Step<f64, 32>, StepError>) {
    let (a, b) = (a.unwrap().state, b.unwrap().state);
    assert!(difference(&a.q, &b.q) < 1e-12 && difference(&a.p, &b.p) < 1e-12);
}
