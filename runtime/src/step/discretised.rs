//! A system, a rule and a step size as one value: what everything that is asked of a discrete system is asked
//! of. Floors above add their own questions.

use core::fmt;
use core::marker::PhantomData;

use nalgebra::SVector;

use crate::step::discrete::explained_on;
#[cfg(feature = "theory")]
use crate::step::stop::Stop;
use crate::step::{
    BoundedFlow, BoundedStep, ClosedForm, Discrete, DiscreteForce, DiscreteObjects, DiscreteRayleigh,
    DiscreteSegment, Flow, Linearizable, LinearizedStep, Memory, Segment, State, Step, StepError, StepTaken,
    require_step_size,
};
use crate::system::{Lagrangian, Quantity};

/// A system discretised by rule `R` with step size h: [`by`](crate::Discretise::by).
///
/// ```
/// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
///
/// #[rayleigh_system]
/// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
///     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
/// }
/// let system = Oscillator { m: 1.0, k: 1.0, r: 0.5 };
/// let by = system.by(Midpoint, 0.25);
/// let start = State::from_velocity(&system, [0.0], [1.0])?;
/// let step = by.step(&start)?;
/// assert!((step.state.q[0] - 1.0 / 4.3125).abs() < 1e-15); // 4hp/(4m + h²k + 2hr)
///
/// // The momenta of the segment that was stepped over.
/// let (q0, q1) = (&start.q, &step.state.q);
/// assert!((by.legendre_minus(q0, q1).p - start.p).amax() < 1e-15);
/// assert!((by.legendre_plus(q0, q1).p - step.state.p).amax() < 1e-15);
///
/// // The same step in two halves.
/// let half = by.with_step(0.125);
/// let halves = half.run(start).take(2).last().unwrap()?;
/// assert!((halves.state.q - step.state.q).amax() < 1e-3);
/// # Ok::<(), dalembert::StepError>(())
/// ```
pub struct Discretised<'a, L, R, const N: usize>
where
    L: Lagrangian<N>,
{
    pub(crate) system: &'a L,
    pub(crate) h: L::Scalar,
    pub(crate) guess: Option<SVector<L::Scalar, N>>,
    /// By what a check of many samples is ended.
    #[cfg(feature = "theory")]
    pub(crate) stop: Stop<'a>,
    rule: PhantomData<fn() -> R>,
}

impl<L: Lagrangian<N>, R, const N: usize> Clone for Discretised<'_, L, R, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lagrangian<N>, R, const N: usize> Copy for Discretised<'_, L, R, N> {}

impl<L: Lagrangian<N>, R, const N: usize> fmt::Debug for Discretised<'_, L, R, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (system, rule) = (core::any::type_name::<L>(), core::any::type_name::<R>());
        write!(f, "{system} by {rule} with h = {}", self.h)
    }
}

/// A method by which `L` is stepped: `Midpoint`, if `L` lists `rule = midpoint`.
///
/// That is [`Flow`] seen from the method, which [`by`](crate::Discretise::by) takes by value.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no method by which `{L}` is stepped",
    label = "no rule, composition or splitting of `{L}`",
    note = "rules of the attribute are listed there; one of your own by nodes and weights, `impl DisplacementRule`, is `Quadrature(rule)`"
)]
pub trait MethodOf<L: ?Sized, const N: usize> {}

impl<L: Flow<M, N> + ?Sized, M, const N: usize> MethodOf<L, N> for M {}

impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Lagrangian<N>,
{
    pub(crate) fn new(system: &'a L, h: L::Scalar) -> Self {
        Self {
            system,
            h,
            guess: None,
            #[cfg(feature = "theory")]
            stop: Stop::never(),
            rule: PhantomData,
        }
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &'a L {
        self.system
    }

    /// The step size h.
    #[must_use]
    pub fn step_size(&self) -> L::Scalar {
        self.h
    }

    /// This system by this rule with step size `h`.
    #[must_use]
    pub fn with_step(self, h: L::Scalar) -> Self {
        Self { h, ..self }
    }

    /// This rule and h with another system, such as this one at another time. It asks nobody whether to end.
    #[cfg(feature = "theory")]
    pub(crate) fn of<'b>(&self, system: &'b L) -> Discretised<'b, L, R, N> {
        Discretised { system, h: self.h, guess: self.guess, stop: Stop::never(), rule: PhantomData }
    }

    /// Ends a check as soon as `stop` is asked to end, with an error that says so: whatever looks at many
    /// segments, states or steps asks before each of them.
    ///
    /// Steps ask nobody, nor does a run, which its caller takes step by step.
    ///
    /// ```
    /// use std::sync::atomic::{AtomicBool, Ordering};
    ///
    /// use dalembert::noether::Generator;
    /// use dalembert::run::Stop;
    /// use dalembert::samples::{SampleError, segments};
    /// use dalembert::{Discretise, Midpoint, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn puck(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    ///     let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1]);
    ///     (kinetic, r * kinetic)
    /// }
    /// // Another thread may set it, or a handler of signals.
    /// let flag = AtomicBool::new(false);
    /// let is_asked = || flag.load(Ordering::Relaxed);
    /// let puck = Puck { r: 0.1 };
    /// let noether = puck.by(Midpoint, 0.1).stopped_by(Stop::when(&is_asked)).noether();
    /// let along_x = Generator::translation("x", [1.0, 0.0]);
    /// let segments = segments([-1.0; 2], [1.0; 2], [0.1; 2], 50);
    /// assert!(noether.symmetry(&along_x, &segments).is_ok());
    /// flag.store(true, Ordering::Relaxed);
    /// assert_eq!(noether.symmetry(&along_x, &segments), Err(SampleError::Stopped));
    /// ```
    #[cfg(feature = "theory")]
    #[must_use]
    pub fn stopped_by(self, stop: Stop<'a>) -> Self {
        Self { stop, ..self }
    }

    /// Steps whose mean velocity v̄ = (q1 − q0)/h is near `velocity`, such as that of the step before:
    /// Newton's method starts there, and not at the velocity of the state.
    #[must_use]
    pub fn near(self, velocity: &SVector<L::Scalar, N>) -> Self {
        Self { guess: Some(*velocity), ..self }
    }
}

