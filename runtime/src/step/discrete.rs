//! The discrete system: L_d, f_d, the Legendre transforms and the flows.
//!
//! Paper, section 3, with the signs and corrections of the crate documentation:
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻   (minus)        p1 = D2 L_d + f_d⁺   (plus)
//! D2 L_d(q0, q1) + f_d⁺(q0, q1) + D1 L_d(q1, q2) + f_d⁻(q1, q2) = 0
//! ```

use nalgebra::{SMatrix, SVector};

use crate::derivative::certificate::determinant_sign;
use crate::numbers::derivatives::linear;
use crate::step::error::{Quantity, StepError};
use crate::step::newton::{self, Equation, StepEquations};
use crate::step::state::require_regular;
use crate::{
    CovectorDerivatives, Derivatives, Lagrangian, LegendreDerivatives, Linearization, Memory, NewtonMatrix,
    Rayleigh, Scalar, State,
};

/// The discrete force f_d = (f_d⁻, f_d⁺): covectors at q0 and at q1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteForce<S, const N: usize> {
    /// f_d⁻(q0, q1), at q0.
    pub minus: SVector<S, N>,
    /// f_d⁺(q0, q1), at q1.
    pub plus: SVector<S, N>,
}

/// The discrete force with its derivatives by q0 (`d1`) and q1 (`d2`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteForceDerivatives<S, const N: usize> {
    /// f_d⁻, D1 f_d⁻, D2 f_d⁻.
    pub minus: CovectorDerivatives<S, N>,
    /// f_d⁺, D1 f_d⁺, D2 f_d⁺.
    pub plus: CovectorDerivatives<S, N>,
}

/// The step's equation at a trial v̄ = (q1 − q0)/h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepKernel<S, const N: usize, M = SMatrix<S, N, N>> {
    /// The momentum −D1 L_d − f_d⁻ at q0, to be matched with the state's.
    pub p0: SVector<S, N>,
    /// Newton matrix ∂p0/∂v̄ = −h (D2 D1 L_d + D2 f_d⁻).
    pub matrix: M,
}

/// Both momenta of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momenta<S, const N: usize> {
    /// −D1 L_d − f_d⁻, at q0.
    pub p0: SVector<S, N>,
    /// D2 L_d + f_d⁺, at q1.
    pub p1: SVector<S, N>,
}

linear!(DiscreteForce { minus, plus });
linear!(StepKernel { p0, matrix });
linear!(Momenta { p0, p1 });

impl<S: Scalar, const N: usize> DiscreteForceDerivatives<S, N> {
    /// Zero in every field.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        Self { minus: CovectorDerivatives::zero(), plus: CovectorDerivatives::zero() }
    }

    /// f_d⁻ = D1 R_d and f_d⁺ = −D2 R_d.
    #[inline]
    pub(crate) fn of_rayleigh(r: &Derivatives<S, N>) -> Self {
        Self {
            minus: CovectorDerivatives { value: r.d1, d1: r.d11, d2: r.d12 },
            plus: CovectorDerivatives { value: -r.d2, d1: -r.d12.transpose(), d2: -r.d22 },
        }
    }

    /// The derivatives of the R_d with this force, and its `value`.
    #[inline]
    pub(crate) fn as_of_rayleigh(&self, value: S) -> Derivatives<S, N> {
        let Self { minus, plus } = self;
        Derivatives { value, d1: minus.value, d2: -plus.value, d11: minus.d1, d12: minus.d2, d22: -plus.d2 }
    }
}

impl<S: Scalar, const N: usize> core::ops::Add for DiscreteForceDerivatives<S, N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { minus: self.minus + other.minus, plus: self.plus + other.plus }
    }
}

