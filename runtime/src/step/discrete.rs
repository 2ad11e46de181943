//! The discrete system: L_d, f_d, the Legendre transforms and the flows.
//!
//! Paper, section 3, with the signs and corrections of the crate documentation:
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻   (minus)        p1 = D2 L_d + f_d⁺   (plus)
//! D2 L_d(q0, q1) + f_d⁺(q0, q1) + D1 L_d(q1, q2) + f_d⁻(q1, q2) = 0
//! ```

use nalgebra::SVector;

use crate::numbers::{Derivatives, NewtonMatrix, Scalar, determinant_sign};
use crate::step::{
    BoundedStep, DiscreteForce, DiscreteForceDerivatives, EquationAt, LegendreDerivatives, Linearization,
    Momenta, Quantity, State, Step, StepError, StepKernel, StepWith, newton::Equation, require_step_size,
    step_by, step_within_by,
};
use crate::system::{GeneratedDiffers, Lagrangian};

/// A system discretised by rule `R`: L_d, f_d and what follows from them.
///
/// The required functions are what `#[rayleigh_system]` writes; the provided ones hold for every system and
/// rule.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not discretised by `{R}`",
    label = "no discrete system by `{R}`",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "otherwise list the rule in the attribute: `#[rayleigh_system(rule = [midpoint, trapezoidal])]`"
)]
pub trait Discrete<R, const N: usize>: Lagrangian<N> {
    /// The form of the Newton matrix: `SMatrix<Scalar, N, N>`, or [`Banded`](crate::step::Banded).
    type Matrix: NewtonMatrix<Self::Scalar, N>;

    /// What a run of steps keeps from one to the next: [`VelocityHistory`](crate::run::VelocityHistory),
    /// unless the rule has something better.
    type Memory: Memory<Self, R, N>;

    /// Whether the step's equation is linear in v̄, so that one correction solves it.
    const LINEAR: bool = false;

