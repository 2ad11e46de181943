//! A discrete Rayleigh system of order 4 in q, for every n, with constant mass and damping.
//!
//! ```text
//! L = ½vᵀMv − V(q),  R = ½vᵀCv,  d = q1 − q0,  S(V) = V(q0)/6 + 2V(q̄)/3 + V(q1)/6
//! L_d = (1/2h) dᵀ[M + (h²/12) CM⁻¹C] d − h S(V) − (h³/24) ∇V(q̄)ᵀM⁻¹∇V(q̄)
//! R_d = ¼ dᵀCd + (h²/24) dᵀCM⁻¹[∇V(q1) − ∇V(q0)]
//! p_0 = M v_0 − (h²/12) CM⁻¹∇V(q_0),      M v_k = p_k + (h²/12) CM⁻¹∇V(q_k)
//! ```
//!
//! **Theorem.** q_k = q(kh) + O(h⁴), and v_k = q̇(kh) + O(h⁴).
//!
//! *Proof.* The midpoint rule follows a modified system (L + h²L₂, R + h²R₂) up to h⁴
//! ([`modified`](super::modified)). The midpoint rule of (L − h²L₂, R − h²R₂) therefore follows (L, R) up to
//! h⁴; (h²/4) vᵀV″v = V(q0) + V(q1) − 2V(q̄) + O(h⁴) makes Simpson's rule of its potential. Its velocity is
//! that of the modified system, which is where the shift of p comes from. ∎
//!
//! A step with an R_d is of order 2 at most **as a map of (q, p)** ([`RayleighStep`](super::RayleighStep)).
//! The shift (h²/12) CM⁻¹∇V is no gradient, and breaks the Rayleigh structure by exactly what the barrier
//! asks.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use crate::step::{LegendreDerivatives, Momenta, PhaseMatrix, StepError, invert};

/// Newton iterations of a step.
const ITERATIONS: u32 = 32;

/// A potential with its derivatives, by hand.
pub trait PotentialEnergy<const N: usize> {
    /// V(q).
    fn value(&self, q: &SVector<f64, N>) -> f64;

    /// ∇V(q).
    fn gradient(&self, q: &SVector<f64, N>) -> SVector<f64, N>;

    /// V″(q).
    fn hessian(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N>;

    /// ∂/∂q of V″(q) w at fixed w: Σₖ ∂³V/∂qᵢ∂qⱼ∂qₖ wₖ.
    fn third(&self, q: &SVector<f64, N>, w: &SVector<f64, N>) -> SMatrix<f64, N, N>;
}

/// The discrete Rayleigh system of order 4 of M, C and V, for steps of one size.
///
/// ```
/// use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
/// use dalembert::rayleigh::{OrderFour, PotentialEnergy};
///
/// /// V = ½|q|² + ¼x⁴.
/// struct Well;
///
/// impl PotentialEnergy<2> for Well {
///     fn value(&self, q: &SVector<f64, 2>) -> f64 {
///         0.5 * q.dot(q) + 0.25 * q[0].powi(4)
///     }
///     fn gradient(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
///         q + vector![q[0].powi(3), 0.0]
///     }
///     fn hessian(&self, q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
///         matrix![1.0 + 3.0 * q[0] * q[0], 0.0; 0.0, 1.0]
///     }
///     fn third(&self, q: &SVector<f64, 2>, w: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
///         matrix![6.0 * q[0] * w[0], 0.0; 0.0, 0.0]
///     }
/// }
///
/// let (mass, damping) = (matrix![1.0, 0.2; 0.2, 2.0], matrix![0.3, 0.1; 0.1, 0.0]);
/// let system = OrderFour::new(mass, damping, Well, 0.05)?;
/// let mut state = system.start(vector![1.0, 0.0], vector![0.0, 0.5]);
/// for _ in 0..20 {
///     state = system.step(&state)?;
/// }
/// let velocity = system.velocity(&state)?; // at t = 1
/// # let finer = OrderFour::new(mass, damping, Well, 0.0125)?;
/// # let mut other = finer.start(vector![1.0, 0.0], vector![0.0, 0.5]);
/// # for _ in 0..80 {
/// #     other = finer.step(&other)?;
/// # }
/// # assert!((state.q - other.q).amax() < 1e-6 && (velocity - finer.velocity(&other)?).amax() < 1e-6);
/// # Ok::<(), dalembert::rayleigh::OrderFourError>(())
/// ```
///
/// **Its states belong to their h**: p is not M v, but shifted by an amount of h. A state of another h is
/// refused by name. So it is no rule of the attribute: runs, events, dense output, a tolerance, a last step
/// that is shorter and compositions would all hand a momentum on to another h. A composition of it is of
/// order 2; shifted and shifted back at each of its steps it is of order 6, and no Rayleigh step.
#[derive(Clone, Copy, Debug)]
pub struct OrderFour<V, const N: usize> {
    mass: SMatrix<f64, N, N>,
    inverse: SMatrix<f64, N, N>,
    damping: SMatrix<f64, N, N>,
    /// CM⁻¹.
    rate: SMatrix<f64, N, N>,
    potential: V,
    h: f64,
}

/// A state of an [`OrderFour`]: q, and the momentum p that belongs to its h.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OrderFourState<const N: usize> {
    /// q.
    pub q: SVector<f64, N>,
    /// p = M v − (h²/12) CM⁻¹∇V(q).
    pub p: SVector<f64, N>,
    /// h.
    pub h: f64,
}

