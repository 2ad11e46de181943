//! The error of a run, carried along it.
//!
//! ```text
//! δ_{k+1} = A_k δ_k + d_k        d_k: what one step errs by, A_k: the tangent map of the motion
//! ```

use nalgebra::SVector;

use super::Methods;
use super::variation::{Variation, carried};
use crate::{Lagrangian, Scalar, State};

/// How an error of p counts beside one of q: the norm of a [`Choice`](super::Choice)'s promise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale<S, const N: usize> {
    start: SVector<S, N>,
    /// The largest distance of a coordinate from its start, and the largest momentum.
    reached: [S; 2],
    /// The largest change of a coordinate and of a momentum over a step.
    change: [S; 2],
    /// The largest coordinate.
    largest: S,
}

impl<S: Scalar, const N: usize> Scale<S, N> {
    pub(super) fn new(start: &State<S, N>) -> Self {
        let zero = S::zero();
        Self { start: start.q, reached: [zero, start.p.amax()], change: [zero; 2], largest: start.q.amax() }
    }

    #[inline]
    pub(super) fn follow(&mut self, from: &State<S, N>, to: &State<S, N>) {
        self.reached = [self.reached[0].max((to.q - self.start).amax()), self.reached[1].max(to.p.amax())];
        self.change =
            [self.change[0].max((to.q - from.q).amax()), self.change[1].max((to.p - from.p).amax())];
        self.largest = self.largest.max(to.q.amax());
    }

    /// What an error of p is multiplied by.
    pub(super) fn weight(&self) -> f64 {
        let ratio = |[q, p]: [S; 2]| if p > S::zero() { (q / p).widen() } else { f64::INFINITY };
        let weight = ratio(self.reached).min(ratio(self.change));
        if weight.is_finite() { weight } else { 0.0 }
    }

    pub(super) fn norm(&self, error: &State<S, N>) -> f64 {
        error.q.amax().widen().max(error.p.amax().widen() * self.weight())
    }
}

/// The angle by which an error turns between two derivatives at most, without one at the middle and with it.
pub(super) const ANGLE: [f64; 2] = [1.4, 2.0];

/// An error of the energy beyond so many times what was foreseen is news.
const UNFORESEEN: f64 = 10.0;

/// Parts of the way between two states at most, and what a part costs: J at its end and at its middle.
const MOST_PARTS: f64 = 8.0;
const PART: f64 = 4.0;

/// What the sum of local errors, and what their growth between two states, is taken to err by.
const UNSURE: [f64; 2] = [0.3, 0.05];

/// Growth between two looks at most: more may be that of the norm alone.
const MOST_GROWTH: f64 = 4.0;

/// The run between two states that were looked at.
pub(super) struct Since {
    /// Steps.
    pub(super) steps: f64,
    /// Roundings of q in each.
    pub(super) roundings: f64,
    /// The error of the energy foreseen.
    pub(super) foreseen: f64,
    /// What derivatives on the way may cost.
    pub(super) affordable: f64,
    /// Whether the energy is asked for.
    pub(super) is_energy: bool,
}

/// The error of a run so far.
pub(super) struct Estimate<S, const N: usize> {
    /// δ, the run less the motion, at the state last looked at.
    error: State<S, N>,
    /// What δ may err by itself, at random: where motions part, it grows in directions in which δ may have no part. 0 where none do.
    unsure: State<S, N>,
    random: u64,
    is_unsure: bool,
    /// The motion there, and its time.
    last: Option<(Variation<S, N>, f64)>,
    /// What rounding has made of the state.
    rounding: f64,
    /// What steps that were not looked at have made of it, as the energy tells.
    unseen: f64,
    /// The energy at the start; nothing where it is not kept.
    energy: Option<S>,
    /// By how much errors have grown since local errors were added last.
    growth: f64,
    /// Whether the system changes with time.
    is_timed: bool,
    is_planar: bool,
    is_coarse: bool,
    /// The angle by which an error turned in the last unit of time, as far as one J did not serve.
    pub(super) speed: f64,
    /// What the derivatives have cost.
    pub(super) evaluations: f64,
}

impl<S: Scalar, const N: usize> Estimate<S, N> {
    /// Of no error yet; `is_close` where the cost of derivatives does not matter, `is_coarse` where it forbids to
    /// follow every turn of the error.
    pub(super) fn new<L: Lagrangian<N, Scalar = S>>(system: &L, is_close: bool, is_coarse: bool) -> Self {
        // A system that changes with time is another one later.
        let is_timed = system.later(S::one(), |later| !core::ptr::eq(later, system));
        let is_planar = N == 1 && !is_timed && !is_close;
        let zero = SVector::zeros();
        Self {
            is_planar,
            is_coarse,
            error: State { q: zero, p: zero },
            unsure: State { q: zero, p: zero },
            random: 0x2545_f491_4f6c_dd1d,
            // On a line shifts in time do not grow, and the energy tells the rest.
            is_unsure: !is_coarse && (N > 1 || is_timed),
            last: None,
            rounding: 0.0,
            unseen: 0.0,
            energy: None,
            growth: 1.0,
            is_timed,
            speed: f64::INFINITY,
            evaluations: 0.0,
        }
    }

