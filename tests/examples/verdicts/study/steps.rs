//! Random steps of every rule, cold, from guesses and with memories, each held against its equations.

use dalembert::Discretise as _;
use dalembert::nalgebra::SVector;
use dalembert::rules::StageHistory;
use dalembert::step::BoundedFlow;
use dalembert::step::{Memory, Step};
use dalembert::system::ForcedLagrangian;
use dalembert::{
    Composition, Discrete, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, State, StepError,
    Trapezoidal,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::equations::{Judged, OneStage, both_ends, fitted, gauss, one_stage, velocity};
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
    /// Steps refused from the state alone, and how many of them the same rule takes if it is led there from
    /// small step sizes.
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

/// A way to step, by which the tallies are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// By the midpoint rule, as all further ones: from the state alone, from guesses, with a memory.
    Midpoint,
    /// By the trapezoidal rule.
    Trapezoidal,
    /// By the one-sided rule.
    OneSided,
    /// By Gauss rules, with their stages remembered.
    Gauss,
    /// The substeps of a composition.
    Composition,
    /// By the fitted midpoint rule.
    Fitted,
    /// By the fitted trapezoidal rule.
    FittedTrapezoidal,
    /// Within a given number of iterations, where they are said to have converged.
    Bounded,
    /// The velocity of a state.
    Velocity,
}

/// The names of the ways, in the order of the tallies.
pub const WAYS: [&str; 9] = [
    "midpoint",
    "trapezoidal",
    "one-sided",
    "Gauss",
    "composition, order 6",
    "fitted",
    "fitted, trapezoidal",
    "bounded",
    "velocity",
];

/// What was found of a system.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// Its number of coordinates.
    pub n: usize,
    /// By way.
    pub tallies: [Tally; WAYS.len()],
    /// The first violations, to be looked at.
    pub examples: Vec<String>,
}

impl Row {
    fn new(name: &'static str, n: usize) -> Self {
        Self { name, n, tallies: [Tally::NONE; WAYS.len()], examples: Vec::new() }
    }

    fn of(&mut self, way: Way) -> &mut Tally {
        &mut self.tallies[way as usize]
    }

    fn judge(&mut self, way: Way, judged: Judged, what: &dyn Fn() -> String) {
        let tally = self.of(way);
        tally.taken += 1;
        tally.undecided += u64::from(judged.is_undecided);
        tally.beyond += u64::from(judged.is_beyond);
        if !judged.is_violation() {
            tally.worst = tally.worst.max(judged.ratio);
            return;
        }
        tally.violations += 1;
        if self.examples.len() < 4 {
            self.examples.push(format!("{way:?} {judged:?} {}", what()));
        }
    }
}

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
    // Far out the last places of q are large beside a displacement: angles after many turns. Near 0 they are
    // nothing beside terms that cancel there: a motion that has come to rest.
    let [reach, at_rest] = match random.random_range(0..12) {
        0 => [10.0_f64.powf(random.random_range(0.0..7.0)), 0.1],
        1 | 2 if low < 0.0 => [10.0_f64.powf(random.random_range(-20.0..0.0)), 0.5],
        _ => [1.0, 0.1],
    };
    let q = SVector::from_fn(|_, _| random.random_range(low..high) * reach / length);
    let v = SVector::from_fn(|_, _| {
        if random.random_bool(at_rest) { 0.0 } else { spread(random, [-3.0, 1.5]) * reach.min(1.0) / speed }
    });
    let h = spread(random, [-4.0, 2.0]) * speed / length;
    let h = if random.random_bool(0.8) { h.abs() } else { h };
    let state = State::from_velocity(&system, q, v).ok()?;
    Some((system, state, v, h))
}

/// The step, once for each rule and system: most of the time that the study takes to compile.
#[inline(never)]
fn step<L, R, const N: usize>(
    system: &L,
    state: &State<f64, N>,
    h: f64,
    guess: Option<&SVector<f64, N>>,
) -> Result<Step<f64, N>, StepError>
where
    L: Discrete<R, N, Scalar = f64>,
{
    system.step(state, h, guess)
}

