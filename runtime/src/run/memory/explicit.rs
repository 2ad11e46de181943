//! Explicit steps: Störmer–Verlet with linear damping.
//!
//! ```text
//! P = ∂²L/∂v² + (h/2) ∂²R/∂v²,   G(q) = ∂L/∂q + f
//! P v̄ = p0 + (h/2) G(q0),   q1 = q0 + h v̄,   p1 = ∂L/∂v(v̄) − (h/2) ∂R/∂v(v̄) + (h/2) G(q1)
//! ```
//!
//! P depends on h alone and is factored once; G(q1) is the next step's G(q0). So a step costs one gradient;
//! where the force takes the time, two: the next step's clock starts at a rounding of its own.

use nalgebra::SVector;

use crate::numbers::{Factored, NewtonMatrix, Scalar};
use crate::rules::Trapezoidal;
use crate::step::{
    ClosedForm, Discrete, Flow, Memory, Momenta, Report, Segment, State, Step, StepError,
    newton::{estimated_floor, held_against},
    verify_momenta,
};
use crate::system::{ActingForce, GeneratedDiffers};

/// A system that the trapezoidal rule steps explicitly: L = T(v) − V(q, t) with T quadratic, R quadratic in
/// v, both with constant coefficients, and a force f(q, t).
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no explicit steps",
    label = "the equations of `{Self}` are not known to be explicit",
    note = "list the rule, `#[rayleigh_system(rule = trapezoidal)]`; L has to be ½vᵀMv − V(q, t) with constant M, R quadratic in v with constant coefficients, a force a function of q and t alone, and their derivatives written out: `derivatives = expanded` says what is in the way"
)]
pub trait Explicit<const N: usize>:
    ClosedForm<Trapezoidal, N> + Discrete<Trapezoidal, N> + ActingForce<N>
{
    /// P = ∂²L/∂v² + (h/2) ∂²R/∂v², the Newton matrix.
    fn step_matrix(&self, h: Self::Scalar) -> Self::Matrix;

    /// The velocity's part in the momenta: ∂L/∂v ± (h/2) ∂R/∂v.
    fn velocity_momenta(&self, v: &SVector<Self::Scalar, N>, h: Self::Scalar) -> Momenta<Self::Scalar, N>;

    /// G(q) = ∂L/∂q + f, now.
    fn configuration_force(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, N>;
}

/// Verifies both momenta of an explicit step against the derivatives of L_d and f_d.
pub(in crate::run) fn verify_explicit<L: Explicit<N>, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
) -> Result<(), GeneratedDiffers> {
    verify_momenta::<L, Trapezoidal, N>(system, state, h, &|Segment { q0, v, .. }| {
        let (mut momenta, mut q1) = (system.velocity_momenta(v, h), *q0);
        for i in 0..N {
            q1[i] += h * v[i];
        }
        let at_end = system.later(h, |system| system.configuration_force(&q1));
        let (at_start, half) = (system.configuration_force(q0), h * L::Scalar::constant(0.5));
        for i in 0..N {
            momenta.p0[i] -= half * at_start[i];
            momenta.p1[i] += half * at_end[i];
        }
        [momenta; 2]
    })
}

/// The factors of P, and the force at the end of the last step. It belongs to one system.
#[derive(Clone, Copy, Debug)]
pub struct ExplicitMemory<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> {
    prepared: Option<Prepared<S, M, N>>,
    /// A configuration, and G there.
    force: Option<(SVector<S, N>, SVector<S, N>)>,
    /// Whether G has to be evaluated anew, where the next step starts.
    is_another: bool,
}

/// A step size, and the values that depend on it alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prepared<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> {
    pub(super) h: S,
    matrix: M,
    factored: M::Factored,
    /// ∂L/∂v + (h/2) ∂R/∂v at v̄ = 0.
    at_rest: SVector<S, N>,
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Default for ExplicitMemory<S, M, N> {
    fn default() -> Self {
        Self { prepared: None, force: None, is_another: false }
    }
}

