//! What a choice promised and what it kept, against a reference.

use std::hint::black_box;
use std::time::Instant;

use dalembert::nalgebra::SVector;
use dalembert::step::Step;
use dalembert::system::ActingForce;
use dalembert::tolerance::{Choice, Method, MethodStep, Methods, OffersMethods, ToleranceError};
use dalembert::{Discretise, Lagrangian, State};

/// (q, p) at the times given, ascending.
pub type Reference<const N: usize> = Box<dyn Fn(&[f64]) -> Vec<State<f64, N>>>;

/// How a request ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The run went to its end without a breach.
    Silent,
    /// The guard reported a breach at this time.
    Breach(f64),
    /// No method was chosen, or a step failed.
    Refused,
}

/// What came of one request.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// How it ended.
    pub verdict: Verdict,
    /// The method chosen.
    pub method: Option<Method>,
    /// Its steps.
    pub steps: u64,
    /// The largest error on the way, over the tolerance: in the norm of the promise.
    pub error: f64,
    /// The largest before a breach was reported.
    pub before: f64,
    /// The largest of q alone.
    pub of_q: f64,
    /// The error that the guard expected at the end, over the tolerance.
    pub expected: f64,
    /// Evaluations of the run, the guard and the choice.
    pub evaluations: [f64; 3],
}

impl Outcome {
    /// Whether the error was passed by more than twice before a word of it.
    pub fn is_silent_excess(&self) -> bool {
        self.before > 2.0
    }

    /// Whether a breach was reported although the error was kept to the end.
    pub fn is_false_breach(&self) -> bool {
        matches!(self.verdict, Verdict::Breach(_)) && self.error <= 1.0
    }
}

/// The cheapest fixed choice, where there is one: its evaluations, its method and its steps.
pub type Cheapest = Option<(f64, Method, u64)>;

/// A request by the clock, in seconds.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// Choosing.
    pub choice: f64,
    /// The run of the choice, without its guard and with it.
    pub runs: [f64; 2],
    /// All that it takes to reach the end.
    pub end: f64,
    /// The cheapest fixed choice.
    pub fixed: f64,
    /// The steps of the choice.
    pub steps: u64,
}

/// Finds them for some tolerances.
type Search = Box<dyn Fn(&[f64]) -> Vec<Cheapest>>;

/// Times a request beside a fixed choice, where it reaches its end.
type Timing = Box<dyn Fn(f64, (Method, u64)) -> Option<Clock>>;

/// A motion with its reference.
pub struct Motion {
    /// What kind of motion.
    pub family: &'static str,
    /// Its parameters.
    pub what: String,
    ask: Box<dyn Fn(f64) -> Outcome>,
    reach: Box<dyn Fn(f64) -> (Outcome, u32)>,
    cheapest: Search,
    clock: Timing,
}

/// Instants at which an error is measured.
const INSTANTS: usize = 40;

/// Evaluations at most of a fixed choice.
const MOST: f64 = 2e5;

/// What an error of p counts beside one of q, by the definition of the promise.
struct Weight<const N: usize> {
    start: SVector<f64, N>,
    last: State<f64, N>,
    reached: [f64; 2],
    change: [f64; 2],
}

impl<const N: usize> Weight<N> {
    fn new(start: &State<f64, N>) -> Self {
        Self { start: start.q, last: *start, reached: [0.0, start.p.amax()], change: [0.0; 2] }
    }

    fn follow(&mut self, state: &State<f64, N>) {
        self.reached[0] = self.reached[0].max((state.q - self.start).amax());
        self.reached[1] = self.reached[1].max(state.p.amax());
        self.change[0] = self.change[0].max((state.q - self.last.q).amax());
        self.change[1] = self.change[1].max((state.p - self.last.p).amax());
        self.last = *state;
    }

    fn value(&self) -> f64 {
        let weight = (self.reached[0] / self.reached[1]).min(self.change[0] / self.change[1]);
        if weight.is_finite() { weight } else { 0.0 }
    }
}

