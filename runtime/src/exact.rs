//! Exact discrete objects: L_d^ex, f_d^ex± and their derivatives, for any system.
//!
//! ```text
//! L_d^ex(q0, q1, h) = ∫₀ʰ L(q, v) dt
//! f_d^ex+ = ∫₀ʰ f_L·∂q(t)/∂q1 dt,   f_d^ex− = ∫₀ʰ f_L·∂q(t)/∂q0 dt
//! ```
//!
//! along the forced motion with q(0) = q0 and q(h) = q1 (paper, section 3.4; Marsden and West 2001, section 3.2). The
//! discrete flow of these objects is the continuous flow, which makes them the measure of every rule of discretisation.
//!
//! The motion is found by shooting, and its variations are carried beside it; the integrals are components of the same
//! ordinary differential equation. What is reached, for smooth systems and moderate h:
//!
//! | object | by | relative error |
//! |---|---|---|
//! | L_d^ex, D1 L_d^ex, D2 L_d^ex, f_d^ex±, p0, p1, ∂p/∂q | second derivatives of L, first of f: no differences | 1e-14 |
//! | D11, D12, D22 of L_d^ex; D1, D2 of f_d^ex± | third derivatives of L by differences of the second ones | 1e-12 |
//!
//! Each result states its own error estimates: [`Segment::report`], [`SecondDerivatives::force_error`].
//!
//! ```
//! use dalembert::exact::Exact;
//! use dalembert::nalgebra::vector;
//! use dalembert::rayleigh_system;
//!
//! #[rayleigh_system]
//! fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
//!     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
//! }
//!
//! let system = Oscillator { m: 1.0, k: 1.0, r: 0.5 };
//! let segment = Exact::rayleigh(&system).segment(vector![0.3], vector![0.5], 0.7)?;
//!
//! // Underdamped, a = r/2m and b = √(4km − r²)/2m: f_d^ex+ = (r/2)(b q0 sinh(ah)/(a sin bh) − q1).
//! let (a, b) = (0.25, (4.0_f64 - 0.25).sqrt() / 2.0);
//! let expected = 0.25 * (b * 0.3 * (a * 0.7_f64).sinh() / (a * (b * 0.7).sin()) - 0.5);
//! assert!((segment.force.plus[0] - expected).abs() < 1e-15);
//! # Ok::<(), dalembert::exact::ExactError>(())
//! ```

mod acting_force;
mod boundary;
mod error;
mod existence;
mod motion;
mod order;
mod resolve;
mod second;
mod segment;

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use crate::error::StepError;
use crate::{Force, Lagrangian, Quantity, Rayleigh, State};

pub use acting_force::{ActingForce, GeneralForce, RayleighAndGeneralForce, RayleighForce, Unforced};
pub use error::ExactError;
pub use existence::{Existence, ExistenceVerdict};
pub use order::{Convergence, OrderReport, OrderSample};
pub use second::SecondDerivatives;
pub use segment::{Segment, SegmentReport};

use boundary::Boundary;
use motion::{Dynamics, Family, Point};

/// The exact discrete objects of a system, with the force that acts on it.
///
/// Each constructor names the force: [`unforced`](Exact::unforced), [`rayleigh`](Exact::rayleigh),
/// [`general`](Exact::general), [`rayleigh_and_general`](Exact::rayleigh_and_general). Systems are in `f64`.
#[derive(Debug)]
pub struct Exact<'a, L, F, const N: usize> {
    system: &'a L,
    force: PhantomData<F>,
}

impl<L, F, const N: usize> Clone for Exact<'_, L, F, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L, F, const N: usize> Copy for Exact<'_, L, F, N> {}

impl<'a, L: Lagrangian<N, Scalar = f64>, const N: usize> Exact<'a, L, Unforced, N> {
    /// The objects of L alone, whatever else the system has.
    pub fn unforced(system: &'a L) -> Self {
        Self { system, force: PhantomData }
    }
}

impl<'a, L: Rayleigh<N, Scalar = f64>, const N: usize> Exact<'a, L, RayleighForce, N> {
    /// The objects of L with the force −∂R/∂v.
    pub fn rayleigh(system: &'a L) -> Self {
        Self { system, force: PhantomData }
    }
}

impl<'a, L: Force<N, Scalar = f64>, const N: usize> Exact<'a, L, GeneralForce, N> {
    /// The objects of L with the general force f.
    pub fn general(system: &'a L) -> Self {
        Self { system, force: PhantomData }
    }
}

impl<'a, L, const N: usize> Exact<'a, L, RayleighAndGeneralForce, N>
where
    L: Rayleigh<N, Scalar = f64> + Force<N>,
{
    /// The objects of L with the force −∂R/∂v + f.
    pub fn rayleigh_and_general(system: &'a L) -> Self {
        Self { system, force: PhantomData }
    }
}

