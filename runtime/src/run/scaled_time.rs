//! Runs whose steps follow a time scale of the motion.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::run::{Checkpoint, Trajectory};
use crate::step::{Flow, Memory, State, StepError};
use crate::system::{Lagrangian, TimeScale};

/// Steps that follow the motion.
impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Lets the steps follow the time scale σ(q) of the system: they are equal in τ, dt = σ dτ. The step size
    /// that the run was given is Δτ; a run that has begun goes on from its last step.
    ///
    /// ```text
    /// λ = ∇σ·v / σ,   1/h_½ = 1/(σ Δτ) − ½ λ(q_0, v_0),   1/h_{n+½} = 1/h_{n−½} − λ(q_n, v_n)
    /// ```
    ///
    /// since d(1/σ)/dτ = −λ along the motion (E. Hairer and G. Söderlind, SIAM J. Sci. Comput. 26, 2005).
    ///
    /// **What is kept.** Each step is one of the method, with a size of its own: momentum maps are kept to
    /// rounding, and forces take what the rule says they take, at any Δτ and with any σ, whatever its
    /// symmetry. A run of a symmetric method is reversible: from p reversed the same steps lead back. That is
    /// what bounds the error of the energy; the map of a step is not symplectic, as its h depends on the
    /// state.
    ///
    /// **Why not in τ.** σ(q)(L(q, w/σ(q)) + E) is the Lagrangian, in τ with w = dq/dτ, of the motions of energy
    /// E (H. Poincaré's transformation); its steps of one size are symplectic. It can be written as a system of
    /// its own. Measured on orbits of eccentricity 0.99 and 0.999 over 10⁴ rounds, with σ = |q|^{3/2}, at
    /// equal cost: what is here has less error of the energy, by 30 and 80 times, as no rounding of E is
    /// divided by σ; it needs no E, has forces, and keeps momentum maps that σ does not. On a chaotic orbit of
    /// Hénon and Heiles' problem neither drifts in 10⁷ steps. With (t, −E) for coordinates,
    /// s L(q, w/s) + (s/σ − 1)²/2c, s = dt/dτ, it has forces too, and costs 3 to 100 times as much, by c.
    ///
    /// [`step_size`](Trajectory::step_size) is that of the last step, and the time the sum of all, with
    /// compensation. Errors: [`StepError::TimeScale`] besides those of the steps.
    ///
    /// An orbit of eccentricity 0.99, whose speeds differ by a factor of 199:
    ///
    /// ```
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// struct Kepler;
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// impl Kepler {
    ///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
    ///         0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
    ///     }
    ///     fn time_scale(&self, q: [f64; 2]) -> f64 {
    ///         (q[0] * q[0] + q[1] * q[1]).powf(0.75)
    ///     }
    /// }
    /// let start = State { q: [1.99, 0.0].into(), p: [0.0, (0.01_f64 / 1.99).sqrt()].into() };
    /// let mut run = Kepler.by(Gauss::<8>, 0.3).run(start).in_scaled_time();
    /// let mut steps = 0;
    /// while run.time() < std::f64::consts::TAU {
    ///     run.next().unwrap()?;
    ///     steps += 1;
    /// }
    /// assert_eq!(steps, 38);
    /// assert!((run.state().energy(&Kepler)? + 0.5).abs() < 1e-11);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[must_use = "the run given is consumed"]
    pub fn in_scaled_time(mut self) -> Self
    where
        L: TimeScale<N>,
    {
        self.pace = Some(Pace::new(&self.at));
        self
    }
}

/// σ and ∇σ of a system at q.
type Scale<L, const N: usize> =
    fn(&L, &SVector<Scalars<L, N>, N>) -> (Scalars<L, N>, SVector<Scalars<L, N>, N>);
type Scalars<L, const N: usize> = <L as Lagrangian<N>>::Scalar;

