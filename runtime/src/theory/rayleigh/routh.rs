//! Discrete Routh reduction under friction: a cyclic coordinate is left out, and the others have a discrete
//! Rayleigh system of their own.
//!
//! Let q = (x, θ), and L_d^± = L_d ± R_d depend on θ by Δ = θ1 − θ0 alone. Its momenta are p0_θ = ∂_Δ L_d⁺
//! and p1_θ = ∂_Δ L_d⁻.
//!
//! **Theorem.** If ∂_Δ L_d⁻ = g(∂_Δ L_d⁺) with a function g of one number, and ∂_Δ∂_Δ L_d⁺ ≠ 0, then μ = p_θ
//! moves by μ_{k+1} = g(μ_k), and the x of the run are those of the discrete Rayleigh system with
//!
//! ```text
//! L̂⁺(x0, x1; μ) = L_d⁺ − μΔ,   L̂⁻(x0, x1; μ) = L_d⁻ − g(μ)Δ,      Δ = Δ(x0, x1; μ) from ∂_Δ L_d⁺ = μ
//! ```
//!
//! *Proof.* The first is the condition at p0_θ = μ_k. In D1 L̂⁺ = D_x0 L_d⁺ + (∂_Δ L_d⁺ − μ) D1Δ and D2 L̂⁻ =
//! D_x1 L_d⁻ + (∂_Δ L_d⁻ − g(μ)) D2Δ the brackets vanish: −D1 L̂⁺ = p0_x and D2 L̂⁻ = p1_x. ∎
//!
//! Without friction on θ g is the identity, and this the discrete Routh reduction of S. M. Jalnapurkar, M.
//! Leok, J. E. Marsden and M. West (J. Phys. A 39, 2006, 5521–5544). Friction that is to the inertia of θ as
//! constants are, R = ½c I(x)θ̇² + …, has g(μ) = (1 − hc/2)/(1 + hc/2) μ by the midpoint rule. Other friction
//! on θ couples μ to x: the condition fails. Of forced discrete systems with symmetry: M. I. Caruso, J.
//! Fernández, C. Tori and M. Zuccalli, Lagrangian reduction of forced discrete mechanical systems, J. Phys. A
//! 56, 2023. For Rayleigh forces and this condition we found no earlier statement.
//!
//! ```
//! use dalembert::samples::segments;
//! use dalembert::{Discretise, Midpoint, State, rayleigh_system};
//!
//! /// A planet in a drag that is that of its velocity, in polar coordinates (r, θ).
//! #[rayleigh_system]
//! fn planet(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
//!     let twice_kinetic = v[0] * v[0] + q[0] * q[0] * v[1] * v[1];
//!     (0.5 * twice_kinetic + 1.0 / q[0], 0.5 * c * twice_kinetic)
//! }
//! let (planet, h) = (Planet { c: 0.1 }, 0.05);
//! let by = planet.by(Midpoint, h);
//! let routh = by.routh::<1>(1, &segments([0.5, 0.0], [1.5, 6.0], [0.1, 0.1], 20))?;
//! let start = State::from_velocity(&planet, [1.0, 0.0], [0.0, 1.1])?;
//!
//! let reduced = routh.run(&start).nth(99).unwrap()?;
//! let whole = by.run(start).nth(99).unwrap()?.state;
//! assert!((reduced.q - whole.q).amax() < 1e-12 && (reduced.p - whole.p).amax() < 1e-12);
//! // μ falls as if there were no r.
//! assert!((whole.p[1] / start.p[1] / ((1.0 - 0.05 * h) / (1.0 + 0.05 * h)).powi(100) - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod coordinates;
mod error;
mod functions;
mod hypotheses;

use core::cell::Cell;

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::step::{
    Discrete, Discretised, LegendreDerivatives, State, StepError, StepKernel, equation::Alone, invert, newton,
};
use crate::theory::samples::{Pair, Sizes, around};
use coordinates::{shape, with, without};
pub use error::RouthError;

/// The Routh reduction of a system by a cyclic coordinate θ, in one place:
/// [`routh`](crate::Discretised::routh). K = N − 1 coordinates x are left.
#[derive(Debug)]
pub struct Routh<'a, L: Discrete<R, N>, R, const N: usize, const K: usize> {
    by: Discretised<'a, L, R, N>,
    cyclic: usize,
    /// The segment of x from which g is read off.
    reference: Pair<L::Scalar, K>,
}

/// A state of the reduced system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReducedState<S, const K: usize> {
    /// x and its momentum.
    pub shape: State<S, K>,
    /// μ, the momentum of θ.
    pub momentum: S,
}

/// A step of the reduced system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReducedStep<S, const K: usize> {
    /// The state at its end.
    pub state: ReducedState<S, K>,
    /// Δ = θ1 − θ0.
    pub angle: S,
}

impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The system without its coordinate `cyclic`, whose momentum is a parameter:
    /// [`rayleigh::routh`](crate::rayleigh::routh). K = N − 1.
    ///
    /// The hypotheses are checked at the `segments`, of [`samples`](crate::samples) or of a run, and the
    /// condition on friction at every step again.
    ///
    /// **Segments it needs.** Two whose shapes (x0, x1) lie apart, on one of which beside the first θ has a
    /// momentum. They are checked at 2n more, each of which differs from the first in one coordinate of q0
    /// or of q1 − q0: towards another segment, or by its own size. A view whose momenta change with time is
    /// refused.
    ///
    /// # Errors
    /// A [`RouthError`](crate::rayleigh::routh::RouthError) that says which hypothesis fails.
    pub fn routh<const K: usize>(
        &self,
        cyclic: usize,
        segments: &[Pair<L::Scalar, N>],
    ) -> Result<Routh<'a, L, R, N, K>, RouthError> {
        const { assert!(K > 0 && K + 1 == N, "K is N − 1, N at least 2") };
        const { Self::require_unconstrained() };
        let first = segments.first().ok_or(RouthError::Uninformative)?;
        if cyclic >= N {
            return Err(RouthError::NoSuchCoordinate { cyclic });
        }
        let routh = Routh { by: *self, cyclic, reference: shape(first, cyclic) };
        let sizes = Sizes::of(segments.iter().map(|segment| shape::<_, N, K>(segment, cyclic)));
        let mut told = false;
        for (sample, segment) in segments.iter().enumerate() {
            let has_momentum = routh.check(sample, segment)?;
            routh.require_no_time(sample, segment)?;
            told |= has_momentum && sizes.are_apart(&shape(segment, cyclic), &routh.reference);
        }
        let units = [1.0, self.step_size().widen().abs()];
        let beside = around(segments, &Sizes::of(segments.iter().copied()), units);
        for (k, segment) in beside.iter().enumerate() {
            // Beside the segments given a system may end.
            if let Err(
                error
                @ (RouthError::NotCyclic { .. } | RouthError::NotReducible { .. } | RouthError::Stopped),
            ) = routh.check(segments.len() + k, segment)
            {
                return Err(error);
            }
        }
        if told { Ok(routh) } else { Err(RouthError::Uninformative) }
    }
}