impl<'a, L, F, const N: usize> Exact<'a, L, F, N>
where
    L: Lagrangian<N, Scalar = f64>,
    F: ActingForce<L, N>,
{
    /// The system.
    pub fn system(&self) -> &'a L {
        self.system
    }

    /// L_d^ex with its first derivatives and f_d^ex on the segment (q0, q1), with both momenta and their derivatives.
    ///
    /// h may be negative. The motion sought is the one near the straight line; where several join q0 to q1 (a pendulum
    /// that may turn over), [`segment_near`](Self::segment_near) chooses.
    ///
    /// # Errors
    /// An [`ExactError`]: conjugate points, no motion found, degenerate L, non-finite values, motion not resolved.
    pub fn segment(
        &self,
        q0: impl Into<SVector<f64, N>>,
        q1: impl Into<SVector<f64, N>>,
        h: f64,
    ) -> Result<Segment<N>, ExactError> {
        self.solve(q0.into(), q1.into(), h, None)
    }

    /// As [`segment`](Self::segment), for the motion whose initial velocity is near `v0`.
    ///
    /// # Errors
    /// As [`segment`](Self::segment).
    pub fn segment_near(
        &self,
        q0: impl Into<SVector<f64, N>>,
        q1: impl Into<SVector<f64, N>>,
        h: f64,
        v0: impl Into<SVector<f64, N>>,
    ) -> Result<Segment<N>, ExactError> {
        self.solve(q0.into(), q1.into(), h, Some(v0.into()))
    }

    /// D11, D12, D22 of L_d^ex and D1, D2 of f_d^ex± on a segment.
    ///
    /// # Errors
    /// [`ExactError::NotDifferentiable`] where third derivatives of L cannot be had by differences of the second ones;
    /// otherwise as [`segment`](Self::segment).
    pub fn second_derivatives(&self, segment: &Segment<N>) -> Result<SecondDerivatives<N>, ExactError> {
        second::second_derivatives(self.dynamics(), segment)
    }

    /// Whether f_d^ex is Rayleigh at (q0, q1), by the integrals of the paper's existence criterion.
    ///
    /// # Errors
    /// As [`second_derivatives`](Self::second_derivatives).
    pub fn existence(
        &self,
        q0: impl Into<SVector<f64, N>>,
        q1: impl Into<SVector<f64, N>>,
        h: f64,
    ) -> Result<Existence<N>, ExactError> {
        let segment = self.segment(q0, q1, h)?;
        Ok(existence::of(&segment, &self.second_derivatives(&segment)?))
    }

    /// The continuous flow on T*Q: the state a time h after `state`.
    ///
    /// # Errors
    /// [`ExactError::NonFinite`], [`ExactError::DegenerateLagrangian`], [`ExactError::MotionNotFinite`],
    /// [`ExactError::Unresolved`].
    pub fn flow(&self, state: &State<f64, N>, h: f64) -> Result<State<f64, N>, ExactError> {
        require_step_size(h)?;
        let v = state.velocity(self.system).map_err(ExactError::at_start)?;
        let still = Family { q: SMatrix::zeros(), p: SMatrix::zeros() };
        let start = Point { q: state.q, v, minus: still, plus: still };
        let end = Point::<N>::read(&self.dynamics().carry(&start, h, 0.0)?.end);
        Ok(State { q: end.q, p: self.system.lagrangian_gradient(&end.q, &end.v).d2 })
    }

    fn solve(
        &self,
        q0: SVector<f64, N>,
        q1: SVector<f64, N>,
        h: f64,
        guess: Option<SVector<f64, N>>,
    ) -> Result<Segment<N>, ExactError> {
        require_step_size(h)?;
        for (vector, quantity) in [(q0, Quantity::Configuration), (q1, Quantity::Configuration)]
            .into_iter()
            .chain(guess.map(|v| (v, Quantity::Velocity)))
        {
            StepError::require_finite(&vector, quantity).map_err(ExactError::at_start)?;
        }
        let boundary = Boundary { dynamics: self.dynamics(), q0, q1 };
        let shot = boundary.solve(h, guess.as_ref())?;
        segment::along(&boundary, h, &shot)
    }

    fn dynamics(&self) -> Dynamics<'a, L, F, N> {
        Dynamics { system: self.system, force: PhantomData }
    }
}

fn require_step_size(h: f64) -> Result<(), ExactError> {
    if h.is_finite() && h != 0.0 { Ok(()) } else { Err(ExactError::StepSize { h }) }
}