    /// Whether nothing but shifts in time and their shear remain to be told: one coordinate, and no time.
    pub(super) fn is_planar(&self) -> bool {
        self.is_planar
    }

    /// Whether the error is not followed in every turn.
    pub(super) fn is_coarse(&self) -> bool {
        self.is_coarse
    }

    /// Whether the system changes with time.
    pub(super) fn is_timed(&self) -> bool {
        self.is_timed
    }

    /// Adds what the last step errs by, `local` at the state last looked at, and as much for each of `before` steps: those have grown since, as
    /// errors did on the way.
    pub(super) fn add(&mut self, local: &State<S, N>, before: f64) {
        // On a line growth is shear, and what comes late has none.
        let growth = if self.is_unsure { self.growth.min(MOST_GROWTH) } else { 1.0 };
        let mean = if growth > 1.01 { (growth - 1.0) / nalgebra::ComplexField::ln(growth) } else { 1.0 };
        self.growth = 1.0;
        let steps = S::constant(1.0 + before * mean);
        self.error.q += local.q * steps;
        self.error.p += local.p * steps;
        self.err(local, steps.widen() * UNSURE[0]);
    }

    /// Makes δ less sure by so much of `of`.
    fn err(&mut self, of: &State<S, N>, share: f64) {
        if !self.is_unsure {
            return;
        }
        let mut random = || {
            // Marsaglia's xorshift.
            self.random ^= self.random << 13;
            self.random ^= self.random >> 7;
            self.random ^= self.random << 17;
            S::constant(share * ((self.random >> 11) as f64 / (1_u64 << 52) as f64 - 1.0))
        };
        self.unsure.q += of.q.map(|x| x * random());
        self.unsure.p += of.p.map(|x| x * random());
    }

    /// By how much the force at the state last looked at is another at `time`.
    pub(super) fn change_of_force<L, M>(&mut self, system: &L, methods: M, time: f64) -> f64
    where
        L: Lagrangian<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let Some((last, before)) = &self.last else { return 0.0 };
        self.evaluations += 2.0;
        let length = (S::one() / last.fastest()).min(S::constant(time - before));
        system.later(S::constant(time), |later| last.change_of_force(later, methods, length))
    }

    /// Carries the error on to `state` at `time`. An error of the energy beyond what is foreseen stands for
    /// one of the phase besides, of a step that was not looked at.
    pub(super) fn carry<L, M>(
        &mut self,
        system: &L,
        methods: M,
        state: &State<S, N>,
        time: f64,
        scale: &Scale<S, N>,
        since: &Since,
    ) where
        L: Lagrangian<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let zero = SVector::zeros();
        let (guess, length) = match &self.last {
            Some((last, before)) => {
                let length = S::constant(time - before);
                (last.velocity_at(state), (S::one() / last.fastest()).min(length))
            }
            None => (zero, S::one()),
        };
        let guess = if self.last.is_some() { guess } else { state.velocity(system).unwrap_or(zero) };
        let mut length = length;
        if self.last.is_none() {
            // A time in which the motion changes: of the second try, by the first.
            for _ in 0..3 {
                if let Some(first) = Variation::at(system, methods, state, &guess, length) {
                    length = S::one() / first.fastest().max(S::SMALLEST_NORMAL);
                    length = length.min(S::constant(1e6));
                } else {
                    length *= S::constant(1e-3);
                }
            }
        }
        let variation = system.later(S::constant(time), |system| {
            Variation::at(system, methods, state, &guess, length)
                .or_else(|| Variation::at(system, methods, state, &state.velocity(system).ok()?, length))
        });
        self.evaluations += 2.0;
        let Some(variation) = variation else { return };
        if let Some((last, before)) = &self.last {
            let size = scale.norm(&self.error);
            let t = S::constant(time - before);
            // Where the error turns far in this time, by way of states between.
            let angle = last.angle_to(&variation, t);
            self.speed = angle / t.widen();
            let most = if self.is_coarse { 1.0 } else { (since.affordable / PART).clamp(1.0, MOST_PARTS) };
            let parts = nalgebra::ComplexField::ceil(
                (angle / ANGLE[usize::from(!self.is_planar)]).min(nalgebra::ComplexField::floor(most)),
            )
            .max(1.0);
            let part = t / S::constant(parts);
            let (mut from, mut errors) = (*last, [self.error, self.unsure]);
            let before = *before;
            let is_coarse =
                self.is_planar || self.is_coarse || angle < 0.5 * ANGLE[1] || since.affordable < PART;
            let is_timed = self.is_timed;
            let mut between = |from: &Variation<S, N>, share: f64| {
                let share = S::constant(share);
                let state = last.between(&variation, t, share, is_timed);
                let guess = from.velocity_at(&state);
                self.evaluations += 2.0;
                system.later(S::constant(before) + share * t, |system| {
                    Variation::at(system, methods, &state, &guess, length)
                })
            };
            for k in 0..parts as u32 {
                let k = f64::from(k);
                let middle = if is_coarse { None } else { between(&from, (k + 0.5) / parts) };
                let to = if k + 1.0 < parts { between(&from, (k + 1.0) / parts) } else { None };
                let to = to.unwrap_or(variation);
                errors = if is_timed {
                    carried(errors, &from, middle.as_ref(), &to, part)
                } else {
                    along_the_motion(errors, &from, middle.as_ref(), &to, part, scale)
                };
                from = to;
            }
            [self.error, self.unsure] = errors;
            let shift = if is_timed { S::zero() } else { shift(&self.error, &variation.rate, scale) };
            let across = State {
                q: self.error.q - variation.rate.q * shift,
                p: self.error.p - variation.rate.p * shift,
            };
            self.err(&across, UNSURE[1] * (angle / parts).min(1.0));
            let growth = scale.norm(&self.error) / size;
            if growth.is_finite() {
                self.rounding *= growth;
                self.unseen *= growth;
                self.growth *= growth;
            }
        }
        let rounding =
            rounding_of_a_step(&variation, state, scale, time - self.last.map_or(0.0, |last| last.1), since);
        self.rounding =
            nalgebra::ComplexField::sqrt(self.rounding * self.rounding + rounding * rounding * since.steps);
        if self.is_timed || variation.is_forced {
            self.energy = None;
        } else if self.last.is_none() {
            self.energy = Some(variation.energy(system));
        } else if let (Some(energy), true) = (self.energy, since.is_energy) {
            self.evaluations += 3.0;
            let beyond = self.set_energy(&variation, variation.energy(system) - energy, scale);
            if beyond > UNFORESEEN * since.foreseen + 4.0 * self.rounding {
                self.unseen += beyond;
            }
        }
        self.last = Some((variation, time));
    }

    /// Puts the energy's error at what it is, and says how much that changes the error.
    fn set_energy(&mut self, at: &Variation<S, N>, error: S, scale: &Scale<S, N>) -> f64 {
        // Along the gradient of H in the norm of the scale: q and p in the same units.
        let w = S::constant(scale.weight());
        let direction = State { q: -at.rate.p * (w * w), p: at.rate.q };
        let slope = at.energy_of(&direction);
        if slope > S::zero() {
            let share = (error - at.energy_of(&self.error)) / slope;
            let change = State { q: direction.q * share, p: direction.p * share };
            self.error.q += change.q;
            self.error.p += change.p;
            return scale.norm(&change);
        }
        0.0
    }

    /// The error expected of the state last looked at.
    pub(super) fn size(&self, scale: &Scale<S, N>) -> f64 {
        let [error, unsure] = [&self.error, &self.unsure].map(|error| scale.norm(error));
        nalgebra::ComplexField::sqrt(error * error + unsure * unsure) + self.unseen + 2.0 * self.rounding
    }
}

