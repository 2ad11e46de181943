//! Exact discrete objects: L_d^ex, f_d^ex± and their derivatives, for any system.
//!
//! ```text
//! L_d^ex(q0, q1, h) = ∫₀ʰ L(q, v) dt
//! f_d^ex+ = ∫₀ʰ f_L·∂q(t)/∂q1 dt,   f_d^ex− = ∫₀ʰ f_L·∂q(t)/∂q0 dt
//! ```
//!
//! along the forced motion with q(0) = q0 and q(h) = q1 (paper, section 3.4; Marsden and West 2001, section
//! 3.2). The discrete flow of these objects is the continuous flow, which makes them the measure of every
//! rule of discretisation.
//!
//! The motion is found by shooting, from whichever end tells it better, and its variations are carried beside
//! it, by an implicit method of order 15 that damping may be stiff to, in steps as long as the motion allows.
//! Where L, R or f takes the time, the motion of a view is that which starts at its time, and goes on from
//! there. What is reached, for smooth systems and moderate h:
//!
//! | object | by | relative error |
//! |---|---|---|
//! | L_d^ex, D1 L_d^ex, D2 L_d^ex, f_d^ex±, p0, p1, ∂p/∂q | second derivatives of L, first of f: no differences | 1e-14 |
//! | D11, D12, D22 of L_d^ex; D1, D2 of f_d^ex± | third derivatives of L by differences of the second ones | 1e-12 |
//!
//! Each result states its own error estimates: [`ExactSegment::report`], [`SecondDerivatives::force_error`].
//! What would be wrong by more than 10⁻⁶ of the motion is an error, and so is a question that takes more than
//! 2²² evaluations of L and f; a segment takes some thousands.
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
//! let segment = Exact::new(&system).segment(vector![0.3], vector![0.5], 0.7)?;
//!
//! // Underdamped, a = r/2m and b = √(4km − r²)/2m: f_d^ex+ = (r/2)(b q0 sinh(ah)/(a sin bh) − q1).
//! let (a, b) = (0.25, (4.0_f64 - 0.25).sqrt() / 2.0);
//! let expected = 0.25 * (b * 0.3 * (a * 0.7_f64).sinh() / (a * (b * 0.7).sin()) - 0.5);
//! assert!((segment.force.plus[0] - expected).abs() < 1e-15);
//! # Ok::<(), dalembert::exact::ExactError>(())
//! ```

mod boundary;
mod collocation;
mod error;
mod existence;
mod mesh;
mod motion;
mod order;
mod second;
mod segment;
mod work;

use nalgebra::{SMatrix, SVector};

use crate::step::stop::Stop;
use crate::step::{Discretised, Quantity, State, StepError};
use crate::system::ActingForce;

pub use error::ExactError;
pub use existence::{Existence, ExistenceVerdict};
pub use order::{Convergence, OrderReport, OrderSample};
pub use second::SecondDerivatives;
pub use segment::{ExactSegment, SegmentReport};

use boundary::{Boundary, Shot, conditioning};
use collocation::unit_of;
use mesh::{Question, ROUNDING};
use motion::{Dynamics, Family, Point};
use work::Work;

/// The exact discrete objects of a system, with the force that acts on it. Systems are in `f64`.
#[derive(Debug)]
pub struct Exact<'a, L, const N: usize> {
    system: &'a L,
    is_forced: bool,
    stop: Stop<'a>,
}

impl<L, const N: usize> Clone for Exact<'_, L, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L, const N: usize> Copy for Exact<'_, L, N> {}

