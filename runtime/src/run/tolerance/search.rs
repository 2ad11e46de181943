//! Which method, and at which step size: by trying them.

use nalgebra::ComplexField;

use super::drive::DRIVES;
use super::grid::{Bounds, segments};
use super::hardest::Hardest;
use super::scale::Scale;
use super::variation::{self, Variation};
use super::{Choice, Chosen, Method, MethodStep, Methods, ToleranceError, Trial, local_error};
use crate::numbers::Scalar;
use crate::numbers::random::Random;
use crate::step::{State, StepError};
use crate::system::{ActingForce, Lagrangian, is_timed};

/// The share of the tolerance that the error expected from the start may fill.
const SAFETY: f64 = 0.15;

/// The share of the run's cost that trying methods may take; that with looking at the motion along its first
/// steps; of these at least.
const TRYING: f64 = 0.04;
const CHOOSING: f64 = 0.085;
const EXPLORING: f64 = 0.02;

/// The cost of trying a step size, in usual steps: one, and two half ones, from no guess. The saving has to
/// be more by the factor `WORTH`.
const TRIAL: f64 = 1.5;
const WORTH: f64 = 4.0;

/// Step sizes tried of one method at most.
const TRIES: u32 = 12;

/// A method whose trial would have to be better than its first one by this factor is given up.
const HOPELESS: f64 = 1.5;

/// A start and its tolerance, with what is known of the motion there.
struct Start<'a, L: Lagrangian<N>, M, const N: usize> {
    system: &'a L,
    methods: M,
    state: State<L::Scalar, N>,
    time: f64,
    tolerance: f64,
    bounds: Bounds<'a>,
    /// The fewest steps by what is known before any is tried.
    fewest: f64,
    /// The fastest rate at which the motion changes.
    fastest: f64,
    /// A passage that the start does not show: the hardest step of a run that was tried.
    passage: Option<Hardest<L::Scalar, N>>,
    /// The factor of an error of p beside one of q.
    weight: f64,
    /// How far the motion goes in the time in which it changes: from rest at the origin, all that is known of
    /// its size.
    reach: f64,
    spent: f64,
}

/// Steps at most by which a passage is tried.
const PASSING: u32 = 16;

/// How often a force is looked for where a motion starts at rest.
const LOOKS: u32 = 256;

/// The local error and the cost of one step of a method: in the mean, as far as the start shows it and as far
/// as a passage does.
#[derive(Clone, Copy)]
struct Measured {
    local: f64,
    in_passage: f64,
    evaluations: f64,
}

/// A step size of a method.
#[derive(Clone, Copy)]
struct Candidate {
    method: Method,
    steps: f64,
    measured: Measured,
    expected: f64,
}

impl Measured {
    fn mean(&self) -> f64 {
        self.local + self.in_passage
    }
}

impl Candidate {
    fn cost(&self) -> f64 {
        self.steps * self.measured.evaluations
    }
}

