//! The discrete system: L_d, f_d, the Legendre transforms, and the equation of its step.
//!
//! Paper, section 3, with the signs and corrections of the crate documentation:
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻   (minus)        p1 = D2 L_d + f_d⁺   (plus)
//! D2 L_d(q0, q1) + f_d⁺(q0, q1) + D1 L_d(q1, q2) + f_d⁻(q1, q2) = 0
//! ```

use nalgebra::SVector;

use crate::numbers::{Derivatives, NewtonMatrix, determinant_sign};
use crate::step::cause::{cause_of, explained};
use crate::step::defect;
use crate::step::{
    Defect, DiscreteForce, DiscreteForceDerivatives, EquationAt, Flow, LegendreDerivatives, Linearization,
    Memory, Momenta, State, Step, StepError, StepKernel,
};
use crate::system::{
    Engine, GeneratedDiffers, NoDerivative, Quantity, VectorField, verification::verify_node,
};

/// A system discretised by rule `R`: L_d, f_d and what follows from them.
///
/// Of a system whose rule is listed the runtime makes it, from the step that `#[rayleigh_system]` writes
/// ([`Fused`](crate::rules::Fused)) and the formulas of the rule. The provided functions hold for every
/// system and rule. How the step's equation is solved, [`Flow`] says: for a rule of one's own that is
/// [`SolvedForVelocity`](crate::rules::SolvedForVelocity), the runtime does.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not discretised by `{R}`",
    label = "no discrete system by `{R}`",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "otherwise list the rule in the attribute: `#[rayleigh_system(rule = [midpoint, trapezoidal])]`"
)]
pub trait Discrete<R, const N: usize>: Flow<R, N> {
    /// The form of the Newton matrix: `SMatrix<Scalar, N, N>`, or [`Banded`](crate::step::Banded).
    type Matrix: NewtonMatrix<Self::Scalar, N>;

    /// The memory of a run from step to step: [`VelocityHistory`](crate::run::VelocityHistory), unless the
    /// rule has something better.
    type Memory: Memory<Self, R, N>;

    /// Whether the step's equation is linear in v̄, so that one correction solves it, with a matrix that
    /// neither the state nor an input changes.
    const LINEAR: bool = false;

    /// Whether the step's equation and both momenta are written out each at once, as `#[rayleigh_system]`
    /// does: a run that starts then holds them against the derivatives of L_d and f_d.
    const WRITTEN_OUT: bool = false;

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

    /// Sizes of the terms that may cancel in p0, component by component: p0 as computed is off by ε times
    /// that, where last places of q0 and v̄ do not show it, as in (q − 1) + (q + 1) at rest.
    ///
    /// Generated where L, R or f have such terms; 0 otherwise. A step whose residual stops falling asks for
    /// it, no other.
    #[cold]
    fn cancelling_terms(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> SVector<Self::Scalar, N> {
        let _ = (q0, v, h);
        nalgebra::zero()
    }

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

    /// Whether the rule has points between q0 and q1, eliminated by the forced equations.
    const HAS_INTERIOR_POINTS: bool = false;

    /// The [`Defect`] of the segment along `xi`, and the sizes of the terms that each part is the sum of: NaN
    /// where one is lost to underflow.
    fn defect(
        &self,
        xi: &dyn VectorField<N, Scalar = Self::Scalar>,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> (Defect<Self::Scalar>, Defect<Self::Scalar>) {
        let l = self.discrete_lagrangian_derivatives(q0, q1, h);
        defect::at_the_ends(&l, &self.discrete_force(q0, q1, h), [&xi.vector(q0), &xi.vector(q1)])
    }

    /// Whether `xi` carries the force into itself: the components of ι_ξ df_d, with the sizes of their terms,
    /// handed to `component` one by one; at each stage those of ι_ξ df_L where the rule has interior points.
    fn force_contraction(
        &self,
        xi: &dyn VectorField<N, Scalar = Self::Scalar>,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
        component: &mut dyn FnMut(Self::Scalar, Self::Scalar),
    ) {
        let f = self.discrete_force_derivatives(q0, q1, h);
        defect::contraction(&f, [&xi.vector(q0), &xi.vector(q1)], component);
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

    /// Whether the rule has its discrete objects on the segment (`q0`, `q1`): by formula, always.
    ///
    /// # Errors
    /// Of a rule that solves for points within the segment, the [`StepError`] that says why it finds none;
    /// all objects are NaN there.
    fn require_segment(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<(), StepError> {
        let _ = (q0, q1, h);
        Ok(())
    }

    /// Calls `visit` with (q, v) at each point where the rule evaluates the system on the segment from q0
    /// with mean velocity `v`, and with the system as it is then.
    ///
    /// Asked for by what looks at a segment from outside: [`verify_segment`](Self::verify_segment), and the
    /// errors of derivatives that do not exist. A system written by hand may leave it out.
    #[expect(clippy::type_complexity, reason = "a visitor, in full: an alias would hide its lifetime")]
    fn at_nodes(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
        visit: &mut dyn FnMut(&Self, &SVector<Self::Scalar, N>, &SVector<Self::Scalar, N>),
    ) {
        let _ = (q0, v, h, visit);
    }

    /// The first derivative of L, R or f that is NaN or infinite where the rule evaluates it on the segment
    /// from q0 with mean velocity `v`:
    /// [`Lagrangian::without_derivative`](crate::Lagrangian::without_derivative) at the nodes.
    #[cold]
    fn without_derivative_on(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Option<NoDerivative> {
        let mut found = None;
        self.at_nodes(q0, v, h, &mut |system, q, v| {
            if found.is_none() {
                found = system.without_derivative(q, v);
            }
        });
        found
    }

    /// Compares L, R and f as generated to those as written
    /// ([`Lagrangian::verify_generated`](crate::Lagrangian::verify_generated)) at the points
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
        let mut verified = Ok(());
        if !matches!(Self::STRUCTURE.engine, Engine::Expanded) {
            return verified;
        }
        self.at_nodes(q0, v, h, &mut |system, q, v| {
            verified = verified.and_then(|()| verify_node(system, q, v));
        });
        verified
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
        let explained = |error| explained_on(self, &state.q, &step.velocity, h, error);
        StepError::require_finite(&kernel.p0, Quantity::Derivatives).map_err(explained)?;
        if let Some(index) = (0..N).find(|&i| !(kernel.matrix.row_is_finite(i) && mass.row_is_finite(i))) {
            return Err(explained(StepError::NonFinite { quantity: Quantity::Derivatives, index }));
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
            .map_err(|error| explained_on(self, q0, &((q1 - q0) / h), h, error))
    }
}

/// The `error`, if it is one of derivatives that are not finite, with what lacks one on the segment from q0
/// with mean velocity `v` in place of it.
#[cfg_attr(feature = "std", cold)]
#[cfg_attr(not(feature = "std"), inline(always))]
pub(crate) fn explained_on<L: Discrete<R, N> + ?Sized, R, const N: usize>(
    system: &L,
    q0: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    h: L::Scalar,
    error: StepError,
) -> StepError {
    explained(error, &|| cause_of(system, system.without_derivative_on(q0, v, h)))
}
