//! A system, a rule and a step size as one value: what everything that is asked of a discrete system is asked of.

use core::fmt;
use core::marker::PhantomData;

use nalgebra::SVector;

#[cfg(feature = "std")]
use crate::theory::{hamilton_jacobi::HamiltonJacobi, noether::Noether};
use crate::{
    BoundedStep, Certificate, Checkpoint, Derivatives, Discrete, DiscreteDriven, DiscreteForce,
    DiscreteParameters, DiscreteRayleigh, DiscreteSecondOrder, Lagrangian, LegendreDerivatives,
    Linearization, OffersMethods, Request, SolvedForVelocity, State, StateBy, Step, StepError, StepHessian,
    StepWith, Trajectory,
};

/// What makes a [`Discretised`] of every system.
pub trait Discretise<const N: usize>: Lagrangian<N> + Sized {
    /// This system discretised by `rule` with step size `h`: what is asked of a discrete system is asked of the value returned.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], c: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * c * v[0] * v[0])
    /// }
    /// let pendulum = Pendulum { c: 0.1 };
    /// let start = State::from_velocity(&pendulum, [1.0], [0.0])?;
    /// let end = pendulum.by(Midpoint, 0.1).run(start).nth(99).unwrap()?.state;
    /// assert!(end.energy(&pendulum)? < start.energy(&pendulum)?);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[inline]
    fn by<R>(&self, rule: R, h: Self::Scalar) -> Discretised<'_, Self, R, N>
    where
        R: RuleOf<Self, N>,
    {
        let _ = rule;
        Discretised::new(self, h)
    }

    /// This system with an error of at most `tolerance` asked for, in units of q, of its state on the whole way: the method and the
    /// step size are chosen by the motion.
    ///
    /// What is promised, and how it is chosen and guarded, [`Method::for_tolerance`](crate::Method::for_tolerance) tells.
    ///
    /// ```
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], c: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * c * v[0] * v[0])
    /// }
    /// let pendulum = Pendulum { c: 0.1 };
    /// let start = State::from_velocity(&pendulum, [1.0], [0.0])?;
    /// let mut run = pendulum.to_error(1e-9).until(20.0).run(start)?;
    /// let end = run.by_ref().last().unwrap()?;
    /// assert!(run.breach().is_none() && end.energy(&pendulum)? < start.energy(&pendulum)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    fn to_error(&self, tolerance: f64) -> Request<'_, Self, Self::Methods>
    where
        Self: OffersMethods<N>,
    {
        Request::new(self, Self::Methods::default(), tolerance)
    }
}

impl<L: Lagrangian<N>, const N: usize> Discretise<N> for L {}

/// A system discretised by rule `R` with step size h: [`by`](Discretise::by).
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
    system: &'a L,
    h: L::Scalar,
    guess: Option<SVector<L::Scalar, N>>,
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

/// A rule by which `L` is discretised: `Midpoint`, if `L` lists `rule = midpoint`.
///
/// That is [`Discrete`] seen from the rule, which [`by`](Discretise::by) takes by value.
pub trait RuleOf<L: ?Sized, const N: usize> {}

impl<L: Discrete<R, N> + ?Sized, R, const N: usize> RuleOf<L, N> for R {}

impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Lagrangian<N>,
{
    pub(crate) fn new(system: &'a L, h: L::Scalar) -> Self {
        Self { system, h, guess: None, rule: PhantomData }
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

    /// The same system by the same rule with step size `h`.
    #[must_use]
    pub fn with_step(self, h: L::Scalar) -> Self {
        Self { h, ..self }
    }

    /// The same for steps whose mean velocity v̄ = (q1 − q0)/h is near `velocity`, such as that of the step before: Newton's method
    /// starts there, and not at the velocity of the state.
    #[must_use]
    pub fn near(self, velocity: &SVector<L::Scalar, N>) -> Self {
        Self { guess: Some(*velocity), ..self }
    }
}

/// Steps and runs.
impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The flow on T*Q: solves p0 = −D1 L_d − f_d⁻ for q1, then p1 = D2 L_d + f_d⁺.
    ///
    /// Newton's method starts at the velocity of the state, and ∂²L/∂v² is checked to be invertible; where that leads nowhere, it
    /// starts again at rest, and away from it if rest is a singular point. h may be negative. Nothing is allocated, nothing panics
    /// (unless L, R or f do), and the number of iterations is bounded.
    ///
    /// In a sequence of steps, [`run`](Self::run) and [`near`](Self::near) save iterations.
    ///
    /// # Errors
    /// A [`StepError`]; the state given is untouched.
    #[inline]
    pub fn step(&self, state: &State<L::Scalar, N>) -> Result<Step<L::Scalar, N>, StepError> {
        self.system.step(state, self.h, self.guess.as_ref())
    }

    /// The step by at most `iterations` undamped Newton iterations, for a clock that does not wait: [`Discrete::step_within`].
    ///
    /// # Errors
    /// [`StepError`] where not even one iteration can be made; the state given is untouched.
    pub fn step_within(
        &self,
        state: &State<L::Scalar, N>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError>
    where
        R: SolvedForVelocity,
    {
        self.system.step_within(state, self.h, self.guess.as_ref(), iterations)
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
        self.system.step_configurations(q0, q1, self.h, self.guess.as_ref())
    }

    /// The steps from `state`, one after the other: each is cheaper than [`step`](Self::step), by what is known of those before.
    #[must_use = "a run is an iterator: it takes a step when it is asked for the next"]
    pub fn run(&self, state: State<L::Scalar, N>) -> Trajectory<'a, L, R, N> {
        Trajectory::from_checkpoint(self.system, Checkpoint::new(self.h, state))
    }

    /// The step with its derivative A = ∂(q1, p1)/∂(q0, p0).
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
    /// let (step, linearization) = Oscillator { m: 1.0, k: 1.0 }.by(Gauss::<4>, 0.5).linearized_step(&state)?;
    /// // The rotation by the angle h, to order 8.
    /// let a = linearization.a;
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
    ) -> Result<StepWith<L::Scalar, N, Linearization<L::Scalar, N>>, StepError> {
        self.system.linearized_step(state, self.h, self.guess.as_ref())
    }

    /// A of the step that leads from q0 to q1.
    ///
    /// By [`Gauss`](crate::Gauss) [`linearized_step`](Self::linearized_step) costs less: this solves for the stages anew, and two
    /// ends need not determine a segment.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    ///     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let (m, k, r, h) = (1.0, 1.0, 0.5, 0.25);
    /// let a = Oscillator { m, k, r }.by(Midpoint, h).linearization(&vector![0.0], &vector![0.2])?.a;
    /// let determinant = (4.0 * m + h * h * k - 2.0 * h * r) / (4.0 * m + h * h * k + 2.0 * h * r);
    /// assert!((a.assembled::<2>().determinant() - determinant).abs() < 1e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] if ∂p0/∂q1 is singular: there the step has no derivative.
    pub fn linearization(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<Linearization<L::Scalar, N>, StepError> {
        self.system.linearization(q0, q1, self.h)
    }

    /// How well the equation of a step that was taken from `state` was posed, and on which branch its root lies.
    ///
    /// Costs one evaluation and the inverse of an N×N matrix, twice a Newton iteration or less; a step itself never asks for it.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn spring(q: [f64; 2], v: [f64; 2], k: f64) -> f64 {
    ///     0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (q[1] - q[0]).powi(2)
    /// }
    /// let state = State { q: vector![0.0, 1.0], p: vector![0.2, -0.3] };
    /// let system = Spring { k: 4e6 };
    /// let by = system.by(Midpoint, 1.0);
    /// // I + (h²k/4) [1 −1; −1 1]: the stretch is a million times as stiff as the mass.
    /// let condition = by.certificate(&state, &by.step(&state)?)?.condition;
    /// assert!((condition / 2e6 - 1.0).abs() < 1e-6);
    ///
    /// #[rayleigh_system]
    /// fn accelerated(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] - 0.0 * q[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let state = State { q: vector![0.0], p: vector![1.0] };
    /// let past_the_fold = |r: f64| {
    ///     let system = Accelerated { r };
    ///     let by = system.by(Midpoint, 1.0);
    ///     !by.certificate(&state, &by.step(&state).unwrap()).unwrap().on_the_branch_of_the_flow
    /// };
    /// assert!(!past_the_fold(-1.9) && past_the_fold(-2.1));
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if derivatives at the step are not finite; those of a step of [`Gauss`](crate::Gauss), which solves
    /// for its stages again.
    pub fn certificate(
        &self,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
    ) -> Result<Certificate<L::Scalar>, StepError> {
        Certificate::of(self.system, state, step, self.h)
    }
}