/// The hypothesis of the theorem that fails, or why a step was not taken.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum OrderFourError {
    /// h is 0 or not finite.
    StepSize {
        /// h.
        h: f64,
    },
    /// The mass matrix is not symmetric and positive definite.
    Mass,
    /// The damping matrix is not symmetric, so that it is not that of a Rayleigh function.
    Damping,
    /// The state belongs to another step size: begin with [`start`](OrderFour::start) again.
    AnotherStepSize {
        /// The h of the state.
        of_state: f64,
        /// The h of the system.
        h: f64,
    },
    /// The step was not taken.
    Step(StepError),
}

impl From<StepError> for OrderFourError {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl<V: PotentialEnergy<N>, const N: usize> OrderFour<V, N> {
    /// The system of M, C and V with step size `h`, which may be negative.
    ///
    /// # Errors
    /// [`OrderFourError`]: the hypothesis that fails.
    pub fn new(
        mass: SMatrix<f64, N, N>,
        damping: SMatrix<f64, N, N>,
        potential: V,
        h: f64,
    ) -> Result<Self, OrderFourError> {
        if h == 0.0 || !h.is_finite() {
            return Err(OrderFourError::StepSize { h });
        }
        if mass != mass.transpose() {
            return Err(OrderFourError::Mass);
        }
        let inverse = mass.cholesky().ok_or(OrderFourError::Mass)?.inverse();
        if damping != damping.transpose() {
            return Err(OrderFourError::Damping);
        }
        Ok(Self { mass, inverse, damping, rate: damping * inverse, potential, h })
    }

    /// (h²/12) CM⁻¹∇V(q).
    fn shift(&self, q: &SVector<f64, N>) -> SVector<f64, N> {
        self.rate * self.potential.gradient(q) * (self.h * self.h / 12.0)
    }

    /// The state of (q, v).
    #[must_use]
    pub fn start(&self, q: SVector<f64, N>, v: SVector<f64, N>) -> OrderFourState<N> {
        OrderFourState { q, p: self.mass * v - self.shift(&q), h: self.h }
    }

    /// v at a state, of order 4.
    ///
    /// # Errors
    /// [`OrderFourError::AnotherStepSize`].
    pub fn velocity(&self, state: &OrderFourState<N>) -> Result<SVector<f64, N>, OrderFourError> {
        self.require_own(state)?;
        Ok(self.inverse * (state.p + self.shift(&state.q)))
    }

    fn require_own(&self, state: &OrderFourState<N>) -> Result<(), OrderFourError> {
        if state.h == self.h {
            Ok(())
        } else {
            Err(OrderFourError::AnotherStepSize { of_state: state.h, h: self.h })
        }
    }

    /// L_d(q0, q1).
    #[must_use]
    pub fn discrete_lagrangian(&self, q0: &SVector<f64, N>, q1: &SVector<f64, N>) -> f64 {
        let (d, middle, h) = (q1 - q0, (q0 + q1) * 0.5, self.h);
        let simpson = (self.potential.value(q0) + self.potential.value(q1)) / 6.0
            + self.potential.value(&middle) * (2.0 / 3.0);
        let gradient = self.potential.gradient(&middle);
        d.dot(&(self.kinetic() * d)) / (2.0 * h)
            - h * simpson
            - h.powi(3) / 24.0 * gradient.dot(&(self.inverse * gradient))
    }

    /// R_d(q0, q1).
    #[must_use]
    pub fn discrete_rayleigh(&self, q0: &SVector<f64, N>, q1: &SVector<f64, N>) -> f64 {
        let d = q1 - q0;
        let change = self.potential.gradient(q1) - self.potential.gradient(q0);
        0.25 * d.dot(&(self.damping * d)) + self.h * self.h / 24.0 * d.dot(&(self.rate * change))
    }

    /// M + (h²/12) CM⁻¹C.
    fn kinetic(&self) -> SMatrix<f64, N, N> {
        self.mass + self.rate * self.damping * (self.h * self.h / 12.0)
    }

