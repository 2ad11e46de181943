//! The error of a run, carried along it.
//!
//! ```text
//! δ_{k+1} = A_k δ_k + d_k        d_k: what one step errs by, A_k: the tangent map of the motion
//! ```

use nalgebra::SVector;

use super::Methods;
use super::drive::{DRIVES, Drive};
use super::phase::plus;
use super::scale::Scale;
use super::shift::{along_the_motion, shift};
use super::tangent::carried;
use super::twin::{self, Kept};
use super::variation::{self, Variation};
use crate::numbers::Scalar;
use crate::numbers::random::Random;
use crate::step::State;
use crate::system::{ActingForce, Lagrangian, is_timed};

/// The angle by which an error turns between two derivatives at most, without states between and with them.
const ANGLE: [f64; 2] = [0.3, 1.5];

/// The larger where the system takes the time: states between are known to less.
const ANGLE_IN_TIME: f64 = 1.0;

/// An error of the energy beyond so many times what was foreseen is news.
const UNFORESEEN: f64 = 10.0;

/// Parts of the way between two states at most, and what a part costs: J at its end and at a state within.
const MOST_PARTS: f64 = 8.0;
const PART: f64 = 4.0;

/// Shares that are unsure: of the local errors added up, and of an error carried over the larger [`ANGLE`].
const UNSURE: [f64; 2] = [0.3, 0.02];

/// Where J changes by less than this, squared, its mean serves for any number of turns.
const SLIGHT: f64 = 0.1;

/// The share of a change of J that still counts at the next state.
const REMEMBERED: f64 = 0.8;

/// Growth between two looks at most: more may be that of the norm alone.
const MOST_GROWTH: f64 = 4.0;

/// The number of samples of δ's uncertainty.
const SAMPLES: usize = 2;

/// The run between two states that were looked at.
pub(super) struct Since<S, const N: usize> {
    /// Steps.
    pub(super) steps: f64,
    /// Roundings of q in each.
    pub(super) roundings: f64,
    /// The error of those of a Gauss method not looked at: one, and how often it may have been made.
    pub(super) passed: (State<S, N>, f64),
    /// The error of the energy foreseen.
    pub(super) foreseen: f64,
    /// The evaluations that derivatives on the way may take.
    pub(super) affordable: f64,
    /// Whether the energy is asked for.
    pub(super) is_energy: bool,
    /// The time to the end of the run.
    pub(super) ahead: f64,
}

/// The error of a run so far.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Estimate<S: Scalar, const N: usize> {
    /// δ, the run less the motion, at the state last looked at.
    error: State<S, N>,
    /// Random samples of δ's uncertainty: by rounding, by the error of δ itself, and by steps that were not
    /// looked at. Where motions part they grow in directions in which δ may have no part.
    unsure: [State<S, N>; SAMPLES],
    random: Random,
    /// The motion there, and its time.
    last: Option<(Variation<S, N>, f64)>,
    /// The size of the state's rounding error, without growth.
    rounding: f64,
    /// The energy at the start, and its error when it was asked for last; nothing where it is not kept.
    energy: Option<[S; 2]>,
    /// By how much errors have grown since local errors were added last.
    growth: f64,
    /// Whether the system changes with time.
    is_timed: bool,
    /// How J changes with it, where it does.
    drive: Option<Drive<S, N>>,
    is_coarse: bool,
    /// The share of J that has changed between two states, as far as one J does not serve over them.
    share: f64,
    /// The angle by which an error turned in the last unit of time, as far as one J did not serve.
    pub(super) speed: f64,
    /// The cost of the derivatives so far, in evaluations.
    pub(super) evaluations: f64,
}

