//! An error as `main` and `unwrap` print it: by `Debug`, which says what is wrong and what to do.

use std::error::Error;

use dalembert::nalgebra::vector;
use dalembert::run::events::EventError;
use dalembert::{Discretise, Lagrangian, Midpoint, State, rayleigh_system};

#[rayleigh_system(rule = midpoint)]
fn ball(q: [f64; 1], v: [f64; 1], c: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0], c * v[0].abs().powf(1.5))
}

/// The text of an error that is returned by `main`.
fn printed(error: impl Error + 'static) -> String {
    let by_main: Box<dyn Error> = Box::new(error);
    format!("{by_main:?}")
}

#[test]
fn errors_print_what_they_say() {
    let ball = Ball { c: 0.1 };
    let state = State { q: vector![0.0], p: vector![0.0] };
    let step = ball.by(Midpoint, 0.0).step(&state).unwrap_err();
    assert_eq!(printed(step), "step size 0 is zero or not finite; give a finite h ≠ 0");
    let without = ball.without_derivative(&state.q, &vector![0.0]).unwrap();
    assert_eq!(printed(without), without.to_string());
    let event = EventError::Step(step);
    assert_eq!(printed(event), step.to_string());
    let unwrapped = std::panic::catch_unwind(|| State::from_velocity(&ball, [f64::NAN], [0.0]).unwrap());
    let text = *unwrapped.unwrap_err().downcast::<String>().unwrap();
    assert!(
        text.ends_with("the configuration given is NaN or infinite in coordinate 0; give finite numbers"),
        "{text}"
    );
}