    /// p0 = −D1(L_d + R_d) and p1 = D2(L_d − R_d) with their derivatives.
    #[must_use]
    pub fn momenta(&self, q0: &SVector<f64, N>, q1: &SVector<f64, N>) -> LegendreDerivatives<f64, N> {
        let (d, middle, h) = (q1 - q0, (q0 + q1) * 0.5, self.h);
        let of = &self.potential;
        let [g0, g1, g] = [q0, q1, &middle].map(|q| of.gradient(q));
        let [h0, h1, hm] = [q0, q1, &middle].map(|q| of.hessian(q));
        let (cube, square) = (h.powi(3) / 24.0, h * h / 24.0);

        // L_d.
        let along = self.inverse * g;
        let inertia = self.kinetic() / h;
        let both = g * (h / 3.0) + hm * along * cube;
        let d1 = -inertia * d - g0 * (h / 6.0) - both;
        let d2 = inertia * d - g1 * (h / 6.0) - both;
        let shared = hm * (h / 6.0) + (of.third(&middle, &along) + hm * self.inverse * hm) * (0.5 * cube);
        let (d11, d22) = (inertia - h0 * (h / 6.0) - shared, inertia - h1 * (h / 6.0) - shared);
        let d12 = -inertia - shared;

        // R_d.
        let back = self.rate.transpose() * d;
        let pull = self.damping * d * 0.5 + self.rate * (g1 - g0) * square;
        let (r1, r2) = (-pull - h0 * back * square, pull + h1 * back * square);
        let half = self.damping * 0.5;
        let crossed = |hessian: &SMatrix<f64, N, N>| {
            let one = self.rate * hessian;
            (one + one.transpose()) * square
        };
        let r11 = half + crossed(&h0) - of.third(q0, &back) * square;
        let r22 = half + crossed(&h1) + of.third(q1, &back) * square;
        let r12 = -half - (self.rate * h1 + h0 * self.rate.transpose()) * square;

        LegendreDerivatives {
            momenta: Momenta { p0: -d1 - r1, p1: d2 - r2 },
            p0_by_q0: -d11 - r11,
            p0_by_q1: -d12 - r12,
            p1_by_q0: (d12 - r12).transpose(),
            p1_by_q1: d22 - r22,
        }
    }

    /// q1 and the momenta with their derivatives, by Newton's method.
    fn solved(
        &self,
        state: &OrderFourState<N>,
    ) -> Result<(SVector<f64, N>, LegendreDerivatives<f64, N>), OrderFourError> {
        self.require_own(state)?;
        let mut q1 = state.q + self.inverse * state.p * self.h;
        for _ in 0..ITERATIONS {
            let at = self.momenta(&state.q, &q1);
            let correction = invert(&at.p0_by_q1)? * (at.momenta.p0 - state.p);
            q1 -= correction;
            if correction.amax() <= 4.0 * f64::EPSILON * (q1.amax() + state.q.amax()) {
                return Ok((q1, self.momenta(&state.q, &q1)));
            }
        }
        let left = self.momenta(&state.q, &q1).momenta.p0 - state.p;
        Err(StepError::NotConverged { iterations: ITERATIONS, residual: left.amax(), floor: 0.0 }.into())
    }

    /// A step.
    ///
    /// # Errors
    /// [`OrderFourError::AnotherStepSize`], [`OrderFourError::Step`].
    pub fn step(&self, state: &OrderFourState<N>) -> Result<OrderFourState<N>, OrderFourError> {
        let (q, at) = self.solved(state)?;
        Ok(OrderFourState { q, p: at.momenta.p1, h: self.h })
    }

    /// A = ∂(q1, p1)/∂(q0, p0) of the step, for [`RayleighStep::of`](super::RayleighStep::of).
    ///
    /// # Errors
    /// As of [`step`](Self::step).
    pub fn step_matrix(&self, state: &OrderFourState<N>) -> Result<PhaseMatrix<f64, N>, OrderFourError> {
        Ok(self.solved(state)?.1.step_matrix()?)
    }
}

impl fmt::Display for OrderFourError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepSize { h } => write!(f, "the step size is {h}: give a finite one that is not 0"),
            Self::Mass => f.write_str("the mass matrix is not symmetric and positive definite"),
            Self::Damping => {
                f.write_str("the damping matrix is not symmetric, so that no Rayleigh function has it")
            }
            Self::AnotherStepSize { of_state, h } => write!(
                f,
                "the state's momentum belongs to steps of {of_state}, these are of {h}: start again from q and v"
            ),
            Self::Step(error) => write!(f, "{error}"),
        }
    }
}

debug_by_display!(OrderFourError);

impl core::error::Error for OrderFourError {}