/// The step with a memory, likewise.
#[inline(never)]
fn advance<L, R, const N: usize>(
    memory: &mut L::RunMemory,
    system: &L,
    state: &State<f64, N>,
    h: f64,
) -> Result<Step<f64, N>, StepError>
where
    L: Discrete<R, N, Scalar = f64>,
{
    memory.advance(system, state, h)
}

/// A system, a state, its velocity and a step size.
type Draw<'a, L, const N: usize> = (&'a L, &'a State<f64, N>, SVector<f64, N>, f64);

/// Whether the step is found where small ones lead on to it.
fn is_within_reach<L, R, const N: usize>(
    (system, state, v, h): Draw<'_, L, N>,
    judge: &dyn Fn(&Step<f64, N>) -> Judged,
) -> bool
where
    L: Discrete<R, N, Scalar = f64>,
{
    const PARTS: i32 = 48;
    let mut guess = v;
    for k in 1..=PARTS {
        let part = (f64::from(k) / f64::from(PARTS)).powi(3) * h;
        match step::<L, R, N>(system, state, part, Some(&guess)) {
            Ok(step) => guess = step.velocity,
            Err(_) => return false,
        }
    }
    step::<L, R, N>(system, state, h, Some(&guess)).is_ok_and(|step| !judge(&step).is_violation())
}

/// From the state alone, from a guess, within some iterations and with a memory.
fn by_one_stage<L, R, const N: usize>(
    way: Way,
    draw: Draw<'_, L, N>,
    random: &mut StdRng,
    row: &mut Row,
    judged: &dyn Fn(&State<f64, N>, &Step<f64, N>) -> Judged,
) where
    L: Discrete<R, N, Scalar = f64> + Studied<N>,
{
    let (system, state, v, h) = draw;
    let told = |what: &str, at: &State<f64, N>, step: &Step<f64, N>| {
        format!("{what} {system:?} {at:?} h = {h:?} {step:?}")
    };
    row.of(way).asked += 1;
    match step::<L, R, N>(system, state, h, None) {
        Ok(step) => row.judge(way, judged(state, &step), &|| told("cold", state, &step)),
        Err(error) => {
            row.of(way).refused += 1;
            // What overflows has no step.
            if !matches!(error, StepError::StepSize { .. })
                && is_within_reach::<L, R, N>(draw, &|step| judged(state, step))
            {
                row.of(way).within_reach += 1;
            }
        }
    }
    let wild = random.random_bool(0.3);
    let guess =
        v.map(|v| v * if wild { spread(random, [-6.0, 6.0]) } else { 1.0 + random.random_range(-0.3..0.3) });
    row.of(way).asked += 1;
    if let Ok(step) = step::<L, R, N>(system, state, h, Some(&guess)) {
        row.judge(way, judged(state, &step), &|| told("guess", state, &step));
    }
    let (mut memory, mut at) = (L::RunMemory::default(), *state);
    for _ in 0..4 {
        row.of(way).asked += 1;
        let Ok(step) = advance::<L, R, N>(&mut memory, system, &at, h) else { break };
        row.judge(way, judged(&at, &step), &|| told("memory", &at, &step));
        at = step.state;
    }
}