/// The discrete objects on a segment (q0, q1), under the names of the theory.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// L_d(q0, q1).
    pub fn discrete_lagrangian(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar {
        self.system.discrete_lagrangian(q0, q1, self.h)
    }

    /// L_d with D1, D2, D11, D12, D22.
    pub fn discrete_lagrangian_derivatives(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        self.system.discrete_lagrangian_derivatives(q0, q1, self.h)
    }

    /// f_d = (f_d⁻, f_d⁺), of the Rayleigh function and the general force together; 0 where the system has neither.
    pub fn discrete_force(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N> {
        self.system.discrete_force(q0, q1, self.h)
    }

    /// 𝔽⁻: (q0, q1) ↦ (q0, −D1 L_d − f_d⁻).
    pub fn legendre_minus(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> State<L::Scalar, N> {
        self.system.legendre_minus(q0, q1, self.h)
    }

    /// 𝔽⁺: (q0, q1) ↦ (q1, D2 L_d + f_d⁺).
    pub fn legendre_plus(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> State<L::Scalar, N> {
        self.system.legendre_plus(q0, q1, self.h)
    }

    /// Both momenta of the segment with their derivatives by q0 and q1.
    pub fn legendre_derivatives(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> LegendreDerivatives<L::Scalar, N> {
        self.system.legendre_derivatives(q0, q1, self.h)
    }

    /// Left side of the forced discrete Euler–Lagrange equation at q1, 0 along solutions: [`Discrete::del_residual`].
    pub fn del_residual(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        q2: &SVector<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        self.system.del_residual(q0, q1, q2, self.h)
    }

    /// Energy on the segment: E_L at the points and velocity that the rule sees.
    pub fn segment_energy(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar {
        self.system.segment_energy(q0, q1, self.h)
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
        self.system.discrete_rayleigh(q0, q1, self.h)
    }

    /// R_d with D1, D2, D11, D12, D22.
    pub fn discrete_rayleigh_derivatives(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N>
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.system.discrete_rayleigh_derivatives(q0, q1, self.h)
    }

    /// L_d⁺ = L_d + R_d.
    pub fn modified_plus(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.system.modified_plus(q0, q1, self.h)
    }

    /// L_d⁻ = L_d − R_d.
    pub fn modified_minus(&self, q0: &SVector<L::Scalar, N>, q1: &SVector<L::Scalar, N>) -> L::Scalar
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.system.modified_minus(q0, q1, self.h)
    }
}

/// Derivatives by the input of a system that holds one, `system.driven(u)`.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The step with its derivatives A by the state and B = ∂(q1, p1)/∂u by the input, which is held over the step.
    ///
    /// # Errors
    /// Those of [`linearized_step`](Self::linearized_step).
    pub fn linearized_step_with_input<const M: usize>(
        &self,
        state: &State<L::Scalar, N>,
    ) -> Result<StepWith<L::Scalar, N, Linearization<L::Scalar, N, M>>, StepError>
    where
        L: DiscreteDriven<R, N, M>,
    {
        self.system.linearized_step_with_input(state, self.h, self.guess.as_ref())
    }

    /// A and B of the step that leads from q0 to q1: (q1, p1) ≈ … + A (q0, p0) + B u.
    ///
    /// ```
    /// use dalembert::{Discretise, Linearization, Midpoint, State, rayleigh_system};
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
    /// let by = driven.by(Midpoint, h);
    /// let end = by.step(&state)?.state;
    /// let Linearization { a, b, .. } = by.linearization_with_input(&state.q, &end.q)?;
    /// assert!((a.q_by_p[0] - h / m).abs() < 1e-16);
    /// assert!((b.q[0] - h * h / (2.0 * m)).abs() < 1e-16 && (b.p[0] - h).abs() < 1e-16);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linearization`](Self::linearization).
    pub fn linearization_with_input<const M: usize>(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<Linearization<L::Scalar, N, M>, StepError>
    where
        L: DiscreteDriven<R, N, M>,
    {
        self.system.linearization_with_input(q0, q1, self.h)
    }
}

/// Derivatives by the fields that `#[rayleigh_system(parameters = […])]` lists.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The step with ∂(q1, p1)/∂θ.
    ///
    /// # Errors
    /// Those of [`linearized_step`](Self::linearized_step).
    pub fn step_by_parameters<const P: usize>(
        &self,
        state: &State<L::Scalar, N>,
    ) -> Result<StepWith<L::Scalar, N, StateBy<L::Scalar, N, P>>, StepError>
    where
        L: DiscreteParameters<R, N, P>,
    {
        self.system.step_by_parameters(state, self.h, self.guess.as_ref())
    }

    /// ∂(q1, p1)/∂θ of the step that leads from q0 to q1, (q0, p0) held.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, rayleigh_system};
    ///
    /// #[rayleigh_system(parameters = [r])]
    /// fn drag(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    ///     let _ = q;
    ///     (0.5 * m * v[0] * v[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let (m, r, h) = (2.0, 0.5, 0.1);
    /// // From p0 the step goes to q1 = q0 + h p0/(m + hr/2).
    /// let p0 = 1.0;
    /// let q1 = h * p0 / (m + h * r / 2.0);
    /// let by_r = Drag { m, r }.by(Midpoint, h).state_by_parameters(&vector![0.0], &vector![q1])?;
    /// assert!((by_r.q[0] + h * h / 2.0 * p0 / (m + h * r / 2.0).powi(2)).abs() < 1e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linearization`](Self::linearization).
    pub fn state_by_parameters<const P: usize>(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError>
    where
        L: DiscreteParameters<R, N, P>,
    {
        self.system.state_by_parameters(q0, q1, self.h)
    }
}

/// Second derivatives of the step, contracted with a covector (`step_derivatives = second`): by the input as well where the
/// system holds one.
impl<L, R, const N: usize> Discretised<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The step with the second derivatives of `covector`.q·q1 + `covector`.p·p1.
    ///
    /// # Errors
    /// Those of [`linearized_step`](Self::linearized_step).
    pub fn step_with_hessian<const M: usize>(
        &self,
        state: &State<L::Scalar, N>,
        covector: &State<L::Scalar, N>,
    ) -> Result<StepWith<L::Scalar, N, StepHessian<L::Scalar, N, M>>, StepError>
    where
        L: DiscreteSecondOrder<R, N, M>,
    {
        self.system.step_with_hessian(state, self.h, self.guess.as_ref(), covector)
    }

    /// Second derivatives of `covector`.q·q1 + `covector`.p·p1 for the step that leads from q0 to q1.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system(step_derivatives = second)]
    /// fn quartic(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.25 * q[0].powi(4)
    /// }
    /// let covector = State { q: vector![0.0], p: vector![1.0] };
    /// let hessian = Quartic {}.by(Midpoint, 0.1).step_hessian(&vector![1.0], &vector![1.0], &covector)?;
    /// assert!(hessian.qq[0] < 0.0); // the restoring force grows faster than linearly
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linearization`](Self::linearization).
    pub fn step_hessian<const M: usize>(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        covector: &State<L::Scalar, N>,
    ) -> Result<StepHessian<L::Scalar, N, M>, StepError>
    where
        L: DiscreteSecondOrder<R, N, M>,
    {
        self.system.step_hessian(q0, q1, self.h, covector)
    }
}

/// The theory of the discrete system.
#[cfg(feature = "std")]
impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// Momentum maps, and what friction does to them.
    #[must_use]
    pub fn noether(&self) -> Noether<'a, L, R, N> {
        Noether::new(self.system, self.h)
    }

    /// The Hamilton–Jacobi equations of the discrete system, and its characteristics.
    #[must_use]
    pub fn hamilton_jacobi(&self) -> HamiltonJacobi<'a, L, R, N> {
        HamiltonJacobi::new(self.system, self.h)
    }
}