/// Steps.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// The flow on T*Q: solves p0 = −D1 L_d − f_d⁻ for q1, then p1 = D2 L_d + f_d⁺.
    ///
    /// Newton's method starts at the velocity of the state, and ∂²L/∂v² is checked to be invertible; where
    /// that leads nowhere, it starts again at rest, and away from it if rest is a singular point. h may
    /// be negative. Nothing is allocated, nothing panics (unless L, R or f do), and the number of
    /// iterations is bounded.
    ///
    /// On constraints q1 is on them and v along them, each to rounding: by reactions along their gradients,
    /// at q0 in the equation for q1 and at q1 in p1 ([`reactions`](Self::reactions)).
    ///
    /// In a sequence of steps, [`run`](Self::run) and [`near`](Self::near) save iterations.
    ///
    /// # Errors
    /// A [`StepError`]; the state given is untouched.
    #[inline]
    pub fn step(&self, state: &State<L::Scalar, N>) -> Result<Step<L::Scalar, N>, StepError> {
        self.system.step(state, self.h, self.guess.as_ref())
    }

    /// The step by at most `iterations` undamped Newton iterations, for a clock that does not wait: the work
    /// is bounded, and what is returned is the best iterate, with the residual left and the last
    /// correction in its report.
    ///
    /// # Errors
    /// [`StepError`] where not even one iteration can be made; the state given is untouched.
    pub fn step_within(
        &self,
        state: &State<L::Scalar, N>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError>
    where
        L: BoundedFlow<M, N>,
    {
        self.system.step_within(state, self.h, self.guess.as_ref(), iterations)
    }
}

/// Derivatives of steps.
impl<'a, L, M, const N: usize> Discretised<'a, L, M, N>
where
    L: Flow<M, N>,
{
    /// The step with its derivative A = ∂(q1, p1)/∂(q0, p0), by any method.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64) -> f64 {
    ///     0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    /// }
    /// let state = State { q: vector![0.3], p: vector![-0.2] };
    /// let (step, a) = Oscillator { m: 1.0, k: 1.0 }.by(Gauss::<4>, 0.5).linearized_step(&state)?;
    /// // The rotation by the angle h, to order 8.
    /// assert!((a.q_by_q[0] - 0.5_f64.cos()).abs() < 1e-9 && (a.q_by_p[0] - 0.5_f64.sin()).abs() < 1e-9);
    /// assert!((step.state.q[0] - (a.q_by_q[0] * 0.3 - a.q_by_p[0] * 0.2)).abs() < 1e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`step`](Self::step); [`StepError::SingularNewtonMatrix`] where the step has no derivative.
    pub fn linearized_step(
        &self,
        state: &State<L::Scalar, N>,
    ) -> Result<LinearizedStep<L::Scalar, N>, StepError> {
        self.system.linearized_step(state, self.h, self.guess.as_ref())
    }

    /// The step, linearised: A by the state, B by the input, derivatives by parameters and second ones are
    /// asked of it, and its equations are factored once.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// struct Cart {
    ///     m: f64,
    /// }
    ///
    /// #[rayleigh_system]
    /// impl Cart {
    ///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * self.m * v[0] * v[0]
    ///     }
    ///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
    ///         u
    ///     }
    /// }
    /// let (m, h) = (2.0, 0.1);
    /// let cart = Cart { m };
    /// let state = State::from_velocity(&cart, [0.0], [0.5])?;
    /// let driven = cart.driven([0.3]);
    /// let taken = driven.by(Midpoint, h).linearized(&state)?;
    /// // (q1, p1) ≈ … + A (q0, p0) + B u
    /// let (a, b) = (taken.by_state()?, taken.by_input::<1>()?);
    /// assert!((a.q_by_p[0] - h / m).abs() < 1e-16);
    /// assert!((b.q[0] - h * h / (2.0 * m)).abs() < 1e-16 && (b.p[0] - h).abs() < 1e-16);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linearized_step`](Self::linearized_step).
    pub fn linearized(&self, state: &State<L::Scalar, N>) -> Result<StepTaken<'a, L, M, N>, StepError>
    where
        L: Linearizable<M, N>,
    {
        let mut memory = L::RunMemory::default();
        if let Some(guess) = &self.guess {
            memory.suggest(guess, self.h);
        }
        let step = memory.advance(self.system, state, self.h)?;
        StepTaken::new(self.system, &memory, state, step, self.h)
    }
}

