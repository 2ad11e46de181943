//! The equation of a step by a rule, each side of it one function of L, R and f.

use nalgebra::SVector;

use crate::numbers::NewtonMatrix;
use crate::step::{Border, Memory, Momenta, Segment, StepKernel};
use crate::system::ActingForce;

/// The step of a system by rule `R`: its equation and both momenta, each one function of L, R and f.
///
/// `#[rayleigh_system]` writes it for each rule listed; [`Quadrature`](crate::rules::Quadrature) has it of
/// every system. The rest of [`Discrete`](crate::step::Discrete) follows from the formulas of the rule: L_d,
/// f_d, R_d and their derivatives. A system by hand implements this trait, with one term for each of L, R and
/// f where speed does not matter:
///
/// ```
/// use dalembert::nalgebra::{SMatrix, Vector1, vector};
/// use dalembert::rules::{DisplacementRule, Fused};
/// use dalembert::run::VelocityHistory;
/// use dalembert::step::{Free, Momenta, Segment, StepKernel};
/// use dalembert::system::{ActingForce, Derivatives};
/// use dalembert::{Discretise, Lagrangian, Midpoint};
///
/// struct Falling;
///
/// impl Lagrangian<1> for Falling {
///     type Scalar = f64;
///     fn lagrangian(&self, q: &Vector1<f64>, v: &Vector1<f64>) -> f64 {
///         0.5 * v[0] * v[0] - 9.81 * q[0]
///     }
///     fn lagrangian_derivatives(&self, q: &Vector1<f64>, v: &Vector1<f64>) -> Derivatives<f64, 1> {
///         let value = self.lagrangian(q, v);
///         Derivatives { value, d1: vector![-9.81], d2: *v, d22: SMatrix::identity(), ..Derivatives::zero() }
///     }
/// }
///
/// impl ActingForce<1> for Falling {}
///
/// impl Fused<Midpoint, 1> for Falling {
///     type Matrix = SMatrix<f64, 1, 1>;
///     type Memory = VelocityHistory<f64, 1>;
///     type Border = Free;
///     fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
///         Midpoint::lagrangian_kernel(self, segment)
///     }
///     fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
///         Midpoint::lagrangian_momenta(self, segment)
///     }
/// }
///
/// let by = Falling.by(Midpoint, 0.1);
/// let value = by.discrete_lagrangian(&vector![0.0], &vector![0.1]);
/// assert!((value - 0.1 * (0.5 - 9.81 * 0.05)).abs() < 1e-15);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not discretised by `{R}`",
    label = "no discrete system by `{R}`",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "otherwise list the rule in the attribute: `#[rayleigh_system(rule = [midpoint, trapezoidal])]`"
)]
pub trait Fused<R, const N: usize>: ActingForce<N> {
    /// The form of the Newton matrix: `SMatrix<Scalar, N, N>`, or [`Banded`](crate::step::Banded).
    type Matrix: NewtonMatrix<Self::Scalar, N>;

    /// The memory of a run from step to step: [`VelocityHistory`](crate::run::VelocityHistory), unless the
    /// rule has something better.
    type Memory: Memory<Self, R, N>;

    /// The border of the equation, what holds the motion beside L, R and f: [`Free`](crate::step::Free) of a
    /// system without constraints.
    type Border: Border<Self, R, N>;

    /// Whether the step's equation is linear in v̄, so that one correction solves it, with a matrix that
    /// neither the state nor an input changes.
    const LINEAR: bool = false;

    /// Whether equation and momenta are written out, as `#[rayleigh_system]` does: a run that starts then
    /// holds them against the derivatives of L_d and f_d.
    const WRITTEN_OUT: bool = false;

    /// p0 = −D1 L_d − f_d⁻ and the Newton matrix ∂p0/∂v̄.
    fn step_kernel(&self, segment: &Segment<Self::Scalar, N>) -> StepKernel<Self::Scalar, N, Self::Matrix>;

    /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
    fn momenta(&self, segment: &Segment<Self::Scalar, N>) -> Momenta<Self::Scalar, N>;

    /// Sizes of the terms that may cancel in p0, component by component: p0 as computed is off by ε times
    /// that, where last places of q0 and v̄ do not show it, as in (q − 1) + (q + 1) at rest.
    ///
    /// Generated where L, R or f have such terms; 0 otherwise. A step whose residual stops falling asks for
    /// it, no other.
    #[cold]
    fn cancelling_terms(&self, segment: &Segment<Self::Scalar, N>) -> SVector<Self::Scalar, N> {
        let _ = segment;
        nalgebra::zero()
    }
}
