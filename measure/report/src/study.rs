//! One scene by all methods: which settings are worth a run, and what the runs' ends say.

use anyhow::Result;
use dalembert::nalgebra::SVector;
use dalembert::{Lagrangian, State};
use serde::{Deserialize, Serialize};

use crate::measure::{Candidate, interleaved, timed};
use crate::peers::python::Python;
use crate::scenes::Scene;
use crate::{ours, peers, reference};

/// A measured run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub scene: String,
    pub method: String,
    /// Number of steps where the method has equal ones, tolerance where it chooses them.
    pub setting: f64,
    /// Of one trajectory, median.
    pub seconds: f64,
    pub position_error: f64,
    pub momentum_error: f64,
    pub energy_error: f64,
}

/// Seconds after which a method's settings are not refined further.
const LONGEST: f64 = 0.06;

/// Position errors between which settings are worth a run.
const WORTH: std::ops::Range<f64> = 1e-14..0.3;

/// Runs of a scene by every method and setting, all in turns.
///
/// # Errors
/// The scene has no reference, or its start is not regular.
pub fn scene<S: Scene<N>, const N: usize, const M: usize>(
    name: &str,
    scene: &S,
    python: Option<&Python>,
) -> Result<Vec<Record>> {
    let reference = reference::of(name)?;
    let [q, v, end_q, end_v] = [&reference.start_q, &reference.start_v, &reference.end_q, &reference.end_v]
        .map(|x| SVector::<f64, N>::from_column_slice(x));
    let start = State::from_velocity(scene, q, v)?;
    let end = State::from_velocity(scene, end_q, end_v)?;
    let energy = scene.energy(&end_q, &end_v);
    let time = reference.time;
    let mut y = [0.0; M];
    y[..N].copy_from_slice(q.as_slice());
    y[N..].copy_from_slice(v.as_slice());

    let error = |state: &State<f64, N>| (state.q - end.q).amax();
    let mut candidates: Vec<Candidate<'_, State<f64, N>>> = Vec::new();
    // From steps of length 4 on.
    let count = |k: i32| (time * 2_f64.sqrt().powi(k)).ceil();
    for (method, steps) in S::methods() {
        candidates.extend(worth((-4..56).map(count), error, |setting| {
            let run = move || steps(scene, &start, time / setting, setting as u32);
            Candidate { method, setting, run: timed(run, Ok) }
        }));
    }
    for (method, steps) in ours::to_an_error::<S, N>() {
        candidates.extend(worth((-4..56).map(count), error, |setting| {
            let (h, n) = (time / setting, setting as u32);
            // Asked for is the error that these steps have, as far as it is known here by the reference.
            let solved = steps(scene, &start, h, n, 0.0);
            let run = move || {
                let asked = error(solved.as_ref().map_err(|error| anyhow::anyhow!("{error:#}"))?);
                steps(scene, &start, h, n, asked)
            };
            Candidate { method, setting, run: timed(run, Ok) }
        }));
    }
    for (method, integrate) in peers::methods::<S, N, M>() {
        candidates.extend(worth((2..30).map(|k| 10_f64.powf(-0.5 * f64::from(k))), error, |setting| {
            let run = move || integrate(scene, &y, time, setting);
            Candidate { method, setting, run: timed(run, |y| state(scene, &y)) }
        }));
    }
    if let Some(python) = python {
        for &method in &python.methods {
            let tolerances = (1..8).map(|k| 10_f64.powi(-2 * k)).chain([f64::EPSILON]);
            candidates.extend(worth(tolerances, error, |setting| {
                let run = move |repeats| {
                    let (seconds, y) = python.run::<M>(method, name, setting, repeats, 1)?;
                    Ok((seconds, state(scene, &y[0])?))
                };
                Candidate { method, setting, run: Box::new(run) }
            }));
        }
    }
    let records = interleaved(candidates).into_iter().map(|measured| Record {
        scene: name.into(),
        method: measured.method.into(),
        setting: measured.setting,
        seconds: measured.seconds,
        position_error: error(&measured.end),
        momentum_error: (measured.end.p - end.p).amax(),
        energy_error: measured.end.energy(scene).map_or(f64::NAN, |e| (e - energy).abs()),
    });
    Ok(records.collect())
}

/// Of the settings, from the coarsest to the finest, those that tell something: not far off, not long after
/// the error has reached what rounding leaves.
fn worth<'a, E>(
    settings: impl Iterator<Item = f64>,
    error: impl Fn(&E) -> f64,
    candidate: impl Fn(f64) -> Candidate<'a, E>,
) -> Vec<Candidate<'a, E>> {
    let mut kept = Vec::new();
    let (mut least, mut since, mut cheapest) = (f64::INFINITY, 0, f64::INFINITY);
    for setting in settings {
        let mut candidate = candidate(setting);
        // What fails at a coarse setting may succeed at a finer one.
        let Ok((seconds, end)) = (candidate.run)(1) else { continue };
        let error = error(&end);
        if error < WORTH.end {
            kept.push(candidate);
            (least, since) = if error < 0.5 * least { (error, 0) } else { (least, since + 1) };
        }
        // The coarsest runs of a method that iterates may be the dearest.
        cheapest = cheapest.min(seconds);
        if (seconds > LONGEST && seconds > 2.0 * cheapest)
            || error < WORTH.start
            || (since > 4 && least < 1e-9)
        {
            break;
        }
    }
    kept
}

/// (q, ∂L/∂v) of y = (q, v).
fn state<S: Lagrangian<N, Scalar = f64>, const N: usize>(scene: &S, y: &[f64]) -> Result<State<f64, N>> {
    let (q, v) = y.split_at(N);
    let [q, v] = [q, v].map(SVector::<f64, N>::from_column_slice);
    Ok(State::from_velocity(scene, q, v)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_that_tell_nothing_are_left_out() {
        let steps = |setting: f64| {
            let run = move |_| {
                anyhow::ensure!(setting > 2.0, "too coarse");
                Ok((1e-3, (setting.powi(-8) * 1e3).max(1e-12)))
            };
            Candidate { method: "power law with a floor", setting, run: Box::new(run) as _ }
        };
        let kept = worth((0..40).map(|k| 2_f64.powi(k)), |error: &f64| *error, steps);
        let kept: Vec<f64> = kept.iter().map(|candidate| candidate.setting).collect();
        // 1 and 2 fail; 1e3/4⁸ is 0.015; from 128 on the floor, of which five more runs are kept.
        assert_eq!(kept, [4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0, 1024.0, 2048.0, 4096.0]);
    }

    #[test]
    fn the_dearest_runs_may_come_first() {
        let steps = |setting: f64| {
            let seconds = if setting < 8.0 { 0.3 / setting } else { 1e-3 * setting };
            let run = move |_| Ok((seconds, setting.powi(-4)));
            Candidate { method: "iterates on coarse steps", setting, run: Box::new(run) as _ }
        };
        let kept = worth((1..40).map(|k| 2_f64.powi(k)), |error: &f64| *error, steps);
        let kept: Vec<f64> = kept.iter().map(|candidate| candidate.setting).collect();
        // To the first that is longer than the longest, and than twice the cheapest.
        assert_eq!(kept, [2.0, 4.0, 8.0, 16.0, 32.0, 64.0]);
    }
}