impl<'a, L, const N: usize> Exact<'a, L, N>
where
    L: ActingForce<N, Scalar = f64>,
{
    /// The objects of L with the force f_L = −∂R/∂v + f, as far as the system has R and f.
    pub fn new(system: &'a L) -> Self {
        const { Discretised::<L, (), N>::require_unconstrained() };
        Self { system, is_forced: true, stop: Stop::never() }
    }

    /// The objects of L alone, whatever else the system has.
    pub fn unforced(system: &'a L) -> Self {
        const { Discretised::<L, (), N>::require_unconstrained() };
        Self { system, is_forced: false, stop: Stop::never() }
    }

    /// Ends a question as soon as `stop` is asked to end, with [`ExactError::Stopped`].
    #[must_use]
    pub fn stopped_by(self, stop: Stop<'a>) -> Self {
        Self { stop, ..self }
    }

    /// The system.
    pub fn system(&self) -> &'a L {
        self.system
    }

    /// L_d^ex with its first derivatives and f_d^ex on the segment (q0, q1), with both momenta and their
    /// derivatives.
    ///
    /// h may be negative. The motion sought is the one near the straight line, where several join q0 to q1 (a
    /// pendulum that may turn over).
    ///
    /// # Errors
    /// An [`ExactError`]: conjugate points, no motion found, degenerate L, non-finite values, motion not
    /// resolved.
    pub fn segment(
        &self,
        q0: impl Into<SVector<f64, N>>,
        q1: impl Into<SVector<f64, N>>,
        h: f64,
    ) -> Result<ExactSegment<N>, ExactError> {
        self.solve(q0.into(), q1.into(), h, None)
    }

    /// D11, D12, D22 of L_d^ex and D1, D2 of f_d^ex± on a segment.
    ///
    /// # Errors
    /// [`ExactError::NotDifferentiable`] where third derivatives of L cannot be had by differences of the
    /// second ones; otherwise as [`segment`](Self::segment).
    pub fn second_derivatives(&self, segment: &ExactSegment<N>) -> Result<SecondDerivatives<N>, ExactError> {
        self.asked(|work| {
            if segment.course.reversed {
                let turned = segment.reversed();
                Ok(second::second_derivatives(self.dynamics(segment.h, work), &turned)?.reversed())
            } else {
                second::second_derivatives(self.dynamics(0.0, work), segment)
            }
        })
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
    /// Those of [`segment`](Self::segment) that concern the motion itself: [`ExactError::NonFinite`],
    /// [`ExactError::DegenerateLagrangian`], [`ExactError::MotionNotFinite`], [`ExactError::IllConditioned`],
    /// [`ExactError::Unresolved`], [`ExactError::TooMuchWork`].
    pub fn flow(&self, state: &State<f64, N>, h: f64) -> Result<State<f64, N>, ExactError> {
        require_step_size(h)?;
        self.asked(|work| self.moved(state, h, work))
    }

    fn moved(&self, state: &State<f64, N>, h: f64, work: &Work<'_>) -> Result<State<f64, N>, ExactError> {
        let dynamics = self.dynamics(0.0, work);
        let v = state.velocity(self.system).map_err(ExactError::at_start)?;
        let local = dynamics.local(0.0, &state.q, &v).map_err(|breakdown| breakdown.at(0.0, work))?;
        let start = Point {
            q: state.q,
            p: state.p,
            v,
            minus: Family { q: SMatrix::identity(), p: SMatrix::zeros() },
            plus: Family { q: SMatrix::zeros(), p: SMatrix::identity() },
        };
        let question = Question { blocks: &[], visitor: &|| Box::new(|_, _, _| {}), rounding: ROUNDING };
        let carried = dynamics.resolve(&start, h, &question)?.carried;
        let unit = SVector::from_fn(|a, _| unit_of(&local, a));
        require_accurate(h, conditioning(&start, &carried, &unit))?;
        Ok(State { q: carried.end.q, p: carried.end.p })
    }

    fn solve(
        &self,
        q0: SVector<f64, N>,
        q1: SVector<f64, N>,
        h: f64,
        guess: Option<SVector<f64, N>>,
    ) -> Result<ExactSegment<N>, ExactError> {
        require_step_size(h)?;
        for (vector, quantity) in [(q0, Quantity::Configuration), (q1, Quantity::Configuration)]
            .into_iter()
            .chain(guess.map(|v| (v, Quantity::Velocity)))
        {
            StepError::require_finite(&vector, quantity).map_err(ExactError::at_start)?;
        }
        self.asked(|work| {
            let forwards = Boundary { dynamics: self.dynamics(0.0, work), q0, q1 };
            let backwards = Boundary { dynamics: self.dynamics(h, work), q0: q1, q1: q0 };
            let (is_reversed, shot) = Self::shot(&forwards, &backwards, h, guess, work)?;
            require_accurate(h, shot.conditioning)?;
            let segment = if is_reversed {
                segment::along(&backwards, -h, &shot)?.reversed()
            } else {
                segment::along(&forwards, h, &shot)?
            };
            require_accurate(h, segment.report.error())?;
            Ok(segment)
        })
    }

    /// The answer to one question, with the work that it may take.
    fn asked<T>(&self, answer: impl FnOnce(&Work<'_>) -> Result<T, ExactError>) -> Result<T, ExactError> {
        let work = Work::new(self.stop);
        let answer = answer(&work);
        // Attempts that end early are followed by others: it may have been any error.
        if work.is_stopped() { Err(ExactError::Stopped) } else { answer }
    }

    /// The motion, from the end that tells it well, and whether that is q1.
    fn shot(
        forwards: &Boundary<'_, L, N>,
        backwards: &Boundary<'_, L, N>,
        h: f64,
        guess: Option<SVector<f64, N>>,
        work: &Work<'_>,
    ) -> Result<(bool, Shot<N>), ExactError> {
        /// A shot whose start tells its end to so many digits needs no other.
        const WELL: f64 = 1e-12;
        let straight = work.with_share(8, || forwards.directly(h, guess.as_ref(), WELL));
        let failure = match straight {
            Ok(shot) => return Ok((false, shot)),
            Err(
                failure @ (ExactError::ConjugatePoints { .. }
                | ExactError::DegenerateLagrangian { .. }
                | ExactError::SingularCoordinates { .. }),
            ) => {
                return Err(failure);
            }
            // Newton's method has lost a motion that its start does tell.
            Err(failure @ (ExactError::NoMotion { .. } | ExactError::Unresolved { .. })) => {
                return forwards.followed(h, failure).map(|shot| (false, shot));
            }
            Err(failure) => failure,
        };
        // The start does not tell the end, or a trial escapes on the way. A guess is kept to by where its
        // motion ends.
        let by_guess = guess.map(|_| work.with_share(8, || forwards.directly(h, guess.as_ref(), WORST)));
        let end = by_guess.as_ref().and_then(|found| found.as_ref().ok()).map(|shot| shot.end.v);
        if guess.is_none() || end.is_some() {
            let from_behind = work.with_share(8, || backwards.directly(-h, end.as_ref(), WELL));
            if let Ok(shot) = from_behind {
                return Ok((true, shot));
            }
        }
        if let Some(Ok(shot)) = by_guess {
            return Ok((false, shot));
        }
        let attempts = [
            work.with_share(8, || forwards.directly(h, guess.as_ref(), WORST)).map(|shot| (false, shot)),
            work.with_share(4, || backwards.followed(-h, failure)).map(|shot| (true, shot)),
        ];
        let found = attempts.into_iter().filter_map(Result::ok);
        match found.min_by(|a, b| a.1.conditioning.total_cmp(&b.1.conditioning)) {
            Some(found) => Ok(found),
            None => forwards.followed(h, failure).map(|shot| (false, shot)),
        }
    }

    fn dynamics<'b>(&self, origin: f64, work: &'b Work<'_>) -> Dynamics<'b, L, N>
    where
        'a: 'b,
    {
        Dynamics { system: self.system, is_forced: self.is_forced, origin, work }
    }
}

fn require_step_size(h: f64) -> Result<(), ExactError> {
    if h.is_finite() && h != 0.0 { Ok(()) } else { Err(ExactError::StepSize { h }) }
}

/// The largest error estimate, relative to the largest of the motion, that a result is given with.
const WORST: f64 = 1e-6;

/// Fails where rounding is enlarged beyond what a result may be wrong by; so does a NaN.
fn require_accurate(h: f64, error: f64) -> Result<(), ExactError> {
    if error <= WORST { Ok(()) } else { Err(ExactError::IllConditioned { h, error }) }
}
