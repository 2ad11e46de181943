//! Runs of mechanisms, each step of which is judged.

use dalembert::step::{Discrete, Flow, Step};
use dalembert::system::Constrained;
use dalembert::{Composition, Discretise, Lagrangian, Midpoint, State, StepError, Trapezoidal};

use super::{Curve, Drawn, End, Mechanism, Problem, Rule, off};

/// Steps of a run that are held against the second program.
const JUDGED: usize = 16;

/// Of them those whose root is followed from h = 0.
const FOLLOWED: usize = 3;

/// How a run went.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Why there is no start, if there is none.
    pub no_start: Option<StepError>,
    /// Steps taken.
    pub steps: usize,
    /// How far they were off the constraints at most, in roundings of the terms.
    pub off: f64,
    /// Steps held against the second program.
    pub judged: usize,
    /// The largest ratio of v̄ and of p1.
    pub ratios: [f64; 2],
    /// The largest difference of v̄ beside |v̄|.
    pub relative: f64,
    /// Steps next to which there is no root.
    pub rootless: usize,
    /// Steps whose root was followed from h = 0, and those that took another.
    pub followed: [usize; 2],
    /// Whether the energy is higher at the end than at the start, beyond rounding.
    pub has_gained: bool,
    /// The step that was refused, with the state before it, and where the curve of roots leads.
    pub refused: Option<Refused>,
    /// Whether the motion was at rest at the end.
    pub is_at_rest: bool,
}

/// A step that was refused.
#[derive(Clone, Debug)]
pub struct Refused {
    /// By what.
    pub error: StepError,
    /// From where.
    pub q: Vec<f64>,
    /// With which momentum.
    pub p: Vec<f64>,
    /// Its h.
    pub h: f64,
    /// The least pivot at the root, or the end of the curve.
    pub root: Result<f64, End>,
    /// Whether the step is taken from the state alone, without what a run has kept.
    pub is_taken_alone: bool,
}

/// A system whose steps are judged.
pub trait Judged<const N: usize, const M: usize>:
    Mechanism<N, M>
    + Constrained<N, M, Scalar = f64>
    + Lagrangian<N, Scalar = f64>
    + Flow<Midpoint, N>
    + Discrete<Midpoint, N>
    + Flow<Trapezoidal, N>
    + Discrete<Trapezoidal, N>
{
}

impl<L, const N: usize, const M: usize> Judged<N, M> for L where
    L: Mechanism<N, M>
        + Constrained<N, M, Scalar = f64>
        + Lagrangian<N, Scalar = f64>
        + Flow<Midpoint, N>
        + Discrete<Midpoint, N>
        + Flow<Trapezoidal, N>
        + Discrete<Trapezoidal, N>
{
}

/// The start of a run on the constraints.
///
/// # Errors
/// Those of [`State::nearest`].
pub fn start<L: Judged<N, M>, const N: usize, const M: usize>(
    system: &L,
    drawn: &Drawn,
) -> Result<State<f64, N>, StepError> {
    let of = |x: &[f64]| -> [f64; N] { core::array::from_fn(|i| x[i]) };
    State::nearest(system, of(&drawn.q), of(&drawn.v))
}

/// Makes the run, and judges it.
pub fn run<L: Judged<N, M>, const N: usize, const M: usize>(drawn: &Drawn) -> Outcome {
    let system = L::of(&drawn.values);
    let mut outcome = Outcome::default();
    let start = match start::<L, N, M>(&system, drawn) {
        Ok(start) => start,
        Err(error) => {
            outcome.no_start = Some(error);
            return outcome;
        }
    };
    match drawn.rule {
        Rule::Midpoint if drawn.is_composed => {
            composed::<L, _, N, M>(
                &system,
                drawn,
                start,
                Composition::kahan_li_6(Midpoint),
                Midpoint,
                &mut outcome,
            );
        }
        Rule::Trapezoidal if drawn.is_composed => {
            let composition = Composition::kahan_li_6(Trapezoidal);
            composed::<L, _, N, M>(&system, drawn, start, composition, Trapezoidal, &mut outcome);
        }
        Rule::Midpoint => plain::<L, _, N, M>(&system, drawn, start, Midpoint, &mut outcome),
        Rule::Trapezoidal => plain::<L, _, N, M>(&system, drawn, start, Trapezoidal, &mut outcome),
    }
    outcome
}

impl Outcome {
    fn look<const N: usize, const M: usize, L: Judged<N, M>>(&mut self, drawn: &Drawn, q: &[f64]) {
        self.off = self.off.max(off((&L::SHAPE, &drawn.values), q));
    }

