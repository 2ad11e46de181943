//! The equations of motion at one state of a run, with their derivative, and how they carry an error on.
//!
//! ```text
//! ẏ = f(y),  y = (q, p)        an error obeys  δ̇ = J δ,  J = ∂f/∂y
//! ```
//!
//! Both are made of the derivatives of L and of f_L, with M = ∂²L/∂v² and C = ∂²L/∂v∂q:
//!
//! ```text
//! q̇ = v,  ∂L/∂v(q, v) = p      ∂q̇/∂p = M⁻¹,  ∂q̇/∂q = −M⁻¹C
//! ṗ = ∂L/∂q + f_L               ∂ṗ/∂p = B M⁻¹,  ∂ṗ/∂q = ∂²L/∂q² + ∂f_L/∂q + B ∂q̇/∂q,  B = Cᵀ + ∂f_L/∂v
//! ```
//!
//! Coordinates without mass have p = 0, and rows of B and of ∂(∂L/∂q + f_L)/∂q for those of M and C.

use nalgebra::{SMatrix, SVector};

use super::Methods;
use super::phase::{norm_and_ratio, plus, times};
use super::scale::Scale;
use crate::numbers::Scalar;
use crate::step::massless::{Balance, Massless};
use crate::step::{PhaseMatrix, State};
use crate::system::{ActingForce, Lagrangian};

/// The motion at one state.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Variation<S: Scalar, const N: usize> {
    /// f = (v, ṗ).
    pub(super) rate: State<S, N>,
    /// J.
    pub(super) matrix: PhaseMatrix<S, N>,
    /// The fastest rate at which an error changes: a norm of J that does not depend on the units of q and p.
    pub(super) fastest: S,
    /// p over q in the fastest mode: √(∂ṗ/∂q : ∂q̇/∂p); 0 where that is none.
    pub(super) impedance: f64,
    /// The state.
    at: State<S, N>,
    /// Whether a force acts here, so that the energy need not be kept.
    pub(super) is_forced: bool,
}

/// The root of a share of J that is no more than rounding.
const SLIGHTEST: f64 = 1e-4;

/// Angles by which the fastest mode turns in the steps that tell of the motion on constraints: as they are
/// made, and at most; and how often they are made shorter.
const SHORT: f64 = 1e-4;
const LONGEST: f64 = 1e-3;
const ATTEMPTS: u32 = 6;

/// A velocity that Newton's method changes by less than this share is that of the state.
const VELOCITY: f64 = 1e-3;

/// The cost of the motion at one state, in evaluations: on constraints that of two steps.
pub(super) const fn cost<L: Lagrangian<N>, const N: usize>() -> f64 {
    if L::IS_CONSTRAINED { 24.0 } else { 2.0 }
}

