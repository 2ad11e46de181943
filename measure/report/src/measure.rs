//! Runs of one scene by all methods, in turns: what slows the machine slows all.

use std::hint::black_box;
use std::ops::RangeInclusive;

use anyhow::Result;
use cpu_time::ThreadTime;

/// Runs a trajectory as often as asked; returns the seconds of one, and its end.
pub type Run<'a, E> = Box<dyn FnMut(u32) -> Result<(f64, E)> + 'a>;

/// A method with one setting, on one scene.
pub struct Candidate<'a, E> {
    pub method: &'static str,
    /// Number of steps, or tolerance.
    pub setting: f64,
    pub run: Run<'a, E>,
}

/// A candidate's seconds and its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<E> {
    pub method: &'static str,
    pub setting: f64,
    /// The median of all rounds.
    pub seconds: f64,
    /// The least of them: neighbours on a shared machine only add.
    pub least: f64,
    pub end: E,
}

/// Shorter than this, a run is repeated within a round, so that the clock's reading is no part of it.
const SHORTEST: f64 = 2e-4;

/// Seconds that one candidate may take over all rounds, as long as it gets the fewest.
const BUDGET: f64 = 0.1;
const ROUNDS: RangeInclusive<u32> = 5..=15;

/// Measures all, round by round; a candidate that fails is dropped, with what it said on standard error.
pub fn interleaved<E>(candidates: Vec<Candidate<'_, E>>) -> Vec<Measured<E>> {
    in_rounds(candidates, BUDGET, ROUNDS)
}

/// Measures all in a number of rounds, as few as a budget for all rounds of a candidate allows.
pub fn in_rounds<E>(
    candidates: Vec<Candidate<'_, E>>,
    budget: f64,
    allowed: RangeInclusive<u32>,
) -> Vec<Measured<E>> {
    struct Entry<'a, E> {
        candidate: Candidate<'a, E>,
        end: E,
        repeats: u32,
        rounds: u32,
        seconds: Vec<f64>,
    }
    let mut entries = Vec::new();
    for mut candidate in candidates {
        // The first run warms up; the second says how long one takes.
        match (candidate.run)(1).and_then(|_| (candidate.run)(1)) {
            Ok((seconds, end)) => {
                let repeats = (SHORTEST / seconds).ceil().clamp(1.0, 100.0) as u32;
                let rounds = (budget / (seconds * f64::from(repeats))) as u32;
                let rounds = rounds.clamp(*allowed.start(), *allowed.end());
                entries.push(Entry { candidate, end, repeats, rounds, seconds: Vec::new() });
            }
            Err(error) => eprintln!("  {} at {:e}: {error:#}", candidate.method, candidate.setting),
        }
    }
    for round in 0..*allowed.end() {
        for entry in entries.iter_mut().filter(|entry| round < entry.rounds) {
            if let Ok((seconds, _)) = (entry.candidate.run)(entry.repeats) {
                entry.seconds.push(seconds);
            }
        }
    }
    let measured = |entry: Entry<'_, E>| Measured {
        method: entry.candidate.method,
        setting: entry.candidate.setting,
        least: entry.seconds.iter().copied().fold(f64::INFINITY, f64::min),
        seconds: median(entry.seconds),
        end: entry.end,
    };
    entries.into_iter().map(measured).collect()
}

/// The middle value; NaN of none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Times `trajectory`, as often as asked, by the processor time of this thread, which no other program's work
/// is part of; what turns its result into an end is not timed.
pub fn timed<'a, T, E>(
    mut trajectory: impl FnMut() -> Result<T> + 'a,
    end: impl Fn(T) -> Result<E> + 'a,
) -> Run<'a, E> {
    Box::new(move |repeats| {
        let start = ThreadTime::now();
        let mut last = trajectory()?;
        for _ in 1..repeats {
            last = black_box(trajectory()?);
        }
        let seconds = start.elapsed().as_secs_f64() / f64::from(repeats);
        Ok((seconds, end(last)?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::bail;

    #[test]
    fn what_fails_is_dropped_and_what_takes_longer_measures_longer() {
        let counts = |thousands: u64| {
            let count = move || Ok((0..1000 * thousands).fold(0, |sum, i| black_box(sum ^ i)));
            timed(count, move |_| Ok(thousands))
        };
        let candidates = vec![
            Candidate { method: "slow", setting: 1.0, run: counts(2000) },
            Candidate { method: "fails", setting: 1.0, run: Box::new(|_| bail!("on purpose")) },
            Candidate { method: "fast", setting: 2.0, run: counts(100) },
        ];
        let measured = interleaved(candidates);
        assert_eq!(
            measured.iter().map(|one| (one.method, one.end)).collect::<Vec<_>>(),
            [("slow", 2000), ("fast", 100)]
        );
        assert!(measured[0].seconds > 4.0 * measured[1].seconds);
    }

    #[test]
    fn a_median_does_not_mind_an_outlier() {
        assert_eq!(median(vec![3.0, 1.0, 1e9]), 3.0);
        assert!(median(vec![]).is_nan());
    }
}
