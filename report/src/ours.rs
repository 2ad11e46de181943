//! This project's methods. One line adds one.

use std::marker::PhantomData;

use anyhow::Result;
use dalembert::run::{ComposedStep, ComposedTrajectory, Explicit};
use dalembert::{
    Composition, Discrete, Discretise, Gauss, Lagrangian, Midpoint, Splitting, State, Trapezoidal,
};

use crate::scenes::Scene;

/// A run of a number of steps of size h.
pub type Steps<S, const N: usize> = fn(&S, &State<f64, N>, f64, u32) -> Result<State<f64, N>>;

/// All of them, for a scene.
pub fn methods<S: Scene<N>, const N: usize>() -> Vec<(&'static str, Steps<S, N>)> {
    let mut methods: Vec<(&'static str, Steps<S, N>)> = vec![
        ("midpoint", |s, start, h, n| run(s, Midpoint, start, h, n)),
        ("trapezoidal", |s, start, h, n| run(s, Trapezoidal, start, h, n)),
        ("trapezoidal, Kahan–Li 6", |s, start, h, n| {
            to_end(Composition::kahan_li_6(Trapezoidal).trajectory(s, h, *start), n)
        }),
        ("trapezoidal, Kahan–Li 8", |s, start, h, n| {
            to_end(Composition::kahan_li_8(Trapezoidal).trajectory(s, h, *start), n)
        }),
        ("Gauss, 2 stages", |s, start, h, n| run(s, Gauss::<2>, start, h, n)),
        ("Gauss, 4 stages", |s, start, h, n| run(s, Gauss::<4>, start, h, n)),
        ("Gauss, 6 stages", |s, start, h, n| run(s, Gauss::<6>, start, h, n)),
        ("Gauss, 8 stages", |s, start, h, n| run(s, Gauss::<8>, start, h, n)),
    ];
    methods.extend(S::SPLITTINGS);
    methods
}

/// What scenes add whose trapezoidal rule is explicit.
pub struct Splittings<S, const N: usize>(PhantomData<S>);

impl<S: Explicit<N, Scalar = f64> + 'static, const N: usize> Splittings<S, N> {
    /// The splittings.
    pub const ALL: &'static [(&'static str, Steps<S, N>)] = &[
        ("Blanes–Moan 4", |s, start, h, n| to_end(Splitting::blanes_moan_4().trajectory(s, h, *start), n)),
        ("Blanes–Moan 6", |s, start, h, n| to_end(Splitting::blanes_moan_6().trajectory(s, h, *start), n)),
    ];
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
    let mut trajectory = scene.by(rule, h).run(*start);
    for step in trajectory.by_ref().take(steps as usize) {
        step?;
    }
    Ok(*trajectory.state())
}

fn to_end<L, C, const N: usize>(
    mut trajectory: ComposedTrajectory<'_, L, C, N>,
    steps: u32,
) -> Result<State<f64, N>>
where
    L: Lagrangian<N, Scalar = f64>,
    C: ComposedStep<L, N>,
{
    for step in trajectory.by_ref().take(steps as usize) {
        step?;
    }
    Ok(*trajectory.state())
}
