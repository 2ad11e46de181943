//! The long damped run: how far the energy strays from the reference's along it.

use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use dalembert::nalgebra::SVector;
use dalembert::{Lagrangian, State};
use serde::{Deserialize, Serialize};

use crate::measure::{Candidate, interleaved, timed};
use crate::peers::python::Python;
use crate::scenes::{Ring, Scene};
use crate::{peers, reference};

/// The ring with a hundredth of its drag.
const SCENE: Ring = Ring { k: 1e-5 };
const NAME: &str = "long run";

/// Times up to which the largest error of the energy is taken.
pub const HORIZONS: [f64; 3] = [200.0, 2000.0, 20000.0];

/// Seconds after which a method's settings are not refined further.
const LONGEST: f64 = 0.25;

/// Energy errors above this are no longer of interest.
const WORST: f64 = 0.3;

/// A measured run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub method: String,
    pub setting: f64,
    /// Of the whole run, median.
    pub seconds: f64,
    /// Largest error of the energy up to each of the horizons.
    pub error_to_200: f64,
    pub error_to_2000: f64,
    pub error_to_20000: f64,
}

impl Record {
    /// The largest error up to each of the horizons.
    pub fn errors(&self) -> [f64; 3] {
        [self.error_to_200, self.error_to_2000, self.error_to_20000]
    }
}

/// The energy's error along one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    pub method: String,
    pub setting: f64,
    pub time: f64,
    pub energy_error: f64,
}

/// Seconds that the runs shown in the figure cost, about.
pub const SHOWN: f64 = 0.01;

/// A method with one setting, and the energy's errors at the reference's times.
struct Traced<'a> {
    candidate: Candidate<'a, ()>,
    /// Of the run that was sampled.
    seconds: f64,
    errors: Vec<f64>,
}

