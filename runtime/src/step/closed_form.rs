//! Systems whose discrete objects are formulas on a segment: nothing within it has to be solved for.

use core::marker::PhantomData;

use nalgebra::SVector;

use crate::numbers::NewtonMatrix;
use crate::numbers::{Derivatives, determinant_sign};
use crate::step::discrete::explained_on;
use crate::step::massless::inertia;
use crate::step::{
    Discrete, DiscreteForce, DiscreteForceDerivatives, DiscreteObjects, EquationAt, Flow, Fused, Momenta,
    Segment, State, Step, StepError,
};
use crate::system::Quantity;

/// A system whose discrete objects by rule `R` are formulas on a segment: L_d and f_d, with their
/// derivatives.
///
/// Of a system whose rule is listed the runtime makes them, by the formulas of the rule. A rule of one's own
/// that is not given by nodes and weights has them by hand.
///
/// [`Gauss`](crate::Gauss) rules are not of this kind: their discrete objects are asked of
/// [`segment`](crate::Discretised::segment), which may fail.
///
/// ```compile_fail
/// use dalembert::{Discretise, Gauss, nalgebra::vector, rayleigh_system};
/// #[rayleigh_system(rule = gauss)]
/// fn free(q: [f64; 1], v: [f64; 1]) -> f64 {
///     0.5 * v[0] * v[0] - 0.0 * q[0]
/// }
/// let _ = Free {}.by(Gauss::<2>, 0.1).discrete_lagrangian(&vector![0.0], &vector![0.1]);
/// ```
#[diagnostic::on_unimplemented(
    message = "the discrete objects of `{Self}` by `{R}` have to be solved for",
    label = "no formula in (q0, q1)",
    note = "ask the segment for them, which may have no solution: `by.segment(&q0, &q1)?`"
)]
pub trait ClosedForm<R, const N: usize>: Fused<R, N> {
    /// L_d(q0, q1, h).
    fn discrete_lagrangian(&self, segment: &Segment<Self::Scalar, N>) -> Self::Scalar;

    /// L_d with D1, D2, D11, D12, D22.
    fn discrete_lagrangian_derivatives(
        &self,
        segment: &Segment<Self::Scalar, N>,
    ) -> Derivatives<Self::Scalar, N>;

    /// Energy on the segment: E_L at the points and velocity that the rule sees.
    fn segment_energy(&self, segment: &Segment<Self::Scalar, N>) -> Self::Scalar;

    /// f_d = (f_d⁻, f_d⁺), of the Rayleigh function and the general force together; 0 where the system has
    /// neither.
    #[inline]
    fn discrete_force(&self, segment: &Segment<Self::Scalar, N>) -> DiscreteForce<Self::Scalar, N> {
        let _ = segment;
        DiscreteForce::zero()
    }

    /// f_d with its derivatives by q0 and q1.
    #[inline]
    fn discrete_force_derivatives(
        &self,
        segment: &Segment<Self::Scalar, N>,
    ) -> DiscreteForceDerivatives<Self::Scalar, N> {
        let _ = segment;
        DiscreteForceDerivatives::zero()
    }

    /// Calls `visit` with (q, v) at each point where the rule evaluates the system on the segment, and with
    /// the system as it is then: [`Discrete::at_nodes`]. A system written by hand may leave it out.
    #[expect(clippy::type_complexity, reason = "a visitor, in full: an alias would hide its lifetime")]
    fn at_nodes(
        &self,
        segment: &Segment<Self::Scalar, N>,
        visit: &mut dyn FnMut(&Self, &SVector<Self::Scalar, N>, &SVector<Self::Scalar, N>),
    ) {
        let _ = (segment, visit);
    }
}

/// A rule by which systems may be [`ClosedForm`]: any but those that solve for points within a segment.
pub trait ByFormula {}

/// The formulas of a system by rule `R` on a segment.
pub struct Formulas<'a, L: Fused<R, N> + ?Sized, R, const N: usize> {
    pub(crate) system: &'a L,
    segment: Segment<L::Scalar, N>,
    rule: PhantomData<fn() -> R>,
}

impl<L: ClosedForm<R, N> + ?Sized, R, const N: usize> DiscreteObjects<L::Scalar, N>
    for Formulas<'_, L, R, N>
{
    fn segment(&self) -> &Segment<L::Scalar, N> {
        &self.segment
    }

    fn discrete_lagrangian(&self) -> L::Scalar {
        self.system.discrete_lagrangian(&self.segment)
    }

    fn discrete_lagrangian_derivatives(&self) -> Result<Derivatives<L::Scalar, N>, StepError> {
        Ok(self.system.discrete_lagrangian_derivatives(&self.segment))
    }

    fn discrete_force(&self) -> Result<DiscreteForce<L::Scalar, N>, StepError> {
        Ok(self.system.discrete_force(&self.segment))
    }

    fn discrete_force_derivatives(&self) -> Result<DiscreteForceDerivatives<L::Scalar, N>, StepError> {
        Ok(self.system.discrete_force_derivatives(&self.segment))
    }

    fn momenta(&self) -> Momenta<L::Scalar, N> {
        self.system.momenta(&self.segment)
    }

    fn energy(&self) -> L::Scalar {
        self.system.segment_energy(&self.segment)
    }
}

impl<L, R, const N: usize> Discrete<R, N> for L
where
    L: ClosedForm<R, N> + Flow<R, N> + ?Sized,
    R: ByFormula,
{
    type On<'a>
        = Formulas<'a, L, R, N>
    where
        L: 'a;

    fn on<'a>(&'a self, segment: &Segment<L::Scalar, N>) -> Result<Formulas<'a, L, R, N>, StepError> {
        Ok(Formulas { system: self, segment: *segment, rule: PhantomData })
    }

    fn at_nodes(
        &self,
        segment: &Segment<L::Scalar, N>,
        visit: &mut dyn FnMut(&L, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        ClosedForm::at_nodes(self, segment, visit);
    }

    /// 𝔽⁻ is the only equation of the step.
    fn equation_at(
        &self,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<EquationAt<L::Scalar, N>, StepError> {
        const {
            assert!(!L::IS_CONSTRAINED, "steps on constraints have no certificate");
            assert!(
                !L::STRUCTURE.is_held_by_friction(),
                "steps with friction that holds have no certificate"
            );
        }
        let segment = Segment { q0: state.q, v: step.velocity, h };
        let kernel = self.step_kernel(&segment);
        let mass = inertia(self, &state.q, &step.velocity, h);
        let explained = |error| explained_on::<L, R, N>(self, &segment, error);
        StepError::require_finite(&kernel.p0, Quantity::Derivatives).map_err(explained)?;
        if let Some(index) = (0..N).find(|&i| !(kernel.matrix.row_is_finite(i) && mass.row_is_finite(i))) {
            return Err(explained(StepError::NonFinite { quantity: Quantity::Derivatives, index }));
        }
        let (p0, matrix) = (kernel.p0, kernel.matrix.dense());
        let signs = [determinant_sign(matrix), determinant_sign(mass)];
        let on_the_branch_of_the_flow = signs[0] == signs[1] && signs[0].is_ne();
        Ok(EquationAt { p0, matrix, mass, on_the_branch_of_the_flow })
    }
}
