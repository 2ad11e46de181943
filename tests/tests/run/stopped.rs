//! Requests end where the caller says so.

use std::sync::atomic::{AtomicU64, Ordering};

use dalembert::run::Stop;
use dalembert::tolerance::ToleranceError;
use dalembert::{Discretise, State, rayleigh_system};

#[rayleigh_system(rule = [trapezoidal, gauss])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// Looks after which a search that is stopped is given up, none of which takes a step.
const GIVEN_UP: u64 = 200;

#[test]
fn a_request_to_an_error_ends_at_whichever_look_it_is_told_to() {
    let (system, start) = (Pendulum { r: 1e-3 }, State { q: [1.0].into(), p: [0.0].into() });
    let looks = AtomicU64::new(0);
    let request = || system.to_error(1e-9).until(400.0);
    let count = || {
        looks.fetch_add(1, Ordering::Relaxed);
        false
    };
    // Control: looked at and not told to end, it comes to the bits that it comes to alone.
    let whole = request().stopped_by(Stop::when(&count)).end(&start).unwrap();
    assert_eq!(whole.state, request().end(&start).unwrap().state);
    let all = looks.load(Ordering::Relaxed);
    assert!(all > 10, "{all}");
    for last in 0..all {
        looks.store(0, Ordering::Relaxed);
        let is_asked = || looks.fetch_add(1, Ordering::Relaxed) >= last;
        let stopped = request().stopped_by(Stop::when(&is_asked)).end(&start);
        assert_eq!(stopped.unwrap_err(), ToleranceError::Stopped, "at look {last} of {all}");
        assert!(looks.load(Ordering::Relaxed) < last + GIVEN_UP);
    }
}