impl Motion {
    /// The motion of `system` from `start` over `time`.
    pub fn new<L, M, const N: usize>(
        family: &'static str,
        what: String,
        system: L,
        methods: M,
        start: State<f64, N>,
        time: f64,
        reference: Reference<N>,
    ) -> Self
    where
        L: OffersMethods<N> + Lagrangian<N, Scalar = f64> + Clone + 'static,
        M: Methods<L, N> + 'static,
    {
        let reference = std::rc::Rc::new(reference);
        let (of_ask, of_reach, of_cheapest) = (reference.clone(), reference.clone(), system.clone());
        let (asked, timed) = (system.clone(), system.clone());
        Self {
            family,
            what,
            ask: Box::new(move |tolerance| {
                measured(
                    asked.to_error(tolerance).among(methods).until(time).choice(&start),
                    start,
                    tolerance,
                    &of_ask,
                )
            }),
            reach: Box::new(move |tolerance| {
                let request = system.to_error(tolerance).among(methods).until(time);
                // Without optimisation 10⁷ steps take minutes.
                let most = if cfg!(debug_assertions) { 200_000 } else { 10_000_000 };
                let reached = request.at_most(most).end(&start);
                let runs = reached.as_ref().map_or(0, |reached| reached.runs);
                (measured(reached.map(|reached| reached.choice), start, tolerance, &of_reach), runs)
            }),
            cheapest: Box::new(move |tolerances| {
                cheapest(&of_cheapest, methods, start, time, tolerances, &reference)
            }),
            clock: Box::new(move |tolerance, fixed| clock(&timed, methods, &start, [time, tolerance], fixed)),
        }
    }

    /// What comes of asking for an error.
    pub fn ask(&self, tolerance: f64) -> Outcome {
        (self.ask)(tolerance)
    }

    /// What comes of asking for the end of a run that keeps an error, and how many runs that took.
    pub fn reach(&self, tolerance: f64) -> (Outcome, u32) {
        (self.reach)(tolerance)
    }

    /// A request by the clock, beside this method by so many steps; nothing where it does not reach its end.
    pub fn clock(&self, tolerance: f64, fixed: (Method, u64)) -> Option<Clock> {
        (self.clock)(tolerance, fixed)
    }

    /// The cheapest method and step size for each tolerance, in evaluations, found by trying all step sizes:
    /// of those of which all shorter ones keep it as well. One step over the whole time ends well by
    /// accident where the motion has come to rest by then.
    pub fn cheapest(&self, tolerances: &[f64]) -> Vec<Cheapest> {
        (self.cheapest)(tolerances)
    }
}

fn measured<L, M, const N: usize>(
    choice: Result<Choice<'_, L, M, N>, ToleranceError>,
    start: State<f64, N>,
    tolerance: f64,
    reference: &Reference<N>,
) -> Outcome
where
    L: ActingForce<N, Scalar = f64>,
    M: Methods<L, N>,
{
    let refused = Outcome {
        verdict: Verdict::Refused,
        method: None,
        steps: 0,
        error: 0.0,
        before: 0.0,
        of_q: 0.0,
        expected: 0.0,
        evaluations: [0.0; 3],
    };
    let choice = match choice {
        Ok(choice) => choice,
        Err(ToleranceError::Request { .. }) => panic!("a request that makes no sense"),
        Err(_) => return refused,
    };
    let steps = choice.steps();
    let stride = (steps as usize).div_ceil(INSTANTS).max(1) as u64;
    let mut run = choice.trajectory();
    let mut weight = Weight::new(&start);
    let (mut times, mut states, mut failed) = (Vec::new(), Vec::new(), false);
    for k in 1..=steps {
        match run.next().expect("the run goes to its end") {
            Ok(Step { state, .. }) => {
                weight.follow(&state);
                // At no multiple of a number of steps.
                if k == steps || (k * 7919) % stride == 0 {
                    times.push(run.time());
                    states.push((state, weight.value(), run.breach().is_some()));
                }
            }
            Err(_) => {
                failed = true;
                break;
            }
        }
    }
    let mut outcome = Outcome {
        verdict: run.breach().map_or(Verdict::Silent, |breach| Verdict::Breach(breach.time)),
        method: Some(choice.method()),
        steps,
        expected: run.expected() / tolerance,
        evaluations: [run.evaluations().0, run.evaluations().1, choice.evaluations()],
        ..refused
    };
    for ((state, weight, is_reported), exact) in states.iter().zip(reference(&times)) {
        let of_q = (state.q - exact.q).amax() / tolerance;
        let error = of_q.max((state.p - exact.p).amax() * weight / tolerance);
        outcome.of_q = outcome.of_q.max(of_q);
        outcome.error = outcome.error.max(error);
        if !is_reported {
            outcome.before = outcome.before.max(error);
        }
    }
    if failed {
        outcome.verdict = Verdict::Refused;
    }
    outcome
}