pub(super) fn choice<'a, L, M, const N: usize>(
    (system, methods): (&'a L, M),
    state: &State<L::Scalar, N>,
    [time, tolerance]: [f64; 2],
    bounds: Bounds<'a>,
    passage: Option<Hardest<L::Scalar, N>>,
) -> Result<Choice<'a, L, M, N>, ToleranceError>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    state.require_finite().map_err(ToleranceError::Step)?;
    let mut start =
        Start::new((system, methods), *state, [time, tolerance], bounds).map_err(ToleranceError::Step)?;
    if let Some(passage) = passage {
        start.pass(passage);
    }
    start.look_for_motion()?;
    let mut trials = [None; Method::ALL.len()];
    let (mut best, mut too_many) = (None::<Candidate>, None::<Candidate>);
    // Those first that are known to be good at the error: the others need not be tried far.
    let mut order = Method::ALL;
    let asked = start.relative();
    let is_explicit = M::offers(Method::BlanesMoan6);
    let usual = |method: Method| method.usual_cost(asked, is_explicit);
    order.sort_unstable_by(|&a, &b| usual(a).total_cmp(&usual(b)));
    let mut failure = None;
    for method in order {
        if !M::offers(method) {
            continue;
        }
        let mut limit = f64::INFINITY;
        if let Some(best) = best {
            let usual = usual(method) / usual(best.method);
            let trial = TRIAL * method.usual_step(asked, is_explicit);
            // A method that should save more than its trial costs is tried.
            let saving = best.cost() * (1.0 - usual) / WORTH;
            limit = (start.spent + saving).max(TRYING * best.cost());
            if usual > 3.0 || start.spent + trial > limit {
                continue;
            }
        }
        let found = start.largest_step(method, best.map(|best| best.cost()), limit);
        match found {
            Ok(candidate) => {
                let index = Method::ALL.iter().position(|of| *of == method);
                if let Some(trial) = index.and_then(|index| trials.get_mut(index)) {
                    *trial = Some(start.trial(&candidate));
                }
                let reaches = candidate.expected <= tolerance;
                let share = start.share(&candidate);
                if reaches && share > 1.0 {
                    if too_many.is_none_or(|least| share < start.share(&least)) {
                        too_many = Some(candidate);
                    }
                } else if reaches && best.is_none_or(|best| candidate.cost() < best.cost()) {
                    best = Some(candidate);
                }
            }
            Err(error) => failure = Some(error),
        }
    }
    let Some(mut best) = best else {
        if let Some(least) = too_many {
            return Err(start.too_many(&least, least.steps));
        }
        let shown = trials.iter().flatten();
        let closest = shown.min_by(|a, b| a.expected.total_cmp(&b.expected)).copied();
        return Err(match (closest, failure) {
            (None, Some(Some(error))) => ToleranceError::Step(error),
            _ => ToleranceError::OutOfReach { closest },
        });
    };
    start.explore(&mut best);
    if best.expected.is_nan() || best.expected > tolerance {
        return Err(ToleranceError::OutOfReach { closest: Some(start.trial(&best)) });
    }
    let step_size = time / best.steps;
    let steps = segments(time, step_size, &bounds.breaks).last().map_or(0, |segment| segment.steps[1]);
    if bounds.share(steps as f64, best.cost()) > 1.0 {
        return Err(start.too_many(&best, steps as f64));
    }
    let chosen = Chosen {
        start: *state,
        method: best.method,
        time,
        breaks: bounds.breaks,
        step_size,
        steps,
        is_watchful: bounds.longest.is_finite(),
        tolerance,
        aim: tolerance,
        expected: best.expected,
        local: best.measured.mean(),
        evaluations_per_step: best.measured.evaluations,
        roundings: best.method.roundings(),
        rate: start.fastest,
        spent: start.spent,
        trials,
    };
    Ok(Choice { system, methods, chosen })
}