/// How a step went.
///
/// | question | answer |
/// |---|---|
/// | how much work | `iterations`, `damped` |
/// | how well the equation is solved | `residual` against `floor`: at most 4 floors, in every coordinate |
/// | what is left of v̄ | at most about the square of `last_correction`, relative to v̄ |
/// | how well it was posed: condition of the Newton matrix, branch of the root | on request, [`Discretised::certificate`](crate::Discretised::certificate), so that steps do not pay for it |
///
/// **A step is solved**, by every rule, with or without a memory, and with `converged` of [`BoundedStep`], where in each coordinate the
/// residual is at most 4 round-off floors; the floor is that of the solution returned, finite, and small beside the terms of the
/// equation. It is 4ε (|p| + Σ |J||v̄|) with the Newton matrix J, plus, where forces cancel, what the last places of q and v̄ do to
/// the residual, measured. The state returned then satisfies the rule's equations with q, v̄ and p changed by some units of their
/// last places. Whatever does not is an error; no step is taken on a residual that merely stopped falling.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report<S> {
    /// Corrections: of v̄ by Newton's method, or by a matrix kept; by Gauss rules of all stages at once, by fixed point or Newton's method.
    pub iterations: u32,
    /// Iterations whose Newton step had to be shortened.
    pub damped: u32,
    /// |𝔽⁻(q0, q1) − p0| at the solution, as evaluated there, of the coordinate where it is largest in units of its floor.
    pub residual: S,
    /// The round-off floor that this residual was held against, in units of the same momentum.
    pub floor: S,
    /// Largest entry of the last correction of v̄.
    pub last_correction: S,
}

/// A step taken: the new state, the mean velocity over the segment, and how the solver fared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S, const N: usize> {
    /// (q1, p1).
    pub state: State<S, N>,
    /// v̄ = (q1 − q0)/h, a good guess for the next step.
    pub velocity: SVector<S, N>,
    /// How the solver fared.
    pub report: Report<S>,
}

impl<S: Scalar, const N: usize> Step<S, N> {
    /// The step from `state` with mean velocity `velocity`, if it leads to finite numbers.
    #[inline(always)]
    pub(crate) fn completed(
        state: &State<S, N>,
        h: S,
        velocity: SVector<S, N>,
        momenta: &Momenta<S, N>,
        report: Report<S>,
    ) -> Result<Self, StepError> {
        // Added to the p0 given: the residual of the solver, always of one sign, would make it drift.
        let next = State { q: state.q + velocity * h, p: state.p + (momenta.p1 - momenta.p0) };
        next.require_finite()?;
        Ok(Self { state: next, velocity, report })
    }
}
/// A step, and derivatives of it.
pub type StepWith<S, const N: usize, D> = (Step<S, N>, D);

/// The equation of a step at the step that was taken; see [`Discrete::equation_at`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquationAt<S, const N: usize, M> {
    /// p0 and the Newton matrix.
    pub kernel: StepKernel<S, N, M>,
    /// ∂²L/∂v² at q0 and the mean velocity.
    pub mass: SMatrix<S, N, N>,
    /// Whether the determinant of the equations has the sign that it has for small h.
    pub on_the_branch_of_the_flow: bool,
}

/// A step by a bounded number of iterations: the best iterate, and whether it is the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundedStep<S, const N: usize> {
    /// The step of the best iterate; its report has the residual that is left and the last correction.
    pub step: Step<S, N>,
    /// Whether the residual is at its round-off floor, so that the step is that of [`Discrete::step`].
    pub converged: bool,
}

/// A system discretised by rule `R`: L_d, f_d and what follows from them.
///
/// The required functions are what `#[rayleigh_system]` writes; the provided ones hold for every system and rule.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not discretised by `{R}`",
    label = "no discrete system by `{R}`",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "otherwise list the rule in the attribute: `#[rayleigh_system(rule = [midpoint, trapezoidal])]`"
)]
pub trait Discrete<R, const N: usize>: Lagrangian<N> {
    /// The form of the Newton matrix: `SMatrix<Scalar, N, N>`, or [`Banded`](crate::Banded).
    type Matrix: NewtonMatrix<Self::Scalar, N>;

    /// What a run of steps keeps from one to the next: [`VelocityHistory`](crate::VelocityHistory), unless the rule has
    /// something better.
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