    /// L_d(q0, q1, h).
    fn discrete_lagrangian(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Self::Scalar;

    /// L_d with D1, D2, D11, D12, D22.
    fn discrete_lagrangian_derivatives(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Derivatives<Self::Scalar, N>;

    /// The step's equation and Newton matrix at the trial mean velocity `v`.
    fn step_kernel(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> StepKernel<Self::Scalar, N, Self::Matrix>;

    /// Both momenta of the segment from q0 with mean velocity `v`.
    fn momenta(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Momenta<Self::Scalar, N>;

    /// Energy on the segment: E_L at the points and velocity that the rule sees.
    fn segment_energy(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Self::Scalar;

    /// f_d = (f_d⁻, f_d⁺), of the Rayleigh function and the general force together; 0 where the system has
    /// neither.
    #[inline]
    fn discrete_force(
        &self,
        _q0: &SVector<Self::Scalar, N>,
        _q1: &SVector<Self::Scalar, N>,
        _h: Self::Scalar,
    ) -> DiscreteForce<Self::Scalar, N> {
        DiscreteForce::zero()
    }

    /// f_d with its derivatives by q0 and q1.
    #[inline]
    fn discrete_force_derivatives(
        &self,
        _q0: &SVector<Self::Scalar, N>,
        _q1: &SVector<Self::Scalar, N>,
        _h: Self::Scalar,
    ) -> DiscreteForceDerivatives<Self::Scalar, N> {
        DiscreteForceDerivatives::zero()
    }

    /// f_d⁻(q0, q1), a covector at q0.
    #[inline]
    fn force_minus(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> SVector<Self::Scalar, N> {
        self.discrete_force(q0, q1, h).minus
    }

    /// f_d⁺(q0, q1), a covector at q1.
    #[inline]
    fn force_plus(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> SVector<Self::Scalar, N> {
        self.discrete_force(q0, q1, h).plus
    }

    /// 𝔽⁻: (q0, q1) ↦ (q0, −D1 L_d − f_d⁻).
    #[inline]
    fn legendre_minus(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> State<Self::Scalar, N> {
        State { q: *q0, p: self.momenta(q0, &((q1 - q0) / h), h).p0 }
    }

    /// 𝔽⁺: (q0, q1) ↦ (q1, D2 L_d + f_d⁺).
    #[inline]
    fn legendre_plus(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> State<Self::Scalar, N> {
        State { q: *q1, p: self.momenta(q0, &((q1 - q0) / h), h).p1 }
    }

    /// Left side of the forced discrete Euler–Lagrange equation at q1, 0 along solutions:
    /// D2 L_d(q0, q1) + f_d⁺(q0, q1) + D1 L_d(q1, q2) + f_d⁻(q1, q2).
    ///
    /// Of a system at a time t, a view, the second segment is that of t + h.
    #[inline]
    fn del_residual(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        q2: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> SVector<Self::Scalar, N>
    where
        Self: Sized,
    {
        self.legendre_plus(q0, q1, h).p - self.later(h, |system| system.legendre_minus(q1, q2, h).p)
    }

    /// The flow on T*Q: solves p0 = −D1 L_d − f_d⁻ for q1, then p1 = D2 L_d + f_d⁺.
    ///
    /// `guess` is a guess for v̄ = (q1 − q0)/h; a [`Trajectory`](crate::Trajectory) extrapolates one. Without
    /// it Newton's method starts at the velocity of the state, and ∂²L/∂v² is checked to be invertible;
    /// where that leads nowhere, it starts again at rest, away from it if rest is a singular point, and
    /// at last follows the root from small step sizes. h may be negative. Neither allocates nor panics
    /// (unless L, R or f do), and takes at most a fixed number of iterations.
    ///
    /// # Errors
    /// A [`StepError`]; the state given is untouched.
    #[inline]
    fn step(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
    ) -> Result<Step<Self::Scalar, N>, StepError> {
        let kind = if Self::LINEAR { Equation::Linear } else { Equation::General };
        let equation = (
            |q0: &_, v: &_, h| self.step_kernel(q0, v, h),
            |q0: &_, v: &_, h| self.momenta(q0, v, h),
            |q0: &_, v: &_| self.lagrangian_derivatives(q0, v).d22,
        );
        let step = step_by(self, kind, equation, state, h, guess);
        if cfg!(debug_assertions)
            && let Ok(step) = &step
        {
            self.verify_segment(&state.q, &step.velocity, h)?;
        }
        step
    }

    /// The step by at most `iterations` undamped Newton iterations, for a clock that does not wait: the work
    /// is bounded, and what is returned is the best iterate, with the residual left and the last
    /// correction in its report. Without a `guess` the velocity of the state is solved for first.
    ///
    /// # Errors
    /// [`StepError`] where not even one iteration can be made; the state given is untouched.
    fn step_within(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<Self::Scalar, N>, StepError> {
        let kind = if Self::LINEAR { Equation::Linear } else { Equation::General };
        let bounded = step_within_by(
            self,
            kind,
            |q0, v| self.step_kernel(q0, v, h),
            |q0, v| self.momenta(q0, v, h),
            state,
            h,
            guess,
            iterations,
        );
        if cfg!(debug_assertions)
            && let Ok(bounded) = &bounded
        {
            self.verify_segment(&state.q, &bounded.step.velocity, h)?;
        }
        bounded
    }

    /// Compares L, R and f as generated to those as written ([`Lagrangian::verify_generated`]) at the points
    /// where the rule evaluates them on the segment from q0 with mean velocity `v`.
    ///
    /// With `debug_assertions` every step does so; without them the caller has to.
    ///
    /// # Errors
    /// [`GeneratedDiffers`].
    fn verify_segment(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<(), GeneratedDiffers> {
        let _ = (q0, v, h);
        Ok(())
    }

    /// Both momenta of the segment (`q0`, `q1`) with their derivatives by the two.
    fn legendre_derivatives(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> LegendreDerivatives<Self::Scalar, N> {
        let l = self.discrete_lagrangian_derivatives(q0, q1, h);
        LegendreDerivatives::from_terms(&l, &self.discrete_force_derivatives(q0, q1, h))
    }

    /// The step's equation at a step that was taken, and whether the determinant of the equations that were
    /// solved for it has the sign that it has for small h: no fold, or an even number of them, lies
    /// between. What a [`Certificate`](crate::derivative::Certificate) is made of.
    ///
    /// The only equation of a step is 𝔽⁻, unless the rule has others.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if derivatives at the step are not finite; those of a step, for rules that
    /// solve for stages again.
    fn equation_at(
        &self,
        state: &State<Self::Scalar, N>,
        step: &Step<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<EquationAt<Self::Scalar, N, Self::Matrix>, StepError> {
        let kernel = self.step_kernel(&state.q, &step.velocity, h);
        let mass = self.lagrangian_derivatives(&state.q, &step.velocity).d22;
        StepError::require_finite(&kernel.p0, Quantity::Derivatives)?;
        if let Some(index) = (0..N).find(|&i| !(kernel.matrix.row_is_finite(i) && mass.row_is_finite(i))) {
            return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
        }
        let signs = [determinant_sign(kernel.matrix.dense()), determinant_sign(mass)];
        Ok(EquationAt { kernel, mass, on_the_branch_of_the_flow: signs[0] == signs[1] && signs[0].is_ne() })
    }

    /// The step's derivative by its state on the segment (`q0`, `q1`):
    /// [`Discretised::linearization`](crate::Discretised::linearization).
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] if ∂p0/∂q1 is singular.
    fn linearization(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<Linearization<Self::Scalar, N>, StepError> {
        Linearization::from_legendre(&self.legendre_derivatives(q0, q1, h))
    }

    /// The step with its derivative by the state:
    /// [`Discretised::linearized_step`](crate::Discretised::linearized_step).
    ///
    /// # Errors
    /// Those of [`step`](Self::step) and of [`linearization`](Self::linearization).
    fn linearized_step(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
    ) -> Result<StepWith<Self::Scalar, N, Linearization<Self::Scalar, N>>, StepError> {
        let step = self.step(state, h, guess)?;
        Ok((step, self.linearization(&state.q, &step.state.q, h)?))
    }

    /// The flow on Q×Q: (q0, q1) ↦ (q1, q2), with q2 = `state.q` of the step returned.
    ///
    /// Of a system at a time t, a view, (q0, q1) is the segment of t, and the step is taken at t + h.
    ///
    /// # Errors
    /// Those of [`step`](Self::step).
    #[inline]
    fn step_configurations(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
    ) -> Result<Step<Self::Scalar, N>, StepError>
    where
        Self: Sized,
    {
        require_step_size(h)?;
        StepError::require_finite(q0, Quantity::Configuration)?;
        let state = self.legendre_plus(q0, q1, h);
        self.later(h, |system| system.step(&state, h, guess))
    }
}

/// What a run keeps from step to step, and how the next step uses it.
///
/// [`Default`] is the memory before the first step. What is remembered makes a step cheaper; it never decides
/// where the step leads, beyond rounding: a memory of other states or another step size does no harm.
pub trait Memory<L: ?Sized, R, const N: usize>: Default
where
    L: Discrete<R, N>,
{
    /// The step of [`Discrete::step`] from `state`.
    ///
    /// # Errors
    /// Those of [`Discrete::step`]; what is remembered is then as before.
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError>;

    /// Takes over what is known of the state from which the next step starts, from the memory of the step
    /// that ended there. In a composition that is the one of the substep before.
    fn follow(&mut self, _previous: &Self) {}

    /// The step from `state`, `elapsed` after the time of `system`: of the system as it is then
    /// ([`Lagrangian::later`](crate::Lagrangian::later)).
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance).
    #[inline]
    fn advance_later(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError>
    where
        L: Sized,
    {
        system.later(L::Scalar::constant(elapsed), |system| self.advance(system, state, h))
    }
}