impl<L, R, const N: usize, const K: usize> Routh<'_, L, R, N, K>
where
    L: Discrete<R, N>,
{
    /// g(μ): what μ is after a step.
    ///
    /// # Errors
    /// [`RouthError::NoAngle`] where no Δ has this momentum.
    pub fn next_momentum(&self, momentum: L::Scalar) -> Result<L::Scalar, RouthError> {
        let Pair { q0, q1 } = &self.reference;
        let v = (q1 - q0) / self.by.step_size();
        let (k, _) = self.segment(q0, &v, momentum, nalgebra::zero()).map_err(RouthError::NoAngle)?;
        Ok(k.momenta.p1[self.cyclic])
    }

    /// The momenta of the segment from `x` with mean velocity `v` on which p0_θ is `momentum`, and Δ/h;
    /// `start` is a guess for it.
    fn segment(
        &self,
        x: &SVector<L::Scalar, K>,
        v: &SVector<L::Scalar, K>,
        momentum: L::Scalar,
        start: L::Scalar,
    ) -> Result<(LegendreDerivatives<L::Scalar, N>, L::Scalar), StepError> {
        let (system, h, theta) = (self.by.system(), self.by.step_size(), self.cyclic);
        let q0 = with(x, nalgebra::zero(), theta);
        let at = |rate: L::Scalar| self.by.objects(&q0, &with(&(x + v * h), rate * h, theta)).legendre();
        let kernel = |_: &SVector<L::Scalar, 1>, rate: &SVector<L::Scalar, 1>| {
            let k = at(rate[0]);
            StepKernel {
                p0: SVector::from([k.momenta.p0[theta]]),
                matrix: SMatrix::from([[k.p0_by_q1[(theta, theta)] * h]]),
            }
        };
        let momentum_of = |q: &SVector<L::Scalar, 1>, rate: &SVector<L::Scalar, 1>| kernel(q, rate).p0;
        let inertia = |_: &SVector<L::Scalar, 1>, rate: &SVector<L::Scalar, 1>| {
            SMatrix::from([
                [system.lagrangian_derivatives(&q0, &with(v, rate[0], theta)).d22[(theta, theta)]],
            ])
        };
        let state = State { q: nalgebra::zero(), p: SVector::from([momentum]) };
        let equation = Alone { kernel: &kernel, momentum: momentum_of, inertia };
        let root = newton::root(&equation, &state, h, SVector::from([start]))?;
        // Once more: what is left of the residual here is noise in the equation for x.
        let left = kernel(&state.q, &root);
        let rate = root[0] - (left.p0[0] - momentum) / left.matrix[0];
        Ok((at(rate), rate))
    }

    /// The step of the reduced system: −D1 L̂⁺(x0, x1; μ) = p0 solved for x1, then p1 = D2 L̂⁻ and g(μ).
    ///
    /// # Errors
    /// A [`RouthError`]; [`RouthError::NotReducible`] where p1_θ is not g(μ).
    pub fn step(&self, state: &ReducedState<L::Scalar, K>) -> Result<ReducedStep<L::Scalar, K>, RouthError> {
        let (system, h, theta) = (self.by.system(), self.by.step_size(), self.cyclic);
        let ReducedState { shape, momentum } = state;
        let velocity =
            self.reconstruct(state, nalgebra::zero()).velocity(system).map_err(RouthError::Step)?;
        let guess = Cell::new(velocity[theta]);
        let no_angle = Cell::new(None);
        let kernel = |x: &SVector<L::Scalar, K>, v: &SVector<L::Scalar, K>| {
            let (k, rate) = match self.segment(x, v, *momentum, guess.get()) {
                Ok(found) => found,
                Err(error) => {
                    no_angle.set(Some(error));
                    let nan = L::Scalar::constant(f64::NAN);
                    return StepKernel { p0: SVector::repeat(nan), matrix: SMatrix::repeat(nan) };
                }
            };
            guess.set(rate);
            // Δ follows x1: ∂p0_x/∂x1 less what is left of it where p0_θ is held.
            let pivot = k.p0_by_q1[(theta, theta)];
            let of = |i: usize| if i < theta { i } else { i + 1 };
            let matrix = SMatrix::<_, K, K>::from_fn(|i, j| {
                let (i, j) = (of(i), of(j));
                (k.p0_by_q1[(i, j)] - k.p0_by_q1[(i, theta)] * k.p0_by_q1[(theta, j)] / pivot) * h
            });
            StepKernel { p0: without(&k.momenta.p0, theta), matrix }
        };
        let momentum_of = |x: &SVector<L::Scalar, K>, v: &SVector<L::Scalar, K>| kernel(x, v).p0;
        let inertia = |x: &SVector<L::Scalar, K>, v: &SVector<L::Scalar, K>| {
            let q = with(x, nalgebra::zero(), theta);
            let mass = system.lagrangian_derivatives(&q, &with(v, guess.get(), theta)).d22;
            let of = |i: usize| if i < theta { i } else { i + 1 };
            SMatrix::<_, K, K>::from_fn(|i, j| mass[(of(i), of(j))])
        };
        let start = without(&velocity, theta);
        let equation = Alone { kernel: &kernel, momentum: momentum_of, inertia };
        let v = newton::root(&equation, shape, h, start)
            .map_err(|error| no_angle.take().map_or(RouthError::Step(error), RouthError::NoAngle))?;
        let (k, rate) = self.segment(&shape.q, &v, *momentum, guess.get()).map_err(RouthError::NoAngle)?;
        invert(&k.p0_by_q1).map_err(RouthError::Step)?;
        let next = self.next_momentum(*momentum)?;
        let ends = [with(&shape.q, nalgebra::zero(), theta), with(&(shape.q + v * h), rate * h, theta)];
        self.require_condition(&k, *momentum, [&ends[0], &ends[1]])?;
        let shape = State { q: shape.q + v * h, p: without(&k.momenta.p1, theta) };
        Ok(ReducedStep { state: ReducedState { shape, momentum: next }, angle: rate * h })
    }

    /// The reduced state, and θ.
    #[must_use]
    pub fn reduce(&self, state: &State<L::Scalar, N>) -> (ReducedState<L::Scalar, K>, L::Scalar) {
        let shape = State { q: without(&state.q, self.cyclic), p: without(&state.p, self.cyclic) };
        (ReducedState { shape, momentum: state.p[self.cyclic] }, state.q[self.cyclic])
    }

    /// The state of the whole system at θ.
    fn reconstruct(&self, reduced: &ReducedState<L::Scalar, K>, theta: L::Scalar) -> State<L::Scalar, N> {
        State {
            q: with(&reduced.shape.q, theta, self.cyclic),
            p: with(&reduced.shape.p, reduced.momentum, self.cyclic),
        }
    }

    /// The run of the whole system by reduced steps, with θ summed up: the states after the first, second, …
    /// step. It ends with an error.
    pub fn run(
        &self,
        start: &State<L::Scalar, N>,
    ) -> impl Iterator<Item = Result<State<L::Scalar, N>, RouthError>> {
        let (mut reduced, mut theta) = self.reduce(start);
        let mut has_failed = false;
        core::iter::from_fn(move || {
            if has_failed {
                return None;
            }
            let step = self.step(&reduced);
            has_failed = step.is_err();
            Some(step.map(|ReducedStep { state, angle }| {
                theta += angle;
                reduced = state;
                self.reconstruct(&reduced, theta)
            }))
        })
    }
}