/// Two steps of a composition, whose substeps are taken once more to be seen.
fn by_composition<L, const N: usize>((system, state, _, h): Draw<'_, L, N>, row: &mut Row)
where
    L: Discrete<Midpoint, N, Scalar = f64> + Studied<N>,
{
    let composition = Composition::kahan_li_6(Midpoint);
    let shares = *composition.shares();
    let mut run = system.by(composition, h).run(*state);
    let mut memories: [L::RunMemory; 9] = std::array::from_fn(|_| L::RunMemory::default());
    let mut at = *state;
    for _ in 0..2 {
        let end = match run.next() {
            // Of lengths below 1e-19 the start of a run has no slope to compare: its verdict is not this
            // one's.
            Some(Err(StepError::GeneratedDiffers { .. })) if state.q.amax() < 1e-18 => return,
            end => end.and_then(Result::ok),
        };
        for (k, share) in shares.iter().enumerate() {
            let (before, rest) = memories.split_at_mut(k);
            let (memory, after) = rest.split_first_mut().expect("there are as many memories as shares");
            if let Some(previous) = before.last().or(after.last()) {
                memory.follow(previous);
            }
            row.of(Way::Composition).asked += 1;
            let h = share * h;
            let Ok(step) = advance::<L, Midpoint, N>(memory, system, &at, h) else {
                assert!(end.is_none(), "a composition took a substep that is refused: {system:?} {at:?} {h}");
                return;
            };
            let judged = one_stage(OneStage::Midpoint, system, &at, h, &step);
            row.judge(Way::Composition, judged, &|| format!("{system:?} {at:?} h = {h:?} {step:?}"));
            at = step.state;
        }
        assert_eq!(
            end.map(|end| end.state),
            Some(at),
            "a composition is its substeps: {system:?} {state:?} {h}"
        );
    }
}

/// Within a few iterations.
fn bounded<L, R, const N: usize>(
    (system, state, v, h): Draw<'_, L, N>,
    random: &mut StdRng,
    row: &mut Row,
    judged: &dyn Fn(&State<f64, N>, &Step<f64, N>) -> Judged,
) where
    L: Discrete<R, N, Scalar = f64> + BoundedFlow<R, N> + Studied<N>,
{
    for _ in 0..3 {
        let guess = v.map(|v| v * spread(random, [-0.2, 0.2]).abs());
        row.of(Way::Bounded).asked += 1;
        let iterations = random.random_range(1..6);
        if let Ok(within) = BoundedFlow::<R, N>::step_within(
            system,
            state,
            h,
            random.random_bool(0.5).then_some(&guess),
            iterations,
        ) && within.converged
        {
            let told = || format!("{system:?} {state:?} h = {h:?} {:?}", within.step);
            row.judge(Way::Bounded, judged(state, &within.step), &told);
        }
    }
}

fn by_gauss<L, const N: usize, const STAGES: usize>(tableau: &Tableau, draw: Draw<'_, L, N>, row: &mut Row)
where
    L: ForcedLagrangian<N, Scalar = f64> + Studied<N>,
{
    let (system, state, _, h) = draw;
    let (mut memory, mut at) = (StageHistory::<f64, N, STAGES>::default(), *state);
    for k in 0..3 {
        row.of(Way::Gauss).asked += 1;
        match advance::<L, Gauss<STAGES>, N>(&mut memory, system, &at, h) {
            Ok(step) => {
                let v = memory.velocities();
                let judged = gauss(tableau, system, &at, h, &v, &step.state);
                let told = || format!("{k} {STAGES} {system:?} {at:?} h = {h:?} {step:?} {v:?}");
                row.judge(Way::Gauss, judged, &told);
                at = step.state;
            }
            Err(_) => {
                if k == 0 {
                    row.of(Way::Gauss).refused += 1;
                    let is_found = is_within_reach::<L, Gauss<STAGES>, N>(draw, &|_| Judged::NOTHING);
                    row.of(Way::Gauss).within_reach += u64::from(is_found);
                }
                break;
            }
        }
    }
}

/// So many draws of one system, with the Gauss rule of so many stages.
pub fn study<S, const N: usize, const STAGES: usize>(draws: u32, seed: u64) -> Row
where
    S: Studied<N>
        + Discrete<Midpoint, N>
        + BoundedFlow<Trapezoidal, N>
        + Discrete<Trapezoidal, N>
        + Discrete<OneSided, N>
        + ForcedLagrangian<N, Scalar = f64>,
{
    by_rules::<S, N, STAGES>(draws, seed, |(system, state, v, h), random, row| {
        let judged = |state: &State<f64, N>, step: &Step<f64, N>| match step.state.velocity(system) {
            Ok(v1) => both_ends(system, state, h, step, &v1),
            Err(_) => Judged::NOTHING,
        };
        by_one_stage::<_, OneSided, N>(Way::OneSided, (system, state, v, h), random, row, &judged);
    })
}

/// So many draws of one system whose derivatives are dual numbers, which the one-sided rule does not take.
pub fn study_by_dual<S, const N: usize, const STAGES: usize>(draws: u32, seed: u64) -> Row
where
    S: Studied<N>
        + Discrete<Midpoint, N>
        + BoundedFlow<Trapezoidal, N>
        + Discrete<Trapezoidal, N>
        + ForcedLagrangian<N, Scalar = f64>,
{
    by_rules::<S, N, STAGES>(draws, seed, |_, _, _| ())
}

/// By all rules that every system has, and by others.
fn by_rules<S, const N: usize, const STAGES: usize>(
    draws: u32,
    seed: u64,
    others: impl Fn(Draw<'_, S, N>, &mut StdRng, &mut Row),
) -> Row
where
    S: Studied<N>
        + Discrete<Midpoint, N>
        + BoundedFlow<Trapezoidal, N>
        + Discrete<Trapezoidal, N>
        + ForcedLagrangian<N, Scalar = f64>,
{
    let mut random = StdRng::seed_from_u64(seed);
    let mut row = Row::new(S::NAME, N);
    let tableau = Tableau::new(STAGES);
    for _ in 0..draws {
        let Some((system, state, v, h)) = drawn::<S, N>(&mut random) else { continue };
        let draw = (&system, &state, v, h);
        let by = |rule: OneStage| {
            move |state: &State<f64, N>, step: &Step<f64, N>| one_stage(rule, &system, state, h, step)
        };
        by_one_stage::<_, Midpoint, N>(Way::Midpoint, draw, &mut random, &mut row, &by(OneStage::Midpoint));
        let judged = by(OneStage::Trapezoidal);
        by_one_stage::<_, Trapezoidal, N>(Way::Trapezoidal, draw, &mut random, &mut row, &judged);
        bounded::<_, Trapezoidal, N>(draw, &mut random, &mut row, &judged);
        others(draw, &mut random, &mut row);
        by_gauss::<_, N, STAGES>(&tableau, draw, &mut row);
        row.of(Way::Velocity).asked += 1;
        match state.velocity(&system) {
            Ok(v) => {
                let judged = velocity(&system, &state, &v);
                row.judge(Way::Velocity, judged, &|| format!("{system:?} {state:?} {v:?}"));
            }
            Err(_) => {
                row.of(Way::Velocity).refused += 1;
                row.of(Way::Velocity).within_reach += 1;
            }
        }
    }
    row
}

/// So many draws of one system by a composition.
pub fn study_composed<S, const N: usize>(draws: u32, seed: u64) -> Row
where
    S: Studied<N> + Discrete<Midpoint, N> + ForcedLagrangian<N, Scalar = f64>,
{
    let mut random = StdRng::seed_from_u64(seed);
    let mut row = Row::new(S::NAME, N);
    for _ in 0..draws {
        if let Some((system, state, v, h)) = drawn::<S, N>(&mut random) {
            by_composition((&system, &state, v, h), &mut row);
        }
    }
    row
}

/// So many draws of one system by the fitted rules.
pub fn study_fitted<S, const N: usize>(draws: u32, seed: u64) -> Row
where
    S: Studied<N> + Discrete<Fitted, N> + Discrete<FittedTrapezoidal, N> + ForcedLagrangian<N, Scalar = f64>,
{
    let mut random = StdRng::seed_from_u64(seed);
    let mut row = Row::new(S::NAME, N);
    for _ in 0..draws {
        let Some((system, state, v, h)) = drawn::<S, N>(&mut random) else { continue };
        let draw = (&system, &state, v, h);
        let by = |is_explicit: bool| {
            move |state: &State<f64, N>, step: &Step<f64, N>| fitted(is_explicit, &system, state, h, step)
        };
        by_one_stage::<_, Fitted, N>(Way::Fitted, draw, &mut random, &mut row, &by(false));
        let judged = by(true);
        by_one_stage::<_, FittedTrapezoidal, N>(Way::FittedTrapezoidal, draw, &mut random, &mut row, &judged);
    }
    row
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
                    let row = job(draws, seed * 1000 + at as u64);
                    rows.lock().expect("no thread panics with the lock").push((at, row));
                }
            });
        }
    });
    let mut rows = rows.into_inner().expect("no thread panics with the lock");
    rows.sort_by_key(|(at, _)| *at);
    rows.into_iter().map(|(_, row)| row).collect()
}