/// Segments, and steps between configurations.
impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The segment from q0 to q1, of which the discrete objects are asked.
    ///
    /// ```
    /// use dalembert::{Discretise, Gauss, nalgebra::vector, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let system = Oscillator { r: 0.0 };
    /// let segment = system.by(Gauss::<4>, 1.0).segment(&vector![0.0], &vector![1.0])?;
    /// // L_d of the exact motion sin t / sin 1: ½ cot 1.
    /// assert!((segment.discrete_lagrangian()? - 0.5 / 1.0_f64.tan()).abs() < 1e-7);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::StepSize`], [`StepError::NonFinite`]; of rules that solve for points within it, the error
    /// that says why there is none.
    pub fn segment(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<DiscreteSegment<'a, L, R, N>, StepError> {
        DiscreteSegment::between(self.system, q0, q1, self.h)
    }

    /// The flow on Q×Q: (q0, q1) ↦ (q1, q2), with q2 = `state.q` of the step returned.
    ///
    /// Of a system at a time t, a view, (q0, q1) is the segment of t, and the step is taken at t + h.
    ///
    /// # Errors
    /// Those of [`step`](Self::step).
    pub fn step_configurations(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        require_step_size(self.h)?;
        StepError::require_finite(q0, Quantity::Configuration)?;
        StepError::require_finite(q1, Quantity::Configuration)?;
        let segment = Segment::between(q0, q1, self.h);
        let state = State { q: *q1, p: self.system.on(&segment)?.momenta().p1 };
        StepError::require_finite(&state.p, Quantity::Derivatives)
            .map_err(|error| explained_on::<L, R, N>(self.system, &segment, error))?;
        self.system.later(self.h, |system| system.step(&state, self.h, self.guess.as_ref()))
    }
}

/// The discrete objects on a segment (q0, q1), under the names of the theory, of rules that have formulas for
/// them. [`segment`](Self::segment) serves all rules, and has the derivatives.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// L_d(q0, q1).
    pub fn discrete_lagrangian(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar
    where
        L: ClosedForm<R, N>,
    {
        self.system.discrete_lagrangian(&self.between(q0, q1))
    }

    /// f_d = (f_d⁻, f_d⁺), of the Rayleigh function and the general force together; 0 where the system has
    /// neither.
    pub fn discrete_force(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N>
    where
        L: ClosedForm<R, N>,
    {
        self.system.discrete_force(&self.between(q0, q1))
    }

    /// 𝔽⁻: (q0, q1) ↦ (q0, −D1 L_d − f_d⁻).
    pub fn legendre_minus(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> State<L::Scalar, N>
    where
        L: ClosedForm<R, N>,
    {
        State { q: *q0, p: self.system.momenta(&self.between(q0, q1)).p0 }
    }

    /// 𝔽⁺: (q0, q1) ↦ (q1, D2 L_d + f_d⁺).
    pub fn legendre_plus(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> State<L::Scalar, N>
    where
        L: ClosedForm<R, N>,
    {
        State { q: *q1, p: self.system.momenta(&self.between(q0, q1)).p1 }
    }

    /// Left side of the forced discrete Euler–Lagrange equation at q1, 0 along solutions:
    /// D2 L_d(q0, q1) + f_d⁺(q0, q1) + D1 L_d(q1, q2) + f_d⁻(q1, q2).
    ///
    /// Of a system at a time t, a view, the second segment is that of t + h.
    pub fn del_residual(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        q2: &SVector<L::Scalar, N>,
    ) -> SVector<L::Scalar, N>
    where
        L: ClosedForm<R, N>,
    {
        const {
            assert!(!L::IS_CONSTRAINED, "on constraints the residual is a reaction: ask `reactions`");
        }
        let (before, after) = (self.between(q0, q1), self.between(q1, q2));
        self.system.momenta(&before).p1 - self.system.later(self.h, |system| system.momenta(&after).p0)
    }

    /// Energy on the segment: E_L at the points and velocity that the rule sees.
    pub fn segment_energy(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar
    where
        L: ClosedForm<R, N>,
    {
        self.system.segment_energy(&self.between(q0, q1))
    }

    pub(crate) fn between(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Segment<L::Scalar, N> {
        Segment::between(q0, q1, self.h)
    }
}

/// The discrete objects of a Rayleigh system on a segment (q0, q1).
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// R_d(q0, q1).
    pub fn discrete_rayleigh(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.system.discrete_rayleigh(&self.between(q0, q1))
    }

    /// L_d⁺ = L_d + R_d.
    pub fn modified_plus(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.system.modified_plus(&self.between(q0, q1))
    }

    /// L_d⁻ = L_d − R_d.
    pub fn modified_minus(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.system.modified_minus(&self.between(q0, q1))
    }
}
