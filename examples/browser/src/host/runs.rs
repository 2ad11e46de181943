//! The runs of the page as this machine makes them, a line a step: the run, the number of the step, and the
//! bits of q, p and the energy. The variational ones are runs in Rust, not the functions that the page calls.
//!
//! Each begins as the page's does; after [`STEPS`] steps the friction changes, after [`MORE`] further ones
//! the step size.

use crate::model::{DoublePendulum, Motion, Ring, runge_kutta_4};
use dalembert::run::DrivenTrajectory;
use dalembert::step::Flow;
use dalembert::{Discretise, Gauss, Midpoint, Rayleigh, State, StepError, Trapezoidal};

/// Steps as the page begins.
const STEPS: u32 = 2500;
/// Steps with other friction, and then of another size.
const MORE: u32 = 100;

/// A scene as the page begins it: page/scenes.js has the same numbers.
struct Scene<L> {
    name: &'static str,
    system: L,
    changed: L,
    h: f64,
    q: [f64; 2],
    v: [f64; 2],
}

fn show(run: &str, step: u32, state: &State<f64, 2>, energy: f64) {
    print!("{run} {step}");
    for number in state.q.iter().chain(state.p.iter()).chain([&energy]) {
        print!(" {:016x}", number.to_bits());
    }
    println!();
}

impl<L: Rayleigh<2, Scalar = f64> + 'static> Scene<L> {
    /// The run by a rule, with steps of `h` times `share`.
    fn by<M: Copy>(&self, rule: &str, method: M, share: f64) -> Result<(), StepError>
    where
        L: Flow<M, 2>,
    {
        let (name, h) = (format!("{}_{rule}", self.name), share * self.h);
        let start = State::from_velocity(&self.system, self.q, self.v)?;
        let mut run = self.system.by(method, h).run_with_inputs(start);
        for step in 1..=STEPS + 2 * MORE {
            if step == STEPS + 1 {
                run = DrivenTrajectory::resume(run.present());
            }
            if step == STEPS + MORE + 1 {
                run.change_step_size(0.5 * h);
            }
            let system = if step > STEPS { &self.changed } else { &self.system };
            run.advance(system)?;
            show(&name, step, run.state(), run.state().energy(system)?);
        }
        Ok(())
    }

    fn by_runge_kutta(&self) -> Result<(), StepError> {
        let name = format!("{}_runge_kutta", self.name);
        let mut motion = Motion::from_columns(&[self.q.into(), self.v.into()]);
        for step in 1..=STEPS + 2 * MORE {
            let system = if step > STEPS { &self.changed } else { &self.system };
            let h = if step > STEPS + MORE { 0.5 * self.h } else { self.h };
            motion = runge_kutta_4(system, h, &motion);
            let state = State::from_velocity(system, motion.column(0), motion.column(1))?;
            show(&name, step, &state, state.energy(system)?);
        }
        Ok(())
    }
}

macro_rules! runs {
    ($scene:expr) => {{
        let scene = $scene;
        scene.by("midpoint", Midpoint, 1.0)?;
        scene.by("trapezoidal", Trapezoidal, 1.0)?;
        scene.by("gauss", Gauss::<2>, 1.0)?;
        scene.by("reference", Gauss::<4>, 0.25)?;
        scene.by_runge_kutta()?;
    }};
}

pub fn print() -> Result<(), StepError> {
    runs!(Scene {
        name: "ring",
        system: Ring { friction: 1e-3 },
        changed: Ring { friction: 1e-2 },
        h: 0.2,
        q: [0.0, 1.155_499_186_749_82],
        v: [0.5, 0.0],
    });
    runs!(Scene {
        name: "double_pendulum",
        system: DoublePendulum { friction: 0.0, gravity: 9.81 },
        changed: DoublePendulum { friction: 0.1, gravity: 9.81 },
        h: 0.02,
        q: [2.0, 2.5],
        v: [0.0, 0.0],
    });
    Ok(())
}