    fn refuse(&mut self, problem: Problem<'_>, error: StepError, is_taken_alone: bool) {
        let root = match problem.followed() {
            Curve::Root(root) => Ok(root.least_pivot()),
            Curve::Ends(end) => Err(end),
        };
        let (q, p, h) = (problem.q.to_vec(), problem.p.to_vec(), problem.h);
        self.refused = Some(Refused { error, q, p, h, root, is_taken_alone });
    }

    fn judge<const N: usize>(&mut self, problem: Problem<'_>, step: &Step<f64, N>) {
        let judged = problem.judged(step.velocity.as_slice(), step.state.p.as_slice());
        self.judged += 1;
        match judged.velocity {
            None => self.rootless += 1,
            Some(velocity) => {
                self.ratios = [self.ratios[0].max(velocity), self.ratios[1].max(judged.momentum)];
                self.relative = self.relative.max(judged.relative);
            }
        }
        if self.followed[0] < FOLLOWED {
            self.followed[0] += 1;
            self.followed[1] += usize::from(!problem.is_followed(step.velocity.as_slice()));
        }
    }
}

fn plain<L, R, const N: usize, const M: usize>(
    system: &L,
    drawn: &Drawn,
    start: State<f64, N>,
    by: R,
    outcome: &mut Outcome,
) where
    L: Judged<N, M> + Flow<R, N> + Discrete<R, N>,
    R: Copy,
{
    let Drawn { values, h, rule, steps, .. } = drawn;
    let mut run = system.by(by, *h).run(start);
    let mut before = start;
    let energy = start.energy(system).unwrap_or(f64::NAN);
    let fastest = start.p.amax();
    for index in 0..*steps {
        let problem = Problem {
            shape: &L::SHAPE,
            values,
            rule: *rule,
            q: before.q.as_slice(),
            p: before.p.as_slice(),
            h: *h,
        };
        let step = match run.next() {
            Some(Ok(step)) => step,
            Some(Err(error)) => {
                let is_taken_alone = system.by(by, *h).step(&before).is_ok();
                outcome.refuse(problem, error, is_taken_alone);
                return;
            }
            None => return,
        };
        outcome.steps += 1;
        outcome.look::<N, M, L>(drawn, step.state.q.as_slice());
        let stride = (index / JUDGED + 1) * steps / 60;
        if index < JUDGED / 2
            || index % stride.max(1) == 0 && outcome.judged < 2 * JUDGED
            || step.report.damped > 0
        {
            outcome.judge(problem, &step);
        }
        before = step.state;
    }
    let reached = before.energy(system).unwrap_or(f64::NAN);
    outcome.has_gained = reached - energy > 1e-9 * energy.abs();
    outcome.is_at_rest = before.p.amax() <= 1e-9 * fastest;
}

fn composed<L, R, const N: usize, const M: usize>(
    system: &L,
    drawn: &Drawn,
    start: State<f64, N>,
    composition: Composition<R, 9>,
    by: R,
    outcome: &mut Outcome,
) where
    L: Judged<N, M> + Flow<R, N> + Discrete<R, N>,
    R: dalembert::rules::SelfAdjoint + Copy,
    Composition<R, 9>: Copy,
    L: Flow<Composition<R, 9>, N>,
{
    let Drawn { values, h, rule, steps, .. } = drawn;
    let shares = *composition.shares();
    let mut at = start;
    let mut run = system.by(composition, *h).run(start);
    for index in 0..*steps / 4 {
        let end = run.next();
        let mut last = (at, *h);
        for share in shares {
            let h = share * h;
            let problem =
                Problem { shape: &L::SHAPE, values, rule: *rule, q: at.q.as_slice(), p: at.p.as_slice(), h };
            let step = match system.by(by, h).step(&at) {
                Ok(step) => step,
                Err(error) => {
                    outcome.refuse(problem, error, false);
                    return;
                }
            };
            if index < 2 {
                outcome.judge(problem, &step);
            }
            last = (at, h);
            at = step.state;
        }
        match end {
            Some(Ok(step)) => at = step.state,
            // Its substeps are taken one by one.
            Some(Err(error)) => {
                let (State { q, p }, h) = last;
                let problem =
                    Problem { shape: &L::SHAPE, values, rule: *rule, q: q.as_slice(), p: p.as_slice(), h };
                outcome.refuse(problem, error, true);
                return;
            }
            None => return,
        }
        outcome.steps += 1;
        outcome.look::<N, M, L>(drawn, at.q.as_slice());
    }
}