fn cheapest<L, M, const N: usize>(
    system: &L,
    methods: M,
    start: State<f64, N>,
    time: f64,
    tolerances: &[f64],
    reference: &Reference<N>,
) -> Vec<Cheapest>
where
    L: ActingForce<N, Scalar = f64>,
    M: Methods<L, N>,
{
    let instants: Vec<f64> = (1..=16).map(|k| time * f64::from(k) / 16.0).collect();
    let exact = reference(&instants);
    let smallest = tolerances.iter().copied().fold(f64::INFINITY, f64::min);
    let mut cheapest = vec![None; tolerances.len()];
    for method in Method::ALL.into_iter().filter(|&method| M::offers(method)) {
        let mut steps: u64 = 1;
        let mut tried: Vec<([f64; 2], u64)> = Vec::new();
        loop {
            let h = time / steps as f64;
            let mut step = methods.step(method, h).expect("it is offered");
            let (mut state, mut cost, mut error) = (start, 0.0, 0.0_f64);
            let mut weight = Weight::new(&start);
            let mut compared: Vec<(State<f64, N>, usize)> = Vec::new();
            for k in 0..steps {
                match step.advance(system, h * k as f64, &state) {
                    Ok(taken) => {
                        cost += taken.evaluations;
                        state = taken.step.state;
                        weight.follow(&state);
                        if ((k + 1) * 16).is_multiple_of(steps) {
                            compared.push((state, ((k + 1) * 16 / steps) as usize - 1));
                        }
                    }
                    Err(_) => {
                        error = f64::INFINITY;
                        break;
                    }
                }
            }
            for (state, index) in compared {
                let of_p = (state.p - exact[index].p).amax() * weight.value();
                error = error.max((state.q - exact[index].q).amax().max(of_p));
            }
            tried.push(([error, cost], steps));
            if (error <= smallest && steps >= 16) || cost > MOST || steps > 400_000 {
                break;
            }
            steps = if steps < 16 {
                2 * steps
            } else {
                (steps + 16).max((steps as f64 * 1.1 / 16.0) as u64 * 16)
            };
        }
        for (best, &tolerance) in cheapest.iter_mut().zip(tolerances) {
            for &([_, cost], steps) in tried.iter().rev().take_while(|([error, _], _)| *error <= tolerance) {
                if best.is_none_or(|(least, _, _)| cost < least) {
                    *best = Some((cost, method, steps));
                }
            }
        }
    }
    cheapest
}

/// The least of a few times that it takes, each of many calls.
fn seconds(mut call: impl FnMut()) -> f64 {
    let mut calls: u32 = 1;
    let mut time = |calls: u32| {
        let begun = Instant::now();
        (0..calls).for_each(|_| call());
        begun.elapsed().as_secs_f64()
    };
    while time(calls) < 2e-4 {
        calls *= 2;
    }
    (0..5).map(|_| time(calls) / f64::from(calls)).fold(f64::INFINITY, f64::min)
}

fn clock<L, M, const N: usize>(
    system: &L,
    methods: M,
    start: &State<f64, N>,
    [time, tolerance]: [f64; 2],
    (method, steps): (Method, u64),
) -> Option<Clock>
where
    L: OffersMethods<N> + Lagrangian<N, Scalar = f64>,
    M: Methods<L, N>,
{
    let request = system.to_error(tolerance).among(methods).until(time);
    let reached = request.end(start).ok()?;
    let through = |run: &mut dyn Iterator<Item = Result<Step<f64, N>, dalembert::StepError>>| {
        black_box(run.filter(|step| step.is_ok()).count());
    };
    Some(Clock {
        choice: seconds(|| {
            black_box(request.choice(start).is_ok());
        }),
        runs: [
            seconds(|| through(&mut reached.choice.unguarded())),
            seconds(|| through(&mut reached.choice.trajectory())),
        ],
        end: seconds(|| {
            black_box(request.end(start).is_ok());
        }),
        fixed: seconds(|| {
            let h = time / steps as f64;
            let mut step = methods.step(method, h).expect("it is offered");
            let mut state = *start;
            for k in 0..steps {
                let Ok(taken) = step.advance(system, h * k as f64, &state) else { break };
                state = taken.step.state;
            }
            black_box(state);
        }),
        steps: reached.choice.steps(),
    })
}
