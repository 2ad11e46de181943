//! The discrete system: L_d, f_d, the Legendre transforms, and the equation of its step.
//!
//! Paper, section 3, with the signs and corrections of the crate documentation:
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻   (minus)        p1 = D2 L_d + f_d⁺   (plus)
//! D2 L_d(q0, q1) + f_d⁺(q0, q1) + D1 L_d(q1, q2) + f_d⁻(q1, q2) = 0
//! ```

use nalgebra::SVector;

use crate::step::cause::{cause_of, explained};
use crate::step::{DiscreteObjects, EquationAt, Flow, Segment, State, Step, StepError};
use crate::system::{Engine, GeneratedDiffers, NoDerivative, verification::verify_node};

/// A system discretised by rule `R`: the discrete objects on its segments.
///
/// Of a system whose rule is listed the runtime makes it, from the step that `#[rayleigh_system]` writes
/// ([`Fused`](crate::rules::Fused)) and the formulas of the rule
/// ([`ClosedForm`](crate::step::ClosedForm)), or from the stages of a Gauss rule. How the step's equation is
/// solved, [`Flow`] says: for a rule of one's own that is
/// [`SolvedForVelocity`](crate::rules::SolvedForVelocity), the runtime does.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not discretised by `{R}`",
    label = "no discrete system by `{R}`",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "otherwise list the rule in the attribute: `#[rayleigh_system(rule = [midpoint, trapezoidal])]`"
)]
pub trait Discrete<R, const N: usize>: Flow<R, N> {
    /// The discrete objects on a segment.
    type On<'a>: DiscreteObjects<Self::Scalar, N>
    where
        Self: 'a;

    /// Whether the rule has points between q0 and q1, eliminated by the forced equations.
    const HAS_INTERIOR_POINTS: bool = false;

    /// The discrete objects on `segment`: by formula, always.
    ///
    /// # Errors
    /// Of a rule that solves for points within the segment, the [`StepError`] that says why it finds none.
    fn on<'a>(&'a self, segment: &Segment<Self::Scalar, N>) -> Result<Self::On<'a>, StepError>;

    /// Calls `visit` with (q, v) at each point where the rule evaluates the system on the segment, and with
    /// the system as it is then.
    ///
    /// Asked for by what looks at a segment from outside: [`verify_segment`](Self::verify_segment), and the
    /// errors of derivatives that do not exist.
    #[expect(clippy::type_complexity, reason = "a visitor, in full: an alias would hide its lifetime")]
    fn at_nodes(
        &self,
        segment: &Segment<Self::Scalar, N>,
        visit: &mut dyn FnMut(&Self, &SVector<Self::Scalar, N>, &SVector<Self::Scalar, N>),
    );

    /// The first derivative of L, R or f that is NaN or infinite where the rule evaluates it on the segment:
    /// [`Lagrangian::without_derivative`](crate::Lagrangian::without_derivative) at the nodes.
    #[cold]
    fn without_derivative_on(&self, segment: &Segment<Self::Scalar, N>) -> Option<NoDerivative> {
        let mut found = None;
        self.at_nodes(segment, &mut |system, q, v| {
            if found.is_none() {
                found = system.without_derivative(q, v);
            }
        });
        found
    }

    /// Compares L, R and f as generated to those as written
    /// ([`Lagrangian::verify_generated`](crate::Lagrangian::verify_generated)) at the points
    /// where the rule evaluates them on the segment.
    ///
    /// With `debug_assertions` every step does so; without them the caller has to.
    ///
    /// # Errors
    /// [`GeneratedDiffers`].
    fn verify_segment(&self, segment: &Segment<Self::Scalar, N>) -> Result<(), GeneratedDiffers> {
        let mut verified = Ok(());
        if !matches!(Self::STRUCTURE.engine, Engine::Expanded) {
            return verified;
        }
        self.at_nodes(segment, &mut |system, q, v| {
            verified = verified.and_then(|()| verify_node(system, q, v));
        });
        verified
    }

    /// The step's equation at a step that was taken, and whether the determinant of the equations that were
    /// solved for it has the sign that it has for small h: no fold, or an even number of them, lies
    /// between. What a [`Certificate`](crate::derivative::Certificate) is made of.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if derivatives at the step are not finite; those of a step, for rules that
    /// solve for stages again.
    fn equation_at(
        &self,
        state: &State<Self::Scalar, N>,
        step: &Step<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<EquationAt<Self::Scalar, N>, StepError>;
}

/// The `error`, if it is one of derivatives that are not finite, with what lacks one on the segment in place
/// of it.
#[cfg_attr(feature = "std", cold)]
#[cfg_attr(not(feature = "std"), inline(always))]
pub(crate) fn explained_on<L: Discrete<R, N> + ?Sized, R, const N: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
    error: StepError,
) -> StepError {
    explained(error, &|| cause_of(system, system.without_derivative_on(segment)))
}