impl<S: Scalar, const N: usize> Estimate<S, N> {
    /// Of no error yet; `is_coarse` where the cost of derivatives forbids to follow every turn of the error.
    pub(super) fn new<L: Lagrangian<N, Scalar = S>>(system: &L, is_coarse: bool) -> Self {
        let none = State { q: SVector::zeros(), p: SVector::zeros() };
        Self {
            is_coarse,
            error: none,
            unsure: [none; SAMPLES],
            random: Random::new(0x2545_f491_4f6c_dd1d),
            last: None,
            rounding: 0.0,
            energy: None,
            growth: 1.0,
            is_timed: is_timed(system),
            drive: None,
            share: 0.0,
            speed: f64::INFINITY,
            evaluations: 0.0,
        }
    }

    /// The angle by which an error may turn from one state of the run to the next.
    pub(super) fn angle(&self) -> f64 {
        if self.is_timed { ANGLE_IN_TIME } else { ANGLE[1] }
    }

    /// Whether J changes with time.
    pub(super) fn is_driven(&self) -> bool {
        self.drive.is_some()
    }

    /// Whether the error is not followed in every turn.
    pub(super) fn is_coarse(&self) -> bool {
        self.is_coarse
    }

    /// Steps of size `h` over which a twin may carry the error at once.
    pub(super) fn twin_stride(&self, h: f64, most: u64) -> u64 {
        self.last.map_or(1, |(last, _)| twin::stride(last.fastest.widen(), h, most))
    }