    /// f_d = (f_d⁻, f_d⁺), of the Rayleigh function and the general force together; 0 where the system has neither.
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
    /// `guess` is a guess for v̄ = (q1 − q0)/h; a [`Trajectory`](crate::Trajectory) extrapolates one. Without it Newton's
    /// method starts at the velocity of the state, and ∂²L/∂v² is checked to be invertible; where that leads nowhere, it starts
    /// again at rest, away from it if rest is a singular point, and at last follows the root from small step sizes. h may be negative. Neither allocates nor panics
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

    /// The step by at most `iterations` undamped Newton iterations, for a clock that does not wait: the work is bounded, and what is
    /// returned is the best iterate, with the residual left and the last correction in its report. Without a `guess` the velocity
    /// of the state is solved for first.
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

    /// Compares L, R and f as generated to those as written ([`Lagrangian::verify_generated`]) at the points where the rule
    /// evaluates them on the segment from q0 with mean velocity `v`.
    ///
    /// With `debug_assertions` every step does so; without them the caller has to.
    ///
    /// # Errors
    /// [`StepError::GeneratedDiffers`].
    fn verify_segment(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<(), StepError> {
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

    /// The step's equation at a step that was taken, and whether the determinant of the equations that were solved for it has the sign that
    /// it has for small h: no fold, or an even number of them, lies between. What a [`Certificate`](crate::Certificate) is made of.
    ///
    /// The only equation of a step is 𝔽⁻, unless the rule has others.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if derivatives at the step are not finite; those of a step, for rules that solve for stages again.
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

    /// The step's derivative by its state on the segment (`q0`, `q1`): [`Discretised::linearization`](crate::Discretised::linearization).
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

    /// The step with its derivative by the state: [`Discretised::linearized_step`](crate::Discretised::linearized_step).
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

/// A discrete Rayleigh system: f_d⁻ = D1 R_d, f_d⁺ = −D2 R_d, with L_d⁺ = L_d + R_d and L_d⁻ = L_d − R_d.
///
/// Plus goes with D1 and minus with D2: p0 = −D1 L_d⁺, p1 = D2 L_d⁻ (paper, section 3.3). Where the system has a general
/// force as well, these are the objects of the Rayleigh part alone.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no discrete Rayleigh function by `{R}`",
    label = "this needs R_d, and `{Self}` has none",
    note = "add `fn rayleigh(&self, v: [f64; {N}]) -> f64` to the `#[rayleigh_system]` block; `Discrete` holds all that exists without R"
)]
pub trait DiscreteRayleigh<R, const N: usize>: Discrete<R, N> + Rayleigh<N> {
    /// R_d(q0, q1, h).
    fn discrete_rayleigh(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Self::Scalar;

    /// R_d with D1, D2, D11, D12, D22.
    fn discrete_rayleigh_derivatives(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Derivatives<Self::Scalar, N>;

    /// L_d⁺ = L_d + R_d.
    #[inline]
    fn modified_plus(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Self::Scalar {
        self.discrete_lagrangian(q0, q1, h) + self.discrete_rayleigh(q0, q1, h)
    }

    /// L_d⁻ = L_d − R_d.
    #[inline]
    fn modified_minus(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Self::Scalar {
        self.discrete_lagrangian(q0, q1, h) - self.discrete_rayleigh(q0, q1, h)
    }

    /// L_d⁺ with D1, D2, D11, D12, D22.
    #[inline]
    fn modified_plus_derivatives(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Derivatives<Self::Scalar, N> {
        self.discrete_lagrangian_derivatives(q0, q1, h) + self.discrete_rayleigh_derivatives(q0, q1, h)
    }

    /// L_d⁻ with D1, D2, D11, D12, D22.
    #[inline]
    fn modified_minus_derivatives(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Derivatives<Self::Scalar, N> {
        self.discrete_lagrangian_derivatives(q0, q1, h)
            + self.discrete_rayleigh_derivatives(q0, q1, h) * -Self::Scalar::constant(1.0)
    }
}

/// [`Discrete::step`] with the step's equation and both momenta as functions of (q0, v̄, h), and the mass that the velocity has in them.
#[inline]
pub(crate) fn step_by<L, M, const N: usize>(
    system: &L,
    kind: Equation,
    (kernel, momenta, inertia): (
        impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>, L::Scalar) -> StepKernel<L::Scalar, N, M>,
        impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>, L::Scalar) -> Momenta<L::Scalar, N>,
        impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, N>,
    ),
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    guess: Option<&SVector<L::Scalar, N>>,
) -> Result<Step<L::Scalar, N>, StepError>
where
    L: Lagrangian<N> + ?Sized,
    M: NewtonMatrix<L::Scalar, N>,
{
    require_step_size(h)?;
    let start = match guess {
        Some(v) => *v,
        None => first_guess(system, kind, state)?,
    };
    let evaluate = |q: &_, v: &_| kernel(q, v, h);
    let finish = |q: &_, v: &_| momenta(q, v, h);
    let solution = match newton::quick(kind, &evaluate, &finish, state, start) {
        Ok(solution) => solution,
        Err(reached) => {
            let of = StepEquations { kernel: &kernel, momenta: &momenta, inertia: &inertia, state, h };
            newton::at_length(&of, start, guess.is_some(), reached)
                .map_err(|error| in_arguments(state, guess).unwrap_or(error))?
        }
    };
    // An argument that is not finite shows here or has failed above: none is looked at before.
    Step::completed(state, h, solution.unknown, &solution.momenta, solution.report)
        .map_err(|error| in_arguments(state, guess).unwrap_or(error))
}

/// The velocity of `state`; where none is found, rest: a step may lead on, as from p = 0 at a singular point of L. Rest as well where
/// the equation is linear: one correction leads from there to the root, with the least rounding.
#[cold]
#[inline(never)]
fn first_guess<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    kind: Equation,
    state: &State<L::Scalar, N>,
) -> Result<SVector<L::Scalar, N>, StepError> {
    let rest = nalgebra::zero();
    if kind == Equation::Linear {
        state.require_finite()?;
        return require_regular(&system.lagrangian_derivatives(&state.q, &rest).d22).map(|()| rest);
    }
    match state.velocity(system) {
        Ok(v) if StepError::require_finite(&v, Quantity::Velocity).is_ok() => Ok(v),
        Err(
            error @ (StepError::DegenerateLagrangian { .. }
            | StepError::NonFinite {
                quantity: Quantity::Configuration | Quantity::Momentum | Quantity::Derivatives,
                ..
            }),
        ) => Err(error),
        _ => Ok(rest),
    }
}

/// [`Discrete::step_within`], likewise.
#[expect(clippy::too_many_arguments, reason = "those of the step, and the number of iterations")]
pub(crate) fn step_within_by<L, M, const N: usize>(
    system: &L,
    kind: Equation,
    kernel: impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>) -> StepKernel<L::Scalar, N, M>,
    momenta: impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>) -> Momenta<L::Scalar, N>,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    guess: Option<&SVector<L::Scalar, N>>,
    iterations: u32,
) -> Result<BoundedStep<L::Scalar, N>, StepError>
where
    L: Lagrangian<N> + ?Sized,
    M: NewtonMatrix<L::Scalar, N>,
{
    require_step_size(h)?;
    state.require_finite()?;
    let guess = match guess {
        Some(v) => *v,
        None => first_guess(system, kind, state)?,
    };
    StepError::require_finite(&guess, Quantity::Velocity)?;
    let (solution, converged) = newton::bounded(kind, iterations, kernel, momenta, state, guess)?;
    let step = Step::completed(state, h, solution.unknown, &solution.momenta, solution.report)?;
    Ok(BoundedStep { step, converged })
}

/// The first argument that is not finite: the cause, where a step has failed.
#[cold]
fn in_arguments<S: Scalar, const N: usize>(
    state: &State<S, N>,
    guess: Option<&SVector<S, N>>,
) -> Option<StepError> {
    let of_guess = || guess.map_or(Ok(()), |v| StepError::require_finite(v, Quantity::Velocity));
    state.require_finite().and_then(|()| of_guess()).err()
}

#[inline]
pub(crate) fn require_step_size<S: Scalar>(h: S) -> Result<(), StepError> {
    if h.is_finite() && h != S::zero() { Ok(()) } else { Err(StepError::StepSize { h: h.widen() }) }
}
