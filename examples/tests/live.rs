//! RK4 of the page in examples/browser against that of the crate `differential-equations`.

#[path = "../browser/src/runge_kutta.rs"]
mod runge_kutta;

use anyhow::Result;
use dalembert::{State, rayleigh_system};
use dalembert_examples::baseline::{self, Method};
use runge_kutta::{Motion, runge_kutta_4};

/// The page's double pendulum: its mass matrix depends on q, and ∂²L/∂v∂q does not vanish.
struct DoublePendulum {
    friction: f64,
    gravity: f64,
}

#[rayleigh_system]
impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let kinetic = v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos();
        kinetic + self.gravity * (2.0 * q[0].cos() + q[1].cos())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.friction * (v[0] * v[0] + (v[1] - v[0]).powi(2))
    }
}

/// The largest difference of states over 100 steps, the library’s of 0.02 and the page’s of `h`.
fn difference(h: f64) -> Result<f64> {
    let system = DoublePendulum { friction: 0.3, gravity: 9.81 };
    let start = State::from_velocity(&system, [1.0, 1.5], [0.3, -0.2])?;
    let mut motion = Motion::from_columns(&[[1.0, 1.5].into(), [0.3, -0.2].into()]);
    let mut largest: f64 = 0.0;
    for state in baseline::states(&system, Method::RungeKutta4, 0.02, start)?.take(100) {
        motion = runge_kutta_4(&system, h, &motion);
        let other = State::from_velocity(&system, motion.column(0), motion.column(1))?;
        let state = state?;
        largest = largest.max((other.q - state.q).amax()).max((other.p - state.p).amax());
    }
    Ok(largest)
}

#[test]
fn rk4_of_the_page_is_that_of_the_library() -> Result<()> {
    let found = difference(0.02)?;
    assert!(found < 1e-12, "{found:e}");
    // The control: steps of another size.
    assert!(difference(0.02 * (1.0 + 1e-6))? > 1e-8);
    Ok(())
}