    /// Carries δ alone, from `state` on, by a twin of the motion.
    pub(super) fn carry_by_twin<L, M>(
        &mut self,
        system: &L,
        methods: M,
        state: &State<S, N>,
        [elapsed, time]: [f64; 2],
        scale: &Scale<S, N>,
        kept: &mut Kept<M::Step>,
    ) where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let Some((last, _)) = &self.last else { return };
        let rate = last.fastest.widen();
        if scale.norm(&self.error) > 0.0
            && let Some((error, evaluations)) =
                twin::carried((system, methods), state, &self.error, [elapsed, time, rate], scale, kept)
        {
            self.error = error;
            self.evaluations += evaluations;
        }
    }

    /// Whether the system changes with time.
    pub(super) fn is_timed(&self) -> bool {
        self.is_timed
    }

    /// Adds what the last step errs by, `local` at the state last looked at, and as much for each of `before`
    /// steps: those have grown since, as errors did on the way.
    pub(super) fn add(&mut self, local: &State<S, N>, before: f64) {
        // On a line growth is shear, and what comes late has none.
        let is_line = N == 1 && !self.is_timed;
        let growth = if is_line || self.is_coarse { 1.0 } else { self.growth.min(MOST_GROWTH) };
        let mean = if growth > 1.01 { (growth - 1.0) / nalgebra::ComplexField::ln(growth) } else { 1.0 };
        self.growth = 1.0;
        let steps = S::constant(1.0 + before * mean);
        self.error.q += local.q * steps;
        self.error.p += local.p * steps;
        self.err(local, steps.widen() * UNSURE[0]);
    }

    /// Adds `share × of`, with random signs, to each sample of δ's uncertainty.
    fn err(&mut self, of: &State<S, N>, share: f64) {
        let mut next = || S::constant(share * self.random.sign());
        for unsure in &mut self.unsure {
            unsure.q += of.q.map(|x| x * next());
            unsure.p += of.p.map(|x| x * next());
        }
    }

    /// By how much the force at the state last looked at is another at `time`.
    pub(super) fn change_of_force<L, M>(&mut self, (system, methods): (&L, M), time: f64) -> f64
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let Some((last, _)) = &self.last else { return 0.0 };
        self.evaluations += 1.0;
        system.later(S::constant(time), |later| last.change_of_force((later, methods)))
    }

    /// The motion at `state`.
    fn variation<L, M>(
        &mut self,
        (system, methods): (&L, M),
        state: &State<S, N>,
        time: f64,
    ) -> Option<Variation<S, N>>
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        self.evaluations += variation::cost::<L, N>();
        let guess = self.last.map(|(last, _)| last.velocity_at(state));
        system.later(S::constant(time), |system| {
            let near = guess.and_then(|guess| Variation::at((system, methods), state, &guess));
            near.or_else(|| Variation::at((system, methods), state, &state.velocity(system).ok()?))
        })
    }

    /// Goes on from `state` at `time`, where the system has become another.
    pub(super) fn resume<L, M>(&mut self, motion: (&L, M), state: &State<S, N>, time: f64)
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        if let Some(variation) = self.variation(motion, state, time) {
            self.last = Some((variation, time));
        }
        self.speed = f64::INFINITY;
    }

    /// Carries the error on to `state` at `time`. An error of the energy beyond what is foreseen stands for
    /// others besides, of a step that was not looked at.
    pub(super) fn carry<L, M>(
        &mut self,
        motion: (&L, M),
        state: &State<S, N>,
        time: f64,
        scale: &Scale<S, N>,
        since: &Since<S, N>,
    ) where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let Some(variation) = self.variation(motion, state, time) else { return };
        let unit = variation.of_unit_energy(scale);
        if let Some((last, before)) = self.last {
            self.transport(motion, [&last, &variation], [before, time], &unit, scale, since);
        }
        let elapsed = time - self.last.map_or(0.0, |last| last.1);
        if self.is_timed && self.last.is_none() {
            self.drive = self.driven(motion, &variation, since.ahead);
        }
        let rounding = rounding(&variation, state, scale, elapsed, since);
        self.rounding = nalgebra::ComplexField::hypot(self.rounding, scale.norm(&rounding));
        self.err(&rounding, 2.0);
        // Until the next look all that has passed may have grown.
        let (local, times) = &since.passed;
        if *times > 0.0 {
            self.err(local, *times);
        }
        if self.is_timed || variation.is_forced {
            self.energy = None;
        } else if self.last.is_none() {
            self.energy = Some([variation.energy(motion.0), S::zero()]);
        } else if let (Some([start, error]), true) = (self.energy, since.is_energy) {
            self.evaluations += 3.0;
            let now = variation.energy(motion.0) - start;
            self.energy = Some([start, now]);
            let made = scale.norm(&unit) * nalgebra::ComplexField::abs((now - error).widen());
            if made > UNFORESEEN * since.foreseen + 4.0 * self.rounding {
                self.err(&scale.of_size(made), 2.0);
            }
            self.error = variation.with_energy(&self.error, now, &unit);
        }
        if self.energy.is_some() {
            self.unsure = self.unsure.map(|error| variation.with_energy(&error, S::zero(), &unit));
        }
        self.last = Some((variation, time));
    }

    /// How J changes with time at the state where the run starts, over the time `ahead`; `None` where it does
    /// not.
    fn driven<L, M>(
        &mut self,
        (system, methods): (&L, M),
        start: &Variation<S, N>,
        ahead: f64,
    ) -> Option<Drive<S, N>>
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let is_other = DRIVES.into_iter().any(|share| {
            self.evaluations += variation::cost::<L, N>();
            let later = |system: &L| start.in_time((system, methods));
            let later = system.later(S::constant(share * ahead), later);
            later.is_none_or(|later| start.is_another(&later))
        });
        is_other.then(|| Drive::from(start))
    }

    /// The errors `from` one state `to` another: where they turn far, by way of states between.
    fn transport<L, M>(
        &mut self,
        (system, methods): (&L, M),
        [last, to]: [&Variation<S, N>; 2],
        [before, time]: [f64; 2],
        unit: &State<S, N>,
        scale: &Scale<S, N>,
        since: &Since<S, N>,
    ) where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let size = scale.norm(&self.error);
        let t = S::constant(time - before);
        // Once around, J is what it was: what has been seen to change is forgotten by little.
        let (fastest, share) = last.change_to(to);
        self.share = share.max(REMEMBERED * self.share);
        // What changes by more than slightly is followed within a turn.
        let share = if self.share < SLIGHT { self.share } else { self.share.max(0.5) };
        self.speed = fastest * share;
        if let Some(drive) = &mut self.drive {
            drive.forget();
            drive.follow([last, to], time - before);
            self.speed = self.speed.max(drive.rate());
        }
        let angle = self.speed * t.widen();
        let most = if self.is_coarse { 1.0 } else { (since.affordable / PART).clamp(1.0, MOST_PARTS) };
        let parts =
            nalgebra::ComplexField::ceil((angle / self.angle()).min(nalgebra::ComplexField::floor(most)))
                .max(1.0);
        let part = t / S::constant(parts);
        let is_slight = self.share < SLIGHT && self.drive.is_none();
        let is_short = self.is_coarse || is_slight || angle < ANGLE[0] || since.affordable < PART;
        let is_timed = self.is_timed;
        let drive = &mut self.drive;
        let evaluations = &mut self.evaluations;
        let mut between = |from: &Variation<S, N>, [since, share]: [f64; 2]| {
            let after = (share - since) * part.widen();
            let share = S::constant(share / parts);
            let state = last.between(to, t, share, is_timed);
            let guess = from.velocity_at(&state);
            *evaluations += variation::cost::<L, N>();
            let at = |system: &L| Variation::at((system, methods), &state, &guess);
            let found = system.later(S::constant(before) + share * t, at);
            if let (Some(drive), Some(found)) = (drive.as_mut(), &found) {
                drive.follow([from, found], after);
            }
            found
        };
        let [a, b] = self.unsure;
        let (mut from, mut errors) = (*last, [self.error, a, b]);
        for k in 0..parts as u32 {
            let k = f64::from(k);
            let middle = if is_short { None } else { between(&from, [k, k + 0.5]) };
            let end = if k + 1.0 < parts { between(&from, [k, k + 1.0]) } else { None };
            let end = end.unwrap_or(*to);
            errors = if is_timed {
                carried(errors, &from, middle.as_ref(), &end, part)
            } else {
                along_the_motion(errors, &from, middle.as_ref(), &end, part, scale)
            };
            from = end;
        }
        if self.is_coarse {
            errors[0] = self.error;
        } else if self.energy.is_some() {
            errors[0] = to.with_energy(&errors[0], last.energy_of(&self.error), unit);
        }
        [self.error, self.unsure[0], self.unsure[1]] = errors;
        let shift = if is_timed { S::zero() } else { shift(&self.error, &to.rate, scale) };
        let across = plus(&self.error, &to.rate, -shift);
        self.err(&across, UNSURE[1] * (angle / parts / self.angle()).min(1.0));
        let growth = scale.norm(&self.error) / size;
        if growth.is_finite() {
            self.growth *= growth;
        }
    }

    /// `error` at the state last looked at, and what a quarter of a turn of the fastest mode makes of it: a
    /// mode's error is one of q at times and one of p at others, and the norm weighs these as they count
    /// in the slow modes.
    pub(super) fn over_a_turn(&self, error: &State<S, N>, scale: &Scale<S, N>) -> [State<S, N>; 2] {
        [*error, self.last.map_or(*error, |(last, _)| last.turned(error, scale))]
    }

    /// The error expected of the state last looked at.
    pub(super) fn size(&self, scale: &Scale<S, N>) -> f64 {
        let [a, b] = &self.unsure;
        let sizes = [&self.error, a, b].map(|error| scale.largest(&self.over_a_turn(error, scale)));
        nalgebra::ComplexField::sqrt(sizes.map(|size| size * size).iter().sum::<f64>())
    }
}

/// The rounding error of the state over some steps: of q and p by their own rounding, and of p by that of the
/// forces in the fastest mode.
fn rounding<S: Scalar, const N: usize>(
    at: &Variation<S, N>,
    state: &State<S, N>,
    scale: &Scale<S, N>,
    time: f64,
    since: &Since<S, N>,
) -> State<S, N> {
    let root = nalgebra::ComplexField::sqrt;
    let each =
        scale.of_size(S::EPSILON.widen() * scale.furthest.widen() * root(since.roundings * since.steps));
    let angle = at.fastest.widen() * time / since.steps.max(1.0);
    let of_force = S::EPSILON.widen() * state.q.amax().widen() * at.impedance * angle * root(since.steps);
    State { q: each.q, p: each.p.add_scalar(S::constant(of_force)) }
}
