//! Runs of one mechanism by every method, and what they come to.

use anyhow::{Context, Result, ensure};
use cpu_time::ThreadTime;
use dalembert::nalgebra::SVector;
use dalembert::step::Flow;
use dalembert::{Composition, Midpoint, State};

use super::mechanisms::Mechanism;
use super::systems::TwoRods;
use super::{HORIZONS, Horizon, Record};
use crate::measure::{Candidate, in_rounds};
use crate::ours::{self, Steps};
use crate::peers;
use crate::peers::python::Python;
use crate::reference::{self, Reference};
use crate::scenes::Accelerated;

/// Rates of Baumgarte's stabilisation that are tried, 1/s; 0 is none.
const ALPHAS: [f64; 3] = [0.0, 5.0, 50.0];
/// Those that are tried in Python, where heyoka compiles for each and every tolerance.
const ALPHAS_OF_PYTHON: [f64; 2] = [0.0, 5.0];

/// Seconds that one setting may take over all rounds, as long as it gets the fewest.
const BUDGET: f64 = 0.02;
const ROUNDS: std::ops::RangeInclusive<u32> = 3..=5;

/// Runs a motion as often as asked, stopped at the ends of so many equal parts: seconds of one, (q, v) there.
type Run<'a, const M: usize> = Box<dyn FnMut(u32, usize) -> Result<(f64, Vec<[f64; M]>)> + 'a>;

/// A method: its name, the rate of stabilisation, settings from the coarsest, and a run at one of them.
struct Method<'a, const M: usize> {
    name: &'static str,
    alpha: f64,
    settings: Vec<f64>,
    run: Box<dyn Fn(f64) -> Run<'a, M> + 'a>,
}

/// The names of this project's methods.
pub fn names() -> [&'static str; 3] {
    methods::<TwoRods, 4>().map(|(name, _)| name)
}

