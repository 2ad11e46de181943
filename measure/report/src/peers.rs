//! Other people's methods, at their best documented settings, on the same accelerations compiled the same
//! way. One line adds one.

use std::marker::PhantomData;

use anyhow::{Context, Result};

use crate::scenes::Accelerated;

mod differential_equations;
#[cfg(feature = "diffsol")]
mod diffsol;
mod ode_solvers;
pub mod python;

/// The most steps of a run: what takes more has come apart, and two of the methods store every step.
const MOST_STEPS: u32 = 10_000_000;

/// A method's run over `time` from y = (q, v) with relative and absolute tolerance alike.
pub type Adaptive<S, const M: usize> = fn(&S, &[f64; M], f64, f64) -> Result<[f64; M]>;

/// Those written in Rust, for a scene with N coordinates and M = 2N.
pub fn methods<S: Accelerated<N>, const N: usize, const M: usize>() -> Vec<(&'static str, Adaptive<S, M>)> {
    vec![
        ("ode_solvers Dop853", ode_solvers::dop853::<S, N, M>),
        ("differential-equations dop853", differential_equations::dop853::<S, N, M>),
        #[cfg(feature = "diffsol")]
        ("diffsol tsit45", diffsol::tsit45::<S, N, M>),
    ]
}

/// The equations of motion of first order, for y = (q, v).
struct Motion<'a, S, const N: usize> {
    scene: &'a S,
    dimension: PhantomData<[f64; N]>,
}

impl<'a, S: Accelerated<N>, const N: usize> Motion<'a, S, N> {
    fn new(scene: &'a S) -> Self {
        Self { scene, dimension: PhantomData }
    }

    /// (v, a) at y.
    #[inline]
    fn rate(&self, y: &[f64], rate: &mut [f64]) {
        let [q, v] = [y.first_chunk::<N>(), y.last_chunk::<N>()].map(|half| half.expect("2N numbers"));
        let (first, second) = rate.split_at_mut(N);
        first.copy_from_slice(v);
        second.copy_from_slice(&self.scene.acceleration(q, v));
    }
}

/// The last of a solver's outputs.
pub fn last<T>(outputs: &[T]) -> Result<&T> {
    outputs.last().context("no output")
}
