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

/// The angle by which an error turns between two derivatives at most.
pub(super) const ANGLE: f64 = 1.4;

/// An error of the energy beyond so many times what was foreseen is news.
const UNFORESEEN: f64 = 10.0;

/// Derivatives in a step at most.
const MOST_PARTS: f64 = 8.0;

/// The error of a run so far.
pub(super) struct Estimate<S, const N: usize> {
    /// δ, the run less the motion, at the state last looked at.
    error: State<S, N>,
    /// The motion there, and its time.
    last: Option<(Variation<S, N>, f64)>,
    /// What rounding has made of the state.
    rounding: f64,
    /// What steps that were not looked at have made of it, as the energy tells.
    unseen: f64,
    /// The energy at the start; nothing where it is not kept.
    energy: Option<S>,
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
            last: None,
            rounding: 0.0,
            unseen: 0.0,
            energy: None,
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

    /// Adds what `steps` steps err by, each by `local`, at the state last looked at.
    pub(super) fn add(&mut self, local: &State<S, N>, steps: f64) {
        let steps = S::constant(steps);
        self.error.q += local.q * steps;
        self.error.p += local.p * steps;
    }

    /// Carries the error on to `state` at `time`, after so many roundings. An error of the energy beyond what is `foreseen` stands for
    /// one of the phase besides, of a step that was not looked at.
    pub(super) fn carry<L, M>(
        &mut self,
        system: &L,
        methods: M,
        state: &State<S, N>,
        time: f64,
        scale: &Scale<S, N>,
        [roundings, foreseen]: [f64; 2],
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
            let parts = nalgebra::ComplexField::ceil(angle / ANGLE)
                .clamp(1.0, if self.is_coarse { 1.0 } else { MOST_PARTS });
            let part = t / S::constant(parts);
            let (mut from, mut error) = (*last, self.error);
            let before = *before;
            let is_coarse = self.is_planar || self.is_coarse || angle < 0.5 * ANGLE;
            let mut between = |from: &Variation<S, N>, share: f64| {
                let share = S::constant(share);
                let state = last.between(&variation, t, share);
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
                error = if self.is_timed {
                    carried(&error, &from, middle.as_ref(), &to, part)
                } else {
                    along_the_motion(&error, &from, middle.as_ref(), &to, part, scale)
                };
                from = to;
            }
            self.error = error;
            let growth = scale.norm(&self.error) / size;
            if growth.is_finite() {
                self.rounding *= growth;
                self.unseen *= growth;
            }
        }
        let each = S::EPSILON.widen() * scale.largest.widen();
        self.rounding = nalgebra::ComplexField::sqrt(self.rounding * self.rounding + each * each * roundings);
        if self.is_timed || variation.is_forced {
            self.energy = None;
        } else if self.last.is_none() {
            self.energy = Some(variation.energy(system));
        } else if let Some(energy) = self.energy {
            self.evaluations += 3.0;
            let beyond = self.set_energy(&variation, variation.energy(system) - energy, scale);
            if beyond > UNFORESEEN * foreseen + 4.0 * self.rounding {
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
        scale.norm(&self.error) + self.unseen + 2.0 * self.rounding
    }
}

/// What of the error is a shift in time stays one: f is carried to f exactly.
fn along_the_motion<S: Scalar, const N: usize>(
    error: &State<S, N>,
    from: &Variation<S, N>,
    middle: Option<&Variation<S, N>>,
    to: &Variation<S, N>,
    t: S,
    scale: &Scale<S, N>,
) -> State<S, N> {
    let w = S::constant(scale.weight());
    let f = &from.rate;
    let length = f.q.norm_squared() + f.p.norm_squared() * w * w;
    let shift = (error.q.dot(&f.q) + error.p.dot(&f.p) * w * w) / length;
    if !shift.is_finite() {
        return carried(error, from, middle, to, t);
    }
    let across = State { q: error.q - f.q * shift, p: error.p - f.p * shift };
    let carried = carried(&across, from, middle, to, t);
    State { q: carried.q + to.rate.q * shift, p: carried.p + to.rate.p * shift }
}