/// This project's methods. Here the trapezoidal rule has the steps of the midpoint rule: the mass is constant, and
/// the potential linear.
fn methods<S, const N: usize>() -> [(&'static str, Steps<S, N>); 3]
where
    S: Flow<Midpoint, N, Scalar = f64>,
{
    [
        ("midpoint", |s, start, h, steps| ours::run(s, Midpoint, start, h, steps)),
        ("midpoint, Kahan–Li 6", |s, start, h, steps| {
            ours::run::<S, Composition<Midpoint, 9>, N>(s, Composition::kahan_li_6(Midpoint), start, h, steps)
        }),
        ("midpoint, Kahan–Li 8", |s, start, h, steps| {
            ours::run::<S, Composition<Midpoint, 17>, N>(
                s,
                Composition::kahan_li_8(Midpoint),
                start,
                h,
                steps,
            )
        }),
    ]
}

impl<S, A, const N: usize> Mechanism<S, A, N>
where
    S: Flow<Midpoint, N, Scalar = f64>,
    A: Accelerated<N>,
{
    /// Measures all methods over one time; M is 2N.
    ///
    /// # Errors
    /// The reference is missing.
    pub fn measure<const M: usize>(
        &self,
        horizon: Horizon,
        python: &Python,
        records: &mut Vec<Record>,
    ) -> Result<()> {
        eprintln!("{}, T = {}", self.name, horizon.time);
        let reference = reference::of(&format!("{}, T = {}", self.motion, horizon.time))?;
        ensure!(reference.energies.len() == horizon.parts, "{}: not as many energies as parts", self.motion);
        let mut found: Vec<(Record, Run<'_, M>)> = Vec::new();
        for method in self.all_methods::<M>(&reference, python)? {
            let mut cheapest = f64::INFINITY;
            for &setting in &method.settings {
                let mut run = (method.run)(setting);
                // What fails at a coarse setting may succeed at a finer one.
                let Ok((seconds, states)) = run(1, horizon.parts) else { continue };
                let mut record = self.record(&reference, &states)?;
                (record.method, record.setting, record.alpha) = (method.name.into(), setting, method.alpha);
                record.seconds = seconds / horizon.time;
                let seconds = record.seconds;
                // What has come apart is no run.
                if !(record.off < 1.0 && record.energy_error < 100.0) {
                    continue;
                }
                found.push((record, run));
                cheapest = cheapest.min(seconds);
                // A finer one takes up to twice as long.
                if seconds > 0.5 * horizon.longest && seconds > 1.5 * cheapest {
                    break;
                }
            }
        }
        if horizon != HORIZONS[0] {
            // So long that the clock's reading and a first run are no part of it.
            records.extend(found.into_iter().map(|(record, _)| record));
            return Ok(());
        }
        let candidates = found.into_iter().map(|(record, mut run)| Candidate {
            method: "",
            setting: record.setting,
            run: Box::new(move |repeats| Ok((run(repeats, 1)?.0 / horizon.time, record.clone()))),
        });
        let measured = in_rounds(candidates.collect(), BUDGET, ROUNDS);
        records.extend(measured.into_iter().map(|one| Record { seconds: one.least, ..one.end }));
        Ok(())
    }

    /// What a run has come to by its states at the ends of the parts.
    fn record<const M: usize>(&self, reference: &Reference, states: &[[f64; M]]) -> Result<Record> {
        let (mut off, mut energy_error, mut momentum_error) = (0.0_f64, 0.0, self.momentum.map(|_| 0.0));
        let halves = |y: &[f64; M]| -> Result<[[f64; N]; 2]> { Ok([y[..N].try_into()?, y[N..].try_into()?]) };
        let start = [&reference.start_q, &reference.start_v];
        let [start_q, start_v]: [[f64; N]; 2] =
            [start[0].as_slice().try_into()?, start[1].as_slice().try_into()?];
        for (y, (time, energy)) in states.iter().zip(&reference.energies) {
            let [q, v] = halves(y)?;
            off = largest([off, (self.off)(&q)]);
            energy_error = largest([energy_error, self.system.energy(&q.into(), &v.into()) - energy]);
            momentum_error = momentum_error.zip(self.momentum).map(|(most, (momentum, decay))| {
                largest([most, momentum(&q, &v) - momentum(&start_q, &start_v) * (-decay * time).exp()])
            });
        }
        let [q, _] = halves(states.last().context("no end")?)?;
        let position_error = largest(q.iter().zip(&reference.end_q).map(|(found, end)| found - end));
        let (mechanism, horizon) = (self.name.into(), reference.time);
        let [setting, alpha, seconds] = [f64::NAN; 3];
        let method = String::new();
        Ok(Record {
            mechanism,
            horizon,
            method,
            setting,
            alpha,
            seconds,
            off,
            energy_error,
            momentum_error,
            position_error,
        })
    }

    /// This project's methods, peers on the accelerations, and those of the Python script.
    fn all_methods<'a, const M: usize>(
        &'a self,
        reference: &'a Reference,
        python: &'a Python,
    ) -> Result<Vec<Method<'a, M>>> {
        let steps = || (2..16).map(|k| 2_f64.powi(-k)).collect::<Vec<_>>();
        let tolerances = |every| (3..15).step_by(every).map(|k| 10_f64.powi(-k)).collect::<Vec<_>>();
        let time = reference.time;
        let scene = move |alpha: f64| format!("{}, T = {time}, α = {alpha}", self.name);
        let [q, v] = [&reference.start_q, &reference.start_v].map(|x| SVector::from_column_slice(x));
        let start = State::from_velocity(&self.system, q, v)?;
        let y: [f64; M] = [q.as_slice(), v.as_slice()].concat().as_slice().try_into()?;
        let mut all = Vec::new();
        for (name, steps_of) in methods::<S, N>() {
            let run = move |h| self.by_steps(start, time, steps_of, h);
            all.push(Method { name, alpha: 0.0, settings: steps(), run: Box::new(run) });
        }
        for (name, integrate) in peers::methods::<A, N, M>() {
            for alpha in ALPHAS {
                let run = move |tolerance| {
                    let reduced = (self.reduced)(alpha);
                    timed(time, y, move |y, time| integrate(&reduced, y, time, tolerance), Ok)
                };
                all.push(Method { name, alpha, settings: tolerances(1), run: Box::new(run) });
            }
        }
        let in_python = move |name, alpha| {
            move |setting| -> Run<'a, M> {
                let scene = scene(alpha);
                Box::new(move |repeats, parts| python.run::<M>(name, &scene, setting, repeats, parts))
            }
        };
        for &name in &python.reduced {
            for alpha in ALPHAS_OF_PYTHON {
                let run = Box::new(in_python(name, alpha));
                all.push(Method { name, alpha, settings: tolerances(4), run });
            }
        }
        for &name in &python.stepped {
            let run = Box::new(in_python(name, 0.0));
            all.push(Method { name, alpha: 0.0, settings: steps(), run });
        }
        Ok(all)
    }

    /// Runs by steps of size h.
    fn by_steps<'a, const M: usize>(
        &'a self,
        start: State<f64, N>,
        time: f64,
        steps: Steps<S, N>,
        h: f64,
    ) -> Run<'a, M> {
        let step = move |state: &_, time: f64| steps(&self.system, state, h, (time / h).round() as u32);
        timed(time, start, step, |state| {
            let v = state.velocity(&self.system)?;
            Ok([state.q.as_slice(), v.as_slice()].concat().as_slice().try_into()?)
        })
    }
}

/// Runs by going on from stop to stop; what makes (q, v) of a state is not timed.
fn timed<'a, T: Clone + 'a, const M: usize>(
    time: f64,
    start: T,
    go_on: impl Fn(&T, f64) -> Result<T> + 'a,
    halves: impl Fn(T) -> Result<[f64; M]> + 'a,
) -> Run<'a, M> {
    Box::new(move |repeats, parts| {
        let mut states = Vec::with_capacity(parts);
        let begin = ThreadTime::now();
        for _ in 0..repeats {
            states.clear();
            let mut state = start.clone();
            for _ in 0..parts {
                state = go_on(&state, time / parts as f64)?;
                states.push(state.clone());
            }
        }
        let seconds = begin.elapsed().as_secs_f64() / f64::from(repeats);
        Ok((seconds, states.into_iter().map(&halves).collect::<Result<_>>()?))
    })
}

/// The largest size; infinite if one is no number.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |most, value| if value.is_nan() { f64::INFINITY } else { most.max(value.abs()) })
}
