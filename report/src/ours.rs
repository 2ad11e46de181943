//! This project's methods. One line adds one.

use anyhow::Result;
use dalembert::{Composition, Discrete, Gauss, Midpoint, State, Trajectory, Trapezoidal};

use crate::scenes::Scene;

/// A run of a number of steps of size h.
pub type Steps<S, const N: usize> = fn(&S, &State<f64, N>, f64, u32) -> Result<State<f64, N>>;

/// All of them, for a scene.
pub fn methods<S: Scene<N>, const N: usize>() -> Vec<(&'static str, Steps<S, N>)> {
    vec![
        ("midpoint", |s, start, h, n| run(s, Midpoint, start, h, n)),
        ("trapezoidal", |s, start, h, n| run(s, Trapezoidal, start, h, n)),
        ("trapezoidal, Kahan–Li 6", |s, start, h, n| {
            composed(s, Composition::kahan_li_6(Trapezoidal), start, h, n)
        }),
        ("trapezoidal, Kahan–Li 8", |s, start, h, n| {
            composed(s, Composition::kahan_li_8(Trapezoidal), start, h, n)
        }),
        ("Gauss, 2 stages", |s, start, h, n| run(s, Gauss::<2>, start, h, n)),
        ("Gauss, 4 stages", |s, start, h, n| run(s, Gauss::<4>, start, h, n)),
        ("Gauss, 6 stages", |s, start, h, n| run(s, Gauss::<6>, start, h, n)),
        ("Gauss, 8 stages", |s, start, h, n| run(s, Gauss::<8>, start, h, n)),
    ]
}

fn run<S, R, const N: usize>(
    scene: &S,
    rule: R,
    start: &State<f64, N>,
    h: f64,
    steps: u32,
) -> Result<State<f64, N>>
where
    S: Discrete<R, N, Scalar = f64>,
{
    let mut trajectory = Trajectory::new(scene, rule, h, *start);
    for step in trajectory.by_ref().take(steps as usize) {
        step?;
    }
    Ok(*trajectory.state())
}

fn composed<S, R, const N: usize, const STAGES: usize>(
    scene: &S,
    composition: Composition<R, STAGES>,
    start: &State<f64, N>,
    h: f64,
    steps: u32,
) -> Result<State<f64, N>>
where
    S: Discrete<R, N, Scalar = f64>,
{
    let mut trajectory = composition.trajectory(scene, h, *start);
    for step in trajectory.by_ref().take(steps as usize) {
        step?;
    }
    Ok(*trajectory.state())
}
