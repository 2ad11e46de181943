//! Random steps of every rule, cold, from guesses and with memories, each held against its equations.

use dalembert::nalgebra::SVector;
use dalembert::{
    Discrete, ForcedLagrangian, Gauss, Memory, Midpoint, OneSided, StageHistory, State, Step, StepError,
    Trapezoidal,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::equations::{Judged, OneStage, gauss, one_stage, velocity};
use super::systems::{Studied, Units};
use super::tableau::Tableau;

/// What was found of a way to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tally {
    /// Steps asked for.
    pub asked: u64,
    /// Steps taken.
    pub taken: u64,
    /// Steps taken that violate the definition.
    pub violations: u64,
    /// The largest residual over its bound, of those that do not violate it.
    pub worst: f64,
    /// Steps taken whose equation rounding decides.
    pub undecided: u64,
    /// Steps taken whose equation overflows as it is written down here.
    pub beyond: u64,
    /// Steps refused from the state alone, and how many of them the same rule takes if it is led there from small step sizes.
    pub refused: u64,
    /// See `refused`.
    pub within_reach: u64,
}

impl Tally {
    /// Of nothing.
    pub const NONE: Self = Self {
        asked: 0,
        taken: 0,
        violations: 0,
        worst: 0.0,
        undecided: 0,
        beyond: 0,
        refused: 0,
        within_reach: 0,
    };

    fn judge(&mut self, judged: Judged) {
        self.taken += 1;
        self.undecided += u64::from(judged.is_undecided);
        self.beyond += u64::from(judged.is_beyond);
        if judged.is_violation() {
            self.violations += 1;
        } else {
            self.worst = self.worst.max(judged.ratio);
        }
    }

    /// Both together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            asked: self.asked + other.asked,
            taken: self.taken + other.taken,
            violations: self.violations + other.violations,
            worst: self.worst.max(other.worst),
            undecided: self.undecided + other.undecided,
            beyond: self.beyond + other.beyond,
            refused: self.refused + other.refused,
            within_reach: self.within_reach + other.within_reach,
        }
    }
}

/// The ways to step, in the order of the tallies.
pub const WAYS: [&str; 6] = ["midpoint", "trapezoidal", "one-sided", "Gauss", "bounded", "velocity"];