/// All methods and settings, and of each method the samples of the run that costs about [`SHOWN`].
///
/// Trajectories are sampled by going on from sample to sample, and timed in one go.
///
/// # Errors
/// The reference is missing or unusable.
pub fn measure(python: Option<&Python>) -> Result<(Vec<Record>, Vec<Sample>)> {
    let energies = reference::of(NAME)?.energies;
    let reference = reference::of("ring")?;
    let [q, v] = [&reference.start_q, &reference.start_v].map(|x| SVector::<f64, 2>::from_column_slice(x));
    let start = State::from_velocity(&SCENE, q, v)?;
    let y = [q[0], q[1], v[0], v[1]];
    let &(end, _) = peers::last(&energies)?;
    ensure!(end == HORIZONS[2], "the reference ends at {end}");
    let count = energies.len() as u32;
    let chunk = end / f64::from(count);
    let errors_of = |energy: &mut dyn FnMut() -> Result<f64>| -> Result<Vec<f64>> {
        energies.iter().map(|(_, reference)| Ok((energy()? - reference).abs())).collect()
    };

    let mut traced = Vec::new();
    for (method, steps) in Ring::methods() {
        // So that samples fall on step ends.
        let counts = (0..40).map(|k| (chunk * 2_f64.powf(0.5 * f64::from(k))).round() as u32);
        traced.extend(worth(counts.map(|in_chunk| {
            let h = chunk / f64::from(in_chunk);
            let (mut state, begin) = (start, ThreadTime::now());
            let errors = errors_of(&mut || {
                state = steps(&SCENE, &state, h, in_chunk)?;
                Ok(state.energy(&SCENE)?)
            })?;
            let seconds = begin.elapsed().as_secs_f64();
            let run = move || steps(&SCENE, &start, h, in_chunk * count);
            Ok(Traced {
                candidate: Candidate { method, setting: h, run: timed(run, |_| Ok(())) },
                seconds,
                errors,
            })
        })));
    }
    for (method, integrate) in peers::methods::<Ring, 2, 4>() {
        let tolerances = (2..29).map(|k| 10_f64.powf(-0.5 * f64::from(k)));
        traced.extend(worth(tolerances.map(|tolerance| {
            let (mut state, begin) = (y, ThreadTime::now());
            let errors = errors_of(&mut || {
                state = integrate(&SCENE, &state, chunk, tolerance)?;
                Ok(energy_of(&state))
            })?;
            let seconds = begin.elapsed().as_secs_f64();
            let run = move || integrate(&SCENE, &y, end, tolerance);
            let candidate = Candidate { method, setting: tolerance, run: timed(run, |_| Ok(())) };
            Ok(Traced { candidate, seconds, errors })
        })));
    }
    for python in python.into_iter() {
        for &method in &python.methods {
            traced.extend(worth((1..15).map(|k| {
                let tolerance = 10_f64.powi(-k);
                let (seconds, states) = python.run::<4>(method, NAME, tolerance, 1, energies.len())?;
                // Of a batch the first of its trajectories.
                let mut states = states.iter().step_by(states.len() / energies.len());
                let errors = errors_of(&mut || Ok(states.next().map_or(f64::NAN, energy_of)))?;
                let run = move |repeats| Ok((python.run::<4>(method, NAME, tolerance, repeats, 1)?.0, ()));
                Ok(Traced {
                    candidate: Candidate { method, setting: tolerance, run: Box::new(run) },
                    seconds,
                    errors,
                })
            })));
        }
    }
    let (candidates, errors): (Vec<_>, Vec<_>) = traced
        .into_iter()
        .map(|one| {
            let key = (one.candidate.method, one.candidate.setting);
            (one.candidate, (key, one.errors))
        })
        .unzip();
    let times: Vec<f64> = energies.iter().map(|&(time, _)| time).collect();
    let (mut records, mut samples) = (Vec::new(), Vec::new());
    let measured = interleaved(candidates);
    for one in &measured {
        let Some((_, errors)) = errors.iter().find(|(key, _)| *key == (one.method, one.setting)) else {
            continue;
        };
        let to = |horizon: f64| {
            largest(errors.iter().zip(&times).filter(|(_, t)| **t <= horizon).map(|(e, _)| *e))
        };
        let [error_to_200, error_to_2000, error_to_20000] = HORIZONS.map(to);
        records.push(Record {
            method: one.method.into(),
            setting: one.setting,
            seconds: one.seconds,
            error_to_200,
            error_to_2000,
            error_to_20000,
        });
        let distance = |seconds: f64| (seconds / SHOWN).ln().abs();
        let nearest = measured.iter().filter(|other| other.method == one.method);
        let nearest = nearest.min_by(|a, b| distance(a.seconds).total_cmp(&distance(b.seconds)));
        if nearest.is_some_and(|nearest| nearest.setting == one.setting) {
            samples.extend(times.iter().zip(errors).map(|(&time, &energy_error)| Sample {
                method: one.method.into(),
                setting: one.setting,
                time,
                energy_error,
            }));
        }
    }
    Ok((records, samples))
}

/// Of runs in the order of rising cost those whose energy stays within reason, until they take too long.
fn worth<'a>(runs: impl Iterator<Item = Result<Traced<'a>>>) -> Vec<Traced<'a>> {
    let mut kept = Vec::new();
    // What fails at a coarse setting may succeed at a finer one.
    for run in runs.flatten() {
        let seconds = run.seconds;
        if largest(run.errors.iter().copied()) < WORST {
            kept.push(run);
        }
        if seconds > LONGEST {
            break;
        }
    }
    kept
}

fn energy_of(y: &[f64; 4]) -> f64 {
    SCENE.energy(&SVector::from([y[0], y[1]]), &SVector::from([y[2], y[3]]))
}

/// The largest; infinite if one is no number.
fn largest(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |largest, error| if error.is_nan() { f64::INFINITY } else { largest.max(error) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_larger_than_all() {
        assert_eq!(largest([1.0, 3.0, 2.0].into_iter()), 3.0);
        assert_eq!(largest([1.0, f64::NAN, 2.0].into_iter()), f64::INFINITY);
    }
}