/// How steps follow a time scale.
pub(super) struct Pace<L: Lagrangian<N>, const N: usize> {
    scale: Scale<L, N>,
    course: Course<L::Scalar>,
    /// The course and the clock before the step that is being taken: step size, origin, steps.
    before: (Course<L::Scalar>, L::Scalar, f64, u64),
}

/// What is known of the steps so far.
#[derive(Clone, Copy)]
struct Course<S> {
    /// Δτ; 0 while it is not known, of a run resumed.
    parameter_step: S,
    /// Whether the next step is the first, from σ itself.
    is_first: bool,
    /// What the clock has lost by rounding.
    rest: f64,
}

impl<L: Lagrangian<N>, const N: usize> Pace<L, N> {
    fn new(at: &Checkpoint<L::Scalar, N>) -> Self
    where
        L: TimeScale<N>,
    {
        let is_first = at.steps == 0;
        let parameter_step = if is_first { at.step_size } else { L::Scalar::constant(0.0) };
        let course = Course { parameter_step, is_first, rest: 0.0 };
        let before = (course, at.step_size, at.origin, at.steps);
        Self { scale: L::time_scale_gradient, course, before }
    }

    /// Starts anew with Δτ.
    pub(super) fn begin(&mut self, parameter_step: L::Scalar) {
        self.course.parameter_step = parameter_step;
        self.course.is_first = true;
    }

    /// Starts anew with the same Δτ, if it is known.
    pub(super) fn begin_again(&mut self) {
        self.course.is_first = self.course.parameter_step != L::Scalar::constant(0.0);
    }

    /// Makes `at` what the next step starts from: with its step size, and the time as its origin.
    ///
    /// # Errors
    /// [`StepError::TimeScale`]; those of [`State::velocity`].
    pub(super) fn next<M>(
        &mut self,
        system: &L,
        memory: &L::RunMemory,
        at: &mut Checkpoint<L::Scalar, N>,
    ) -> Result<(), StepError>
    where
        L: Flow<M, N>,
    {
        let of = L::Scalar::constant;
        let time = at.time();
        let State { q, .. } = &at.state;
        let velocity = match memory.velocity(&at.state) {
            Some(velocity) => velocity,
            None => system.later(of(time), |system| at.state.velocity(system))?,
        };
        let (scale, gradient) = (self.scale)(system, q);
        let rate = gradient.dot(&velocity) / scale;
        let Course { mut parameter_step, is_first, mut rest } = self.course;
        let before = if is_first { parameter_step * scale } else { at.step_size };
        let density = |share: f64| of(1.0) / before - of(share) * rate;
        let h = of(1.0) / density(if is_first { 0.5 } else { 1.0 });
        let fails = Err(StepError::TimeScale { scale: scale.widen(), h: before.widen() });
        if !(scale > of(0.0) && scale.widen().is_finite()) {
            return fails;
        }
        crate::step::require_step_size(before)?;
        if !h.widen().is_finite() || (h > of(0.0)) != (before > of(0.0)) {
            return fails;
        }
        if parameter_step == of(0.0) {
            parameter_step = of(1.0) / (scale * density(0.5));
        }
        if at.steps == 1 {
            // What rounding took from origin + h (D. E. Knuth's sum of two).
            let h = at.step_size.widen();
            let part = time - at.origin;
            rest += (at.origin - (time - part)) + (h - part);
        }
        let origin = time + rest;
        rest -= origin - time;
        self.before = (self.course, at.step_size, at.origin, at.steps);
        self.course = Course { parameter_step, is_first: false, rest };
        *at = Checkpoint { state: at.state, step_size: h, origin, steps: 0 };
        Ok(())
    }

    /// Forgets what rounding took, as a run that is resumed has to.
    pub(super) fn forget(&mut self) {
        self.course.rest = 0.0;
    }

    /// Takes back what [`next`](Self::next) did: the step was not taken.
    pub(super) fn undo(&mut self, at: &mut Checkpoint<L::Scalar, N>) {
        let (course, step_size, origin, steps) = self.before;
        self.course = course;
        *at = Checkpoint { state: at.state, step_size, origin, steps };
    }
}