/// A system's name, its coordinates and its tallies by way.
pub type Row = (&'static str, usize, [Tally; WAYS.len()]);

/// A number of either sign with its logarithm uniform.
fn spread(random: &mut StdRng, [low, high]: [f64; 2]) -> f64 {
    10.0_f64.powf(random.random_range(low..high)) * if random.random_bool(0.5) { 1.0 } else { -1.0 }
}

/// A system, a state and a step size.
fn drawn<S, const N: usize>(random: &mut StdRng) -> Option<(S, State<f64, N>, SVector<f64, N>, f64)>
where
    S: Studied<N> + ForcedLagrangian<N, Scalar = f64>,
{
    let mut scale = |most: f64| spread(random, [-most, most]).abs();
    let [action, length, speed] = match (scale(1.0) * 4.0) as u32 {
        0..=1 => [scale(150.0), scale(150.0), scale(70.0)],
        2..=4 => [scale(20.0), scale(20.0), scale(20.0)],
        _ => [1.0; 3],
    };
    // Coefficients of L that overflow or vanish are another system's.
    if [length, speed, speed * speed, length * length]
        .iter()
        .any(|unit| !(1e-280..1e280).contains(&(action * unit)))
    {
        return None;
    }
    let system = S::new(
        spread(random, [-1.0, 0.7]).abs(),
        if random.random_bool(0.4) { 0.0 } else { spread(random, [-2.0, 1.0]).abs() },
        Units { action, length, speed, rate: length / speed },
    );
    let [low, high] = S::RANGE;
    let q = SVector::from_fn(|_, _| random.random_range(low..high) / length);
    let v = SVector::from_fn(
        |_, _| {
            if random.random_bool(0.1) { 0.0 } else { spread(random, [-3.0, 1.5]) / speed }
        },
    );
    let h = spread(random, [-4.0, 2.0]) * speed / length;
    let h = if random.random_bool(0.8) { h.abs() } else { h };
    let state = State::from_velocity(&system, q, v).ok()?;
    Some((system, state, v, h))
}

/// Whether the step is found where small ones lead on to it.
fn is_within_reach<L, R, const N: usize>(
    system: &L,
    state: &State<f64, N>,
    v: SVector<f64, N>,
    h: f64,
    judge: impl Fn(&Step<f64, N>) -> Option<Judged>,
) -> bool
where
    L: Discrete<R, N, Scalar = f64>,
{
    const PARTS: i32 = 48;
    let mut guess = v;
    for k in 1..=PARTS {
        let part = (f64::from(k) / f64::from(PARTS)).powi(3) * h;
        match system.step(state, part, Some(&guess)) {
            Ok(step) => guess = step.velocity,
            Err(_) => return false,
        }
    }
    let Ok(step) = system.step(state, h, Some(&guess)) else { return false };
    judge(&step).is_none_or(|judged| !judged.is_violation())
}

fn by_one_stage<L, R, const N: usize>(
    rule: OneStage,
    (system, state, v, h): (&L, &State<f64, N>, SVector<f64, N>, f64),
    random: &mut StdRng,
    [tally, bounded]: [&mut Tally; 2],
) where
    L: Discrete<R, N, Scalar = f64> + Studied<N>,
{
    let judged = |state: &State<f64, N>, step: &Step<f64, N>| one_stage(rule, system, state, h, step);
    tally.asked += 1;
    match system.step(state, h, None) {
        Ok(step) => tally.judge(judged(state, &step)),
        Err(error) => {
            tally.refused += 1;
            let is_found = |step: &Step<f64, N>| Some(judged(state, step));
            // What overflows has no step.
            if !matches!(error, StepError::StepSize { .. }) && is_within_reach(system, state, v, h, is_found)
            {
                tally.within_reach += 1;
            }
        }
    }
    let wild = random.random_bool(0.3);
    let guess =
        v.map(|v| v * if wild { spread(random, [-6.0, 6.0]) } else { 1.0 + random.random_range(-0.3..0.3) });
    tally.asked += 1;
    if let Ok(step) = system.step(state, h, Some(&guess)) {
        tally.judge(judged(state, &step));
    }
    bounded.asked += 1;
    let iterations = random.random_range(1..6);
    if let Ok(within) = system.step_within(state, h, wild.then_some(&guess), iterations)
        && within.converged
    {
        bounded.judge(judged(state, &within.step));
    }
    let (mut memory, mut at) = (L::Memory::default(), *state);
    for _ in 0..4 {
        tally.asked += 1;
        let Ok(step) = memory.advance(system, &at, h) else { break };
        tally.judge(judged(&at, &step));
        at = step.state;
    }
}

fn by_gauss<L, const N: usize, const STAGES: usize>(
    tableau: &Tableau,
    (system, state, v, h): (&L, &State<f64, N>, SVector<f64, N>, f64),
    tally: &mut Tally,
) where
    L: ForcedLagrangian<N, Scalar = f64> + Studied<N>,
{
    let (mut memory, mut at) = (StageHistory::<f64, N, STAGES>::default(), *state);
    for k in 0..3 {
        tally.asked += 1;
        match Memory::<L, Gauss<STAGES>, N>::advance(&mut memory, system, &at, h) {
            Ok(step) => {
                tally.judge(gauss(tableau, system, &at, h, &memory.velocities(), &step.state));
                at = step.state;
            }
            Err(_) => {
                if k == 0 {
                    tally.refused += 1;
                    tally.within_reach +=
                        u64::from(is_within_reach::<_, Gauss<STAGES>, N>(system, state, v, h, |_| None));
                }
                break;
            }
        }
    }
}

/// So many draws of one system, with Gauss rules of A and of B stages.
pub fn study<S, const N: usize, const A: usize, const B: usize>(draws: u32, seed: u64) -> Row
where
    S: Studied<N>
        + Discrete<Midpoint, N>
        + Discrete<Trapezoidal, N>
        + Discrete<OneSided, N>
        + ForcedLagrangian<N, Scalar = f64>,
{
    let mut random = StdRng::seed_from_u64(seed);
    let mut tallies = [Tally::NONE; WAYS.len()];
    let tableaux = [Tableau::new(A), Tableau::new(B)];
    for _ in 0..draws {
        let Some((system, state, v, h)) = drawn::<S, N>(&mut random) else { continue };
        let [midpoint, trapezoidal, one_sided, gauss, bounded, of_velocity] = &mut tallies;
        let draw = (&system, &state, v, h);
        by_one_stage::<_, Midpoint, N>(OneStage::Midpoint, draw, &mut random, [midpoint, bounded]);
        by_one_stage::<_, Trapezoidal, N>(OneStage::Trapezoidal, draw, &mut random, [trapezoidal, bounded]);
        by_one_stage::<_, OneSided, N>(OneStage::OneSided, draw, &mut random, [one_sided, bounded]);
        by_gauss::<_, N, A>(&tableaux[0], draw, gauss);
        by_gauss::<_, N, B>(&tableaux[1], draw, gauss);
        of_velocity.asked += 1;
        match state.velocity(&system) {
            Ok(v) => of_velocity.judge(velocity(&system, &state, &v)),
            Err(_) => {
                of_velocity.refused += 1;
                of_velocity.within_reach += 1;
            }
        }
    }
    (S::NAME, N, tallies)
}

/// The draws of one system: their number and seed.
pub type Job = fn(u32, u64) -> Row;

/// All `jobs` with so many draws each, on as many threads as there are.
pub fn study_all(jobs: &[Job], draws: u32, seed: u64) -> Vec<Row> {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let rows = std::sync::Mutex::new(Vec::new());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let at = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some(job) = jobs.get(at) else { break };
                    let row = job(draws, seed + at as u64);
                    rows.lock().expect("no thread panics with the lock").push((at, row));
                }
            });
        }
    });
    let mut rows = rows.into_inner().expect("no thread panics with the lock");
    rows.sort_by_key(|(at, _)| *at);
    rows.into_iter().map(|(_, row)| row).collect()
}