impl<L, const N: usize> Memory<L, Trapezoidal, N> for ExplicitMemory<L::Scalar, L::Matrix, N>
where
    L: Explicit<N>,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let force = match &self.force {
            Some(_) if self.is_another || L::IS_TIMED => Some(system.configuration_force(&state.q)),
            Some((q, force)) if *q == state.q => Some(*force),
            _ => None,
        };
        if let Some(prepared) = &self.prepared
            && prepared.h == h
            && let Some(force) = &force
            && let Some((step, force)) = prepared.step(
                |q| system.later(h, |system| system.configuration_force(q)),
                |v| system.velocity_momenta(v, h),
                state,
                force,
            )
        {
            if cfg!(debug_assertions) {
                system.verify_segment(&Segment { q0: state.q, v: step.velocity, h })?;
            }
            self.force = Some((step.state.q, force));
            self.is_another = false;
            return Ok(step);
        }
        self.start(system, state, h)
    }

    fn verify_momenta(system: &L, state: &State<L::Scalar, N>, h: L::Scalar) -> Result<(), GeneratedDiffers> {
        Flow::<Trapezoidal, N>::verify_momenta(system, state, h)?;
        verify_explicit(system, state, h)
    }

    /// The force.
    #[inline]
    fn follow(&mut self, previous: &Self) {
        (self.force, self.is_another) = (previous.force, previous.is_another);
    }

    fn change_input(&mut self) {
        self.is_another = true;
    }

    fn change_state(&mut self) {
        self.is_another = true;
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> ExplicitMemory<S, M, N> {
    /// The first step with this step size or from this state, by the general path, which has the verdicts.
    #[cold]
    #[inline(never)]
    fn start<L>(&mut self, system: &L, state: &State<S, N>, h: S) -> Result<Step<S, N>, StepError>
    where
        L: Explicit<N, Scalar = S, Matrix = M>,
    {
        let step = Flow::<Trapezoidal, N>::step(system, state, h, None)?;
        if self.prepared.as_ref().is_none_or(|prepared| prepared.h != h) {
            let at_rest = system.velocity_momenta(&nalgebra::zero(), h).p0;
            self.prepared = Prepared::new(h, system.step_matrix(h), at_rest);
        }
        self.force = Some((step.state.q, system.configuration_force(&step.state.q)));
        self.is_another = false;
        Ok(step)
    }
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Prepared<S, M, N> {
    /// Factors the matrix of the step size `h`; `None` where it cannot be factored.
    pub(super) fn new(h: S, matrix: M, at_rest: SVector<S, N>) -> Option<Self> {
        matrix.factored().map(|factored| Self { h, matrix, factored, at_rest })
    }

    /// The step, and G at its end; nothing where a number is none or the residual is above its floor.
    /// `configuration_force` is G, `force` its value at the start; `velocity_momenta` is what the
    /// velocity adds to the momenta.
    #[inline]
    pub(super) fn step(
        &self,
        configuration_force: impl Fn(&SVector<S, N>) -> SVector<S, N>,
        velocity_momenta: impl Fn(&SVector<S, N>) -> Momenta<S, N>,
        state: &State<S, N>,
        force: &SVector<S, N>,
    ) -> Option<(Step<S, N>, SVector<S, N>)> {
        let half = self.h * S::constant(0.5);
        let kick = force * half;
        let right = state.p + kick;
        let v = self.factored.solve(&(right - self.at_rest));
        let q = state.q + v * self.h;
        let force = configuration_force(&q);
        let Momenta { p0, p1 } = velocity_momenta(&v);
        let end = State { q, p: state.p + (kick + force * half + (p1 - p0)) };

        let residual = p0 - right;
        let floor = estimated_floor(&state.p, &self.matrix, &v);
        let (residual, floor, is_root) = held_against(&residual, &floor);
        if !is_root {
            return None;
        }
        end.require_finite().ok()?;
        let report = Report { iterations: 1, damped: 0, residual, floor, last_correction: v.amax() };
        Some((Step { state: end, velocity: v, report }, force))
    }
}