impl<'a, L, M, const N: usize> Start<'a, L, M, N>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    fn new(
        (system, methods): (&'a L, M),
        state: State<L::Scalar, N>,
        [time, tolerance]: [f64; 2],
        bounds: Bounds<'a>,
    ) -> Result<Self, StepError> {
        let velocity = state.velocity(system)?;
        let mut start = Self {
            system,
            methods,
            state,
            time,
            tolerance,
            bounds,
            fewest: ComplexField::ceil(time / bounds.longest * (1.0 - 1e-12)).max(1.0),
            fastest: 1.0 / time,
            passage: None,
            weight: 0.0,
            reach: 0.0,
            spent: 4.0,
        };
        start.spent += variation::cost::<L, N>();
        if let Some(variation) = Variation::at((system, methods), &state, &velocity) {
            start.fastest = variation.fastest.widen().max(1.0 / time);
            start.weight = variation.matrix.q_by_p.norm().widen() / start.fastest;
            start.reach = start.reach_of(&variation);
        }
        if is_timed(system) {
            for share in DRIVES {
                start.spent += variation::cost::<L, N>();
                let at = |system: &L| Variation::at((system, methods), &state, &velocity);
                if let Some(variation) = system.later(L::Scalar::constant(share * time), at) {
                    start.reach = start.reach.max(start.reach_of(&variation));
                }
            }
        }
        Ok(start)
    }

    /// Looks for a force that comes later, where the system takes the time and the motion starts at rest: at
    /// the start every step errs by nothing.
    fn look_for_motion(&mut self) -> Result<(), ToleranceError> {
        if self.bounds.are_given() || !is_timed(self.system) || self.reach > 0.0 {
            return Ok(());
        }
        let zero = nalgebra::SVector::zeros();
        let methods = self.methods;
        let Some(rest) = Variation::at((self.system, methods), &self.state, &zero) else { return Ok(()) };
        let (mut seen, mut is_driven) = (0, false);
        let mut random = Random::new(0x5851_f42d_4c95_7f2d);
        for look in 0..LOOKS {
            self.spent += variation::cost::<L, N>();
            let within = (f64::from(look) + random.unit()) / f64::from(LOOKS);
            let at = |system: &L| rest.in_time((system, methods));
            let Some(later) = self.system.later(L::Scalar::constant(within * self.time), at) else {
                continue;
            };
            let reach = self.reach_of(&later);
            seen += u32::from(reach > 0.0);
            self.reach = self.reach.max(reach);
            is_driven |= rest.is_another(&later);
        }
        if seen == 0 {
            // A drive of the springs, say, is seen, and moves nothing that rests where they push nowhere.
            if is_driven {
                return Ok(());
            }
            let apart = self.time / f64::from(LOOKS);
            return Err(ToleranceError::NothingMoves { looks: LOOKS, apart });
        }
        // Seen so often, it is seen by a guard that looks twice a step.
        self.fewest = self.fewest.max(ComplexField::ceil(f64::from(LOOKS) / f64::from(seen)));
        Ok(())
    }

    /// Tries steps in this passage as well, where the motion may be faster.
    fn pass(&mut self, passage: Hardest<L::Scalar, N>) {
        let Hardest { state, elapsed, .. } = passage;
        self.spent += variation::cost::<L, N>();
        let variation = self.system.later(L::Scalar::constant(elapsed), |system| {
            Variation::at((system, self.methods), &state, &state.velocity(system).ok()?)
        });
        self.fastest = variation.map_or(0.0, |variation| variation.fastest.widen()).max(self.fastest);
        self.passage = Some(passage);
    }

    /// |v| τ, and from rest |M⁻¹ ṗ| τ²/2, with τ the time in which the motion changes.
    fn reach_of(&self, variation: &Variation<L::Scalar, N>) -> f64 {
        let tau = 1.0 / self.fastest;
        let acceleration = (variation.matrix.q_by_p * variation.rate.p).amax().widen();
        let reach = tau * variation.rate.q.amax().widen().max(0.5 * tau * acceleration);
        if reach.is_finite() { reach } else { 0.0 }
    }

    /// The tolerance by radian of the fastest motion, as a share of the state.
    fn relative(&self) -> f64 {
        let size = self.size();
        SAFETY * self.tolerance / (size * self.fastest * self.time)
    }

    fn size(&self) -> f64 {
        let size = self.state.q.amax().widen().max(self.state.p.amax().widen() * self.weight);
        size.max(self.reach).max(self.tolerance)
    }

    fn norm(&self, error: &State<L::Scalar, N>) -> f64 {
        error.q.amax().widen().max(error.p.amax().widen() * self.weight)
    }

    fn share(&self, candidate: &Candidate) -> f64 {
        self.bounds.share(candidate.steps, candidate.cost())
    }

    fn too_many(&self, least: &Candidate, steps: f64) -> ToleranceError {
        self.bounds.refusal(self.trial(least), steps, self.fastest)
    }

    fn trial(&self, candidate: &Candidate) -> Trial {
        Trial {
            method: candidate.method,
            step_size: self.time / candidate.steps,
            evaluations: candidate.cost(),
            expected: candidate.expected,
        }
    }

    /// One step from `state` against two half ones; neither where the caller has stopped the search.
    fn measure(
        &mut self,
        method: Method,
        steps: f64,
        state: &State<L::Scalar, N>,
        elapsed: f64,
    ) -> Result<Measured, Option<StepError>> {
        if self.bounds.stop.is_asked() {
            return Err(None);
        }
        let h = L::Scalar::constant(self.time / steps);
        let half = h * L::Scalar::constant(0.5);
        let mut whole = self.methods.step(method, h).ok_or(None)?;
        let mut halves = self.methods.step(method, half).ok_or(None)?;
        whole.leave(self.tolerance, steps as u64, self.weight);
        let system = self.system;
        let whole = whole.advance(system, elapsed, state).map_err(Some)?;
        let first = halves.advance(system, elapsed, state).map_err(Some)?;
        let second = halves.advance(system, elapsed + half.widen(), &first.step.state).map_err(Some)?;
        self.spent += whole.evaluations + first.evaluations + second.evaluations;
        let local = self.norm(&local_error(method.order(), &whole.step.state, &second.step.state));
        Ok(Measured { local, in_passage: 0.0, evaluations: whole.evaluations })
    }

    /// The largest local error in the passage, times the share of the steps that err so.
    ///
    /// It ends where the system breaks: no step of a run goes over that, and the jump is no error of one.
    fn measure_passage(
        &mut self,
        method: Method,
        steps: f64,
        passage: &Hardest<L::Scalar, N>,
    ) -> Result<f64, Option<StepError>> {
        let Hardest { mut state, mut elapsed, span, .. } = *passage;
        let (time, breaks) = (self.time, self.bounds.breaks);
        let mut segments = segments(time, time / steps, &breaks);
        let Some(segment) = segments.find(|segment| elapsed < segment.to()) else { return Ok(0.0) };
        let left = segment.to() - elapsed;
        let h = segment.step_size().min(left);
        let fitting = ComplexField::floor(left / h * (1.0 + 1e-12));
        let count = ComplexField::ceil(span / h).min(fitting);
        let mut largest = 0.0_f64;
        let mut step = self.methods.step(method, L::Scalar::constant(h)).ok_or(None)?;
        for _ in 0..(count as u32).clamp(1, PASSING) {
            largest = largest.max(self.measure(method, time / h, &state, elapsed)?.local);
            let taken = step.advance(self.system, elapsed, &state).map_err(Some)?;
            self.spent += taken.evaluations;
            (state, elapsed) = (taken.step.state, elapsed + h);
        }
        Ok(passage.share() * largest)
    }

    /// One step from the start against two half ones, and where the system breaks on the way one from the
    /// same state there: what steps err by in the mean.
    fn measure_along(&mut self, method: Method, steps: f64) -> Result<Measured, Option<StepError>> {
        let (state, mut local, mut evaluations) = (self.state, 0.0, 0.0);
        let h = self.time / steps;
        let (time, breaks) = (self.time, self.bounds.breaks);
        for segment in segments(time, h, &breaks) {
            let measured = self.measure(method, self.time / segment.step_size(), &state, segment.from())?;
            let share = (segment.steps[1] - segment.steps[0]) as f64 / steps;
            local += measured.local * share;
            evaluations += measured.evaluations * share;
        }
        let in_passage =
            self.passage.map_or(Ok(0.0), |passage| self.measure_passage(method, steps, &passage))?;
        Ok(Measured { local, in_passage, evaluations })
    }

    /// The error over so many steps that err by `local`.
    fn expected(&self, method: Method, steps: f64, local: f64) -> f64 {
        let rounding = L::Scalar::EPSILON.widen() * self.size();
        // What rounding shows of the step and its halves.
        let noise = 2.0 * rounding * method.roundings().sqrt();
        let local = ComplexField::sqrt((local * local - noise * noise).max(0.0));
        local * steps + 2.0 * rounding * ComplexField::sqrt(steps * method.roundings())
    }

    /// The largest step tried at which the error expected fills no more than its share.
    ///
    /// Trying ends where it has cost up to the `limit`.
    fn largest_step(
        &mut self,
        method: Method,
        best: Option<f64>,
        limit: f64,
    ) -> Result<Candidate, Option<StepError>> {
        let p = f64::from(method.order());
        let angle = method.usual_angle(self.relative());
        let mut steps = ComplexField::ceil(self.fastest * self.time / angle).max(self.fewest);
        let (mut good, mut least, mut failure) = (None::<Candidate>, 0.0, None);
        let mut closest = None::<Candidate>;
        for _ in 0..TRIES {
            let next = match self.measure_along(method, steps) {
                Err(error) => {
                    failure = error;
                    least = steps;
                    2.0 * steps
                }
                Ok(measured) => {
                    let expected = self.expected(method, steps, measured.mean());
                    let candidate = Candidate { method, steps, measured, expected };
                    if closest.is_none_or(|closest| expected < closest.expected) {
                        closest = Some(candidate);
                    }
                    let ratio = SAFETY * self.tolerance / expected;
                    let factor = ComplexField::powf(ratio, 1.0 / p);
                    if ratio >= 1.0 {
                        good = Some(candidate);
                        if factor < 1.15 || steps <= self.fewest {
                            break;
                        }
                        ComplexField::ceil(steps / factor.min(3.0) * 1.02).max(self.fewest)
                    } else {
                        least = steps;
                        let next = ComplexField::ceil(steps / factor.max(0.1) * 1.03).max(steps + 1.0);
                        // The dearer, the finer: not worth it where another method is cheaper already.
                        if best.is_some_and(|best| next * measured.evaluations > HOPELESS * best) {
                            break;
                        }
                        next
                    }
                }
            };
            steps = match good {
                // Between what was too long and what was not.
                Some(good) if next >= good.steps || next <= least => {
                    let between = ComplexField::ceil(ComplexField::sqrt(good.steps * least.max(1.0)));
                    if between >= good.steps || good.steps < 1.15 * least {
                        break;
                    }
                    between
                }
                _ => next,
            };
            if steps.is_nan() || steps >= 1e15 {
                break;
            }
            let is_worth = |good: Candidate| {
                let saving = (good.steps - steps) * good.measured.evaluations;
                self.spent < TRYING * good.cost() || saving > WORTH * good.measured.evaluations
            };
            if good.is_some_and(|good| !is_worth(good)) || (good.is_none() && self.spent >= limit) {
                break;
            }
        }
        good.or(closest).ok_or(failure)
    }

    /// Looks at the first steps of the run, and shortens or lengthens the step by what they show.
    ///
    /// The start is one of the places looked at: what follows it may be smoother for a while, as from a
    /// pericentre outwards, and alone it would ask for steps that the start does not bear. After the step has
    /// changed, the error there is taken to have gone with its power.
    fn explore(&mut self, best: &mut Candidate) {
        let Bounds { most, costliest, .. } = self.bounds;
        let cost = (best.steps.min(most as f64) * best.measured.evaluations).min(costliest);
        let budget = (self.spent + EXPLORING * cost).max(CHOOSING * cost);
        let p = f64::from(best.method.order());
        let (at_start, in_passage, of_steps) = (best.measured.local, best.measured.in_passage, best.steps);
        let mut remaining = 3;
        while remaining > 0 {
            remaining -= 1;
            let method = best.method;
            let h = self.time / best.steps;
            let Some(mut step) = self.methods.step(method, L::Scalar::constant(h)) else { return };
            step.leave(self.tolerance, best.steps as u64, self.weight);
            let (mut state, mut sum, mut looks, mut taken) = (self.state, 0.0, 0.0, 0.0);
            let (mut evaluations, mut stopped) = (0.0, false);
            let mut scale = Scale::new(&state);
            let round = self.spent + (budget - self.spent) / (f64::from(remaining) + 1.0);
            while taken < best.steps && self.spent + 4.0 * best.measured.evaluations <= round {
                let Ok(next) = step.advance(self.system, h * taken, &state) else {
                    stopped = true;
                    break;
                };
                scale.follow(&state, &next.step.state);
                self.weight = self.weight.max(scale.weight());
                state = next.step.state;
                taken += 1.0;
                self.spent += next.evaluations;
                evaluations += next.evaluations;
                if taken % 2.0 == 0.0 && taken < best.steps {
                    match self.measure(method, best.steps, &state, h * taken) {
                        Ok(measured) => {
                            sum += measured.local;
                            looks += 1.0;
                        }
                        Err(_) => {
                            stopped = true;
                            break;
                        }
                    }
                }
            }
            if stopped {
                best.steps = ComplexField::ceil(best.steps * 1.5);
                continue;
            }
            if looks == 0.0 {
                return;
            }
            let power = ComplexField::powf(of_steps / best.steps, p + 1.0);
            best.measured.local = (at_start * power + sum) / (1.0 + looks);
            best.measured.in_passage = in_passage * power;
            if taken > 0.0 {
                best.measured.evaluations = evaluations / taken;
            }
            best.expected = self.expected(method, best.steps, best.measured.mean());
            let ratio = SAFETY * self.tolerance / best.expected;
            let factor = ComplexField::powf(ratio, 1.0 / p);
            if (0.95..1.3).contains(&factor) {
                return;
            }
            best.steps = ComplexField::ceil(best.steps / factor.clamp(0.3, 1.5) * 1.02).max(self.fewest);
        }
    }
}