/// What rounding makes of the state in a step: of q, and of p by the forces, which weighs more than that of q where a mode is faster than the
/// motion that weighs p.
fn rounding_of_a_step<S: Scalar, const N: usize>(
    at: &Variation<S, N>,
    state: &State<S, N>,
    scale: &Scale<S, N>,
    time: f64,
    since: &Since,
) -> f64 {
    let each = S::EPSILON.widen() * scale.largest.widen();
    let of_mode = S::EPSILON.widen() * state.q.amax().widen() * scale.weight() * at.impedance();
    let angle = at.fastest().widen() * time / since.steps.max(1.0);
    let squares =
        each.max(of_mode) * each.max(of_mode) * since.roundings + (of_mode * angle) * (of_mode * angle);
    nalgebra::ComplexField::sqrt(squares)
}

/// What of an error is a shift in time; 0 at rest.
fn shift<S: Scalar, const N: usize>(error: &State<S, N>, rate: &State<S, N>, scale: &Scale<S, N>) -> S {
    let w = S::constant(scale.weight());
    let length = rate.q.norm_squared() + rate.p.norm_squared() * w * w;
    let shift = (error.q.dot(&rate.q) + error.p.dot(&rate.p) * w * w) / length;
    if shift.is_finite() { shift } else { S::zero() }
}

/// What of errors is a shift in time stays one: f is carried to f exactly.
fn along_the_motion<S: Scalar, const N: usize>(
    errors: [State<S, N>; 2],
    from: &Variation<S, N>,
    middle: Option<&Variation<S, N>>,
    to: &Variation<S, N>,
    t: S,
    scale: &Scale<S, N>,
) -> [State<S, N>; 2] {
    let (f, g) = (&from.rate, &to.rate);
    let shifts = errors.each_ref().map(|error| shift(error, f, scale));
    let [a, b] = errors;
    let across = |x: State<S, N>, shift: S| State { q: x.q - f.q * shift, p: x.p - f.p * shift };
    let [a, b] = carried([across(a, shifts[0]), across(b, shifts[1])], from, middle, to, t);
    let along = |x: State<S, N>, shift: S| State { q: x.q + g.q * shift, p: x.p + g.p * shift };
    [along(a, shifts[0]), along(b, shifts[1])]
}