impl<S: Scalar, const N: usize> Variation<S, N> {
    /// At `state`, with a guess for the velocity. Nothing where the derivatives do not exist.
    pub(super) fn at<L, M>(
        (system, methods): (&L, M),
        state: &State<S, N>,
        guess: &SVector<S, N>,
    ) -> Option<Self>
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        let free = Self::by_derivatives(system, state, guess)?;
        if L::IS_CONSTRAINED { free.on_constraints((system, methods)) } else { Some(free) }
    }

    /// On constraints, by two steps of the rule, forwards and backwards: their ends y(±τ) and derivatives
    /// A(±τ) hold the reactions, ẏ = (y(τ) − y(−τ))/2τ and J = (A(τ) − A(−τ))/2τ up to (τJ)².
    fn on_constraints<L, M>(self, (system, methods): (&L, M)) -> Option<Self>
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        // Off the constraints by what states between are known to.
        let state = methods.nearest(system, &self.at)?;
        // At the origin of q the distance from it tells nothing; steps that are too long are seen.
        let turns = self.rate.q.amax() / (state.q.amax() + S::constant(SHORT));
        let mut tau = S::constant(SHORT) / (self.fastest + turns);
        for _ in 0..ATTEMPTS {
            let ends = [tau, -tau].map(|tau| methods.linearized(system, &state, tau));
            let [Some((ahead, a)), Some((behind, b))] = ends else {
                tau *= S::constant(SHORT);
                continue;
            };
            let share = S::constant(0.5) / tau;
            let between = |x: &SVector<S, N>, y: &SVector<S, N>| (x - y) * share;
            let slope = |x: &SMatrix<S, N, N>, y: &SMatrix<S, N, N>| (x - y) * share;
            let mut matrix = PhaseMatrix {
                q_by_q: slope(&a.q_by_q, &b.q_by_q),
                q_by_p: beyond_rounding(slope(&a.q_by_p, &b.q_by_p), &self.matrix.q_by_p),
                p_by_q: slope(&a.p_by_q, &b.p_by_q),
                p_by_p: slope(&a.p_by_p, &b.p_by_p),
            };
            let [mut fastest, impedance] = norm_and_ratio(&matrix);
            if !fastest.is_finite() {
                return None;
            }
            if matrix.q_by_p.amax() == S::zero() && fastest * tau <= slightest() {
                // All that moves is prescribed.
                (matrix.q_by_q, matrix.p_by_p, fastest) = (nalgebra::zero(), nalgebra::zero(), S::zero());
            }
            // What turns faster than was thought is looked at more closely.
            if fastest * tau > S::constant(LONGEST) {
                tau = S::constant(SHORT) / fastest;
                continue;
            }
            let rate = State {
                q: between(&ahead.state.q, &behind.state.q),
                p: between(&ahead.state.p, &behind.state.p),
            };
            let impedance = if impedance.is_finite() { impedance.widen() } else { 0.0 };
            // A reaction takes part in ṗ, which is no gradient of the energy then.
            return Some(Self { rate, matrix, fastest, impedance, at: state, is_forced: true });
        }
        None
    }

    fn by_derivatives<L>(system: &L, state: &State<S, N>, guess: &SVector<S, N>) -> Option<Self>
    where
        L: ActingForce<N, Scalar = S>,
    {
        let mut v = *guess;
        for _ in 0..4 {
            let l = system.lagrangian_derivatives(&state.q, &v);
            let (mut massless, mut of_velocity) = (Massless::none(), Balance::of(&l));
            let mut inverse = l.d22.try_inverse();
            if inverse.is_none() {
                massless = Massless::of(system, &state.q);
                let force = || system.acting_force_derivatives(&state.q, &v);
                of_velocity = massless.balance(&l, force, S::constant(1.0));
                inverse = of_velocity.by_v.try_inverse();
            }
            let inverse = inverse?;
            let correction = inverse * (massless.without(&state.p) - of_velocity.value);
            if !correction.iter().all(|x| x.is_finite()) {
                return None;
            }
            v += correction;
            if correction.amax() > S::constant(VELOCITY) * v.amax() {
                continue;
            }
            let (mut rate, mut by_q, mut by_v) = (l.d1, l.d11, l.d12);
            let mut is_forced = false;
            if L::IS_FORCED {
                let force = system.acting_force_derivatives(&state.q, &v);
                is_forced = force.value.iter().any(|&entry| entry != S::zero());
                rate += force.value;
                by_q += force.d1;
                by_v += force.d2;
            }
            // L is differentiated beside v by less than VELOCITY, and ṗ there taken to v.
            rate += l.d12 * correction;
            let q_by_q = -(inverse * of_velocity.by_q);
            let q_by_p = massless.without(&inverse.transpose()).transpose();
            let matrix = PhaseMatrix {
                q_by_q,
                q_by_p,
                p_by_q: massless.without(&(by_q + by_v * q_by_q)),
                p_by_p: massless.without(&(by_v * q_by_p)),
            };
            let rate = massless.without(&rate);
            let [fastest, impedance] = norm_and_ratio(&matrix);
            let is_finite = fastest.is_finite() && rate.iter().all(|x| x.is_finite());
            return is_finite.then_some(Self {
                rate: State { q: v, p: rate },
                matrix,
                fastest,
                impedance: if impedance.is_finite() { impedance.widen() } else { 0.0 },
                at: *state,
                is_forced,
            });
        }
        None
    }

    /// At the same state of `later`, the system at another time.
    pub(super) fn in_time<L, M>(&self, later: (&L, M)) -> Option<Self>
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        Self::at(later, &self.at, &self.rate.q)
    }

    /// Whether J is another at `other`, by more than rounding.
    pub(super) fn is_another(&self, other: &Self) -> bool {
        self.change_to(other).1 > SLIGHTEST
    }

    /// The velocity at another state near by.
    pub(super) fn velocity_at(&self, state: &State<S, N>) -> SVector<S, N> {
        self.rate.q + self.matrix.q_by_q * (state.q - self.at.q) + self.matrix.q_by_p * (state.p - self.at.p)
    }

    /// J δ over the fastest rate, or over the one at which the whole motion turns q into p where that is
    /// faster: what a quarter of a turn of the fastest mode makes of an error in it.
    pub(super) fn turned(&self, error: &State<S, N>, scale: &Scale<S, N>) -> State<S, N> {
        let State { q, p } = times(&self.matrix, error);
        let rate = self.fastest.max(self.matrix.q_by_p.norm() / S::constant(scale.weight()));
        // Where all that moves is prescribed an error stays as it is.
        if rate > S::zero() { State { q: q / rate, p: p / rate } } else { *error }
    }

    /// The fastest rate here and at `other`, and the root of the share of J that changes: over their product
    /// with a time an error turns as one J does not tell.
    pub(super) fn change_to(&self, other: &Self) -> (f64, f64) {
        let [a, b] = [&self.matrix, &other.matrix];
        let fastest = self.fastest.max(other.fastest);
        let share = |x: &SMatrix<S, N, N>, y: &SMatrix<S, N, N>, size: S| {
            let change = (x - y).norm();
            if change > S::zero() { change / size } else { S::zero() }
        };
        let size = |x: &SMatrix<S, N, N>, y: &SMatrix<S, N, N>| x.norm().max(y.norm());
        let share = share(&a.q_by_p, &b.q_by_p, size(&a.q_by_p, &b.q_by_p))
            .max(share(&a.p_by_q, &b.p_by_q, size(&a.p_by_q, &b.p_by_q)))
            .max(share(&a.q_by_q, &b.q_by_q, fastest))
            .max(share(&a.p_by_p, &b.p_by_p, fastest))
            .min(S::one());
        (fastest.widen(), share.sqrt().widen())
    }

    /// H = p·v − L(q, v); an error of v enters squared.
    pub(super) fn energy<L: Lagrangian<N, Scalar = S>>(&self, system: &L) -> S {
        let State { q, p } = &self.at;
        let mut v = self.rate.q;
        for _ in 0..2 {
            v += self.matrix.q_by_p * (p - system.lagrangian_gradient(q, &v).d2);
        }
        p.dot(&v) - system.lagrangian(q, &v)
    }

    /// Between this state and `other`, `t` later, at the share `s` of the time: the quintic with both rates
    /// and with ÿ = J ẏ, or the cubic with the rates where J does not tell ÿ, as where the system changes
    /// with time, or where it changes within t.
    pub(super) fn between(&self, other: &Self, t: S, s: S, is_timed: bool) -> State<S, N> {
        let number = S::constant;
        let is_long = self.fastest.max(other.fastest) * t > number(LONG);
        let [a, b, c, d, e, f] = if is_timed || is_long {
            let r = S::one() - s;
            let [two, three] = [number(2.0), number(3.0)];
            let ends = [r * r * (S::one() + two * s), s * s * (three - two * s)];
            [ends[0], ends[1], r * r * s * t, -(s * s * r * t), S::zero(), S::zero()]
        } else {
            let cube = s * s * s;
            let end = cube * (number(10.0) - s * (number(15.0) - number(6.0) * s));
            let half = t * t * number(0.5);
            [
                S::one() - end,
                end,
                t * (s - cube * (number(6.0) - s * (number(8.0) - number(3.0) * s))),
                t * cube * (s * (number(7.0) - number(3.0) * s) - number(4.0)),
                half * s * s * (S::one() - s * (number(3.0) - s * (number(3.0) - s))),
                half * cube * (S::one() - s * (number(2.0) - s)),
            ]
        };
        let (x, y) = (times(&self.matrix, &self.rate), times(&other.matrix, &other.rate));
        State {
            q: self.at.q * a + other.at.q * b + self.rate.q * c + other.rate.q * d + x.q * e + y.q * f,
            p: self.at.p * a + other.at.p * b + self.rate.p * c + other.rate.p * d + x.p * e + y.p * f,
        }
    }

    /// By how much ṗ at this state is another in `later`, the system at another time.
    pub(super) fn change_of_force<L, M>(&self, (later, methods): (&L, M)) -> f64
    where
        L: ActingForce<N, Scalar = S>,
        M: Methods<L, N>,
    {
        if L::IS_CONSTRAINED {
            let later = self.in_time((later, methods));
            return later.map_or(f64::INFINITY, |later| (later.rate.p - self.rate.p).amax().widen());
        }
        let (q, v) = (&self.at.q, &self.rate.q);
        (later.lagrangian_gradient(q, v).d1 + later.acting_force(q, v) - self.rate.p).amax().widen()
    }

    /// ∂H/∂y·δ = v·δp − ṗ·δq where no force acts.
    pub(super) fn energy_of(&self, error: &State<S, N>) -> S {
        self.rate.q.dot(&error.p) - self.rate.p.dot(&error.q)
    }

    /// `error` with so much `energy`, by the least change: along the error of unit energy.
    pub(super) fn with_energy(&self, error: &State<S, N>, energy: S, unit: &State<S, N>) -> State<S, N> {
        plus(error, unit, energy - self.energy_of(error))
    }

    /// The least error of unit energy: along the gradient of H, with q and p weighed as in the fastest mode,
    /// so that it is one of the amplitude there and not of the phase; none at rest.
    pub(super) fn of_unit_energy(&self, scale: &Scale<S, N>) -> State<S, N> {
        // A mode as slow as the motion, or none, has the weight of the norm.
        let w = S::constant((1.0 / self.impedance).min(scale.weight()));
        let direction = State { q: -self.rate.p * (w * w), p: self.rate.q };
        let slope = self.energy_of(&direction);
        let share = S::one() / slope;
        let share = if slope > S::zero() && share.is_finite() { share } else { S::zero() };
        State { q: direction.q * share, p: direction.p * share }
    }
}

/// ∂q̇/∂p on constraints, 0 where the constraints leave no motion: what rounding makes of that would count as
/// a mode of infinite impedance. Without constraints it is `free`.
fn beyond_rounding<S: Scalar, const N: usize>(
    mut on: SMatrix<S, N, N>,
    free: &SMatrix<S, N, N>,
) -> SMatrix<S, N, N> {
    for i in 0..N {
        for j in 0..N {
            if on[(i, j)].abs() <= (free[(i, i)] * free[(j, j)]).abs().sqrt() * slightest::<S>() {
                on[(i, j)] = S::zero();
            }
        }
    }
    on
}

/// The share of A, or of ∂q̇/∂p, that is no more than rounding.
fn slightest<S: Scalar>() -> S {
    S::EPSILON.sqrt() * S::EPSILON.sqrt().sqrt()
}

/// A quintic says nothing of a motion over so many radians.
const LONG: f64 = 4.0;
