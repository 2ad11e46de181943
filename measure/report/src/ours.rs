//! This project's methods. One line adds one.

use std::marker::PhantomData;

use anyhow::{Context, Result};
use dalembert::run::Explicit;
use dalembert::step::Flow;
use dalembert::system::{ForcedLagrangian, TimeScale};
use dalembert::{
    Composition, Discrete, Discretise, Gauss, Midpoint, Splitting, State, Trajectory, Trapezoidal,
};

/// A run of a number of steps of size h.
pub type Steps<S, const N: usize> = fn(&S, &State<f64, N>, f64, u32) -> Result<State<f64, N>>;

/// Those that every scene has.
pub fn methods<S, const N: usize>() -> Vec<(&'static str, Steps<S, N>)>
where
    S: Discrete<Midpoint, N, Scalar = f64> + Discrete<Trapezoidal, N> + ForcedLagrangian<N>,
{
    vec![
        ("midpoint", |s, start, h, n| run(s, Midpoint, start, h, n)),
        ("trapezoidal", |s, start, h, n| run(s, Trapezoidal, start, h, n)),
        ("trapezoidal, Kahan–Li 6", |s, start, h, n| {
            run(s, Composition::kahan_li_6(Trapezoidal), start, h, n)
        }),
        ("trapezoidal, Kahan–Li 8", |s, start, h, n| {
            run(s, Composition::kahan_li_8(Trapezoidal), start, h, n)
        }),
        ("Gauss, 2 stages", |s, start, h, n| run(s, Gauss::<2>, start, h, n)),
        ("Gauss, 4 stages", |s, start, h, n| run(s, Gauss::<4>, start, h, n)),
        ("Gauss, 6 stages", |s, start, h, n| run(s, Gauss::<6>, start, h, n)),
        ("Gauss, 8 stages", |s, start, h, n| run(s, Gauss::<8>, start, h, n)),
    ]
}

/// A run of a number of steps of size h, with a tolerance at its end.
pub type StepsTo<S, const N: usize> = fn(&S, &State<f64, N>, f64, u32, f64) -> Result<State<f64, N>>;

/// Those that make use of a tolerance.
pub fn to_an_error<S, const N: usize>() -> Vec<(&'static str, StepsTo<S, N>)>
where
    S: ForcedLagrangian<N, Scalar = f64>,
{
    vec![
        ("Gauss, 4 stages, to an error", solved_for::<S, N, 4>),
        ("Gauss, 6 stages, to an error", solved_for::<S, N, 6>),
        ("Gauss, 8 stages, to an error", solved_for::<S, N, 8>),
    ]
}

/// What scenes add whose trapezoidal rule is explicit.
pub struct Splittings<S, const N: usize>(PhantomData<S>);

impl<S: Explicit<N, Scalar = f64> + 'static, const N: usize> Splittings<S, N> {
    /// The splittings.
    pub const ALL: &'static [(&'static str, Steps<S, N>)] = &[
        ("Blanes–Moan 4", |s, start, h, n| {
            run::<S, Splitting<6>, N>(s, Splitting::blanes_moan_4(), start, h, n)
        }),
        ("Blanes–Moan 6", |s, start, h, n| {
            run::<S, Splitting<11>, N>(s, Splitting::blanes_moan_6(), start, h, n)
        }),
        ("Blanes–Casas–Escorihuela 8", |s, start, h, n| {
            run::<S, Splitting<19>, N>(s, Splitting::blanes_casas_escorihuela_8(), start, h, n)
        }),
    ];
}

/// What scenes add that have a time scale.
pub struct InScaledTime<S, const N: usize>(PhantomData<S>);

impl<S, const N: usize> InScaledTime<S, N>
where
    S: ForcedLagrangian<N, Scalar = f64> + TimeScale<N> + 'static,
{
    /// By steps equal in τ, about as many as there would be of one size.
    pub const ALL: &'static [(&'static str, Steps<S, N>)] = &[
        ("Gauss, 4 stages, in scaled time", scaled::<S, N, 4>),
        ("Gauss, 6 stages, in scaled time", scaled::<S, N, 6>),
        ("Gauss, 8 stages, in scaled time", scaled::<S, N, 8>),
    ];
}

fn scaled<S, const N: usize, const STAGES: usize>(
    scene: &S,
    start: &State<f64, N>,
    h: f64,
    steps: u32,
) -> Result<State<f64, N>>
where
    S: ForcedLagrangian<N, Scalar = f64> + TimeScale<N>,
{
    // τ goes about twice as fast as t.
    let (end, step) = (h * f64::from(steps), 2.0 * h);
    let mut run = scene.by(Gauss::<STAGES>, step).run(*start).in_scaled_time();
    // The last one by a part of the step that passes the end.
    let sample = run.sample_at([end]).next().context("the run ends before")??;
    Ok(sample.state)
}

/// The state after so many steps of size h by a method.
///
/// # Errors
/// Those of steps.
pub fn run<S, M, const N: usize>(
    scene: &S,
    method: M,
    start: &State<f64, N>,
    h: f64,
    steps: u32,
) -> Result<State<f64, N>>
where
    S: Flow<M, N, Scalar = f64>,
{
    end(scene.by(method, h).run(*start), steps)
}

fn solved_for<S, const N: usize, const STAGES: usize>(
    scene: &S,
    start: &State<f64, N>,
    h: f64,
    steps: u32,
    error: f64,
) -> Result<State<f64, N>>
where
    S: ForcedLagrangian<N, Scalar = f64>,
{
    end(scene.by(Gauss::<STAGES>, h).run(*start).solved_for(error, h * f64::from(steps)), steps)
}

fn end<S: Flow<M, N, Scalar = f64>, M, const N: usize>(
    mut trajectory: Trajectory<'_, S, M, N>,
    steps: u32,
) -> Result<State<f64, N>> {
    for step in trajectory.by_ref().take(steps as usize) {
        step?;
    }
    Ok(*trajectory.state())
}
