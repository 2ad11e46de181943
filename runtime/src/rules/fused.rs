//! The discrete system of a step: from the equation of the step, which `#[rayleigh_system]` writes, and the
//! formulas of its rule all that [`Discrete`] holds.

use nalgebra::SVector;

use super::{DisplacementRule, Fitted, FittedTrapezoidal, JointRayleighRule, JointRule, OneSided};
use crate::numbers::{Derivatives, NewtonMatrix};
use crate::step::{
    Discrete, DiscreteDriven, DiscreteForce, DiscreteForceDerivatives, DiscreteParameters, DiscreteRayleigh,
    Memory, Momenta, MomentaBy, SolvedForVelocity, StepKernel,
};
use crate::system::{ActingForce, Driven, Parameters, Rayleigh};

/// The step of a system by rule `R`: its equation and both momenta, each one function of L, R and f.
///
/// `#[rayleigh_system]` writes it for each rule listed; [`Quadrature`](super::Quadrature) has it of every
/// system. The rest of [`Discrete`] follows from the formulas of the rule: L_d, f_d, R_d and their
/// derivatives. A system by hand implements this trait, with one term for each of L, R and f where speed does
/// not matter:
///
/// ```
/// use dalembert::nalgebra::{SMatrix, Vector1, vector};
/// use dalembert::rules::{DisplacementRule, Fused};
/// use dalembert::run::VelocityHistory;
/// use dalembert::step::{Momenta, StepKernel};
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
///     fn step_kernel(&self, q0: &Vector1<f64>, v: &Vector1<f64>, h: f64) -> StepKernel<f64, 1> {
///         Midpoint::lagrangian_kernel(self, q0, v, h)
///     }
///     fn momenta(&self, q0: &Vector1<f64>, v: &Vector1<f64>, h: f64) -> Momenta<f64, 1> {
///         Midpoint::lagrangian_momenta(self, q0, v, h)
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

    /// Whether the step's equation is linear in v̄: [`Discrete::LINEAR`].
    const LINEAR: bool = false;

    /// Whether equation and momenta are written out, as the attribute does: [`Discrete::WRITTEN_OUT`].
    const WRITTEN_OUT: bool = false;

    /// p0 = −D1 L_d − f_d⁻ at q1 = q0 + h `v`, and ∂p0/∂v̄.
    fn step_kernel(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> StepKernel<Self::Scalar, N, Self::Matrix>;

    /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺ at q1 = q0 + h `v`.
    fn momenta(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Momenta<Self::Scalar, N>;

    /// Sizes of the terms that may cancel in p0: [`Discrete::cancelling_terms`].
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
}

/// [`Discrete`] by a rule: the step as [`Fused`] has it, the rest by the `functions` of the rule.
macro_rules! discrete {
    ($(#[$doc:meta])* [$($of:tt)*] $rule:ty, $functions:path $(, $system:ident)?) => {
        $(#[$doc])*
        impl<$($of)* L, const N: usize> Discrete<$rule, N> for L
        where
            L: Fused<$rule, N> $(+ $system<N>)?,
        {
            type Matrix = <L as Fused<$rule, N>>::Matrix;
            type Memory = <L as Fused<$rule, N>>::Memory;
            const LINEAR: bool = <L as Fused<$rule, N>>::LINEAR;
            const WRITTEN_OUT: bool = <L as Fused<$rule, N>>::WRITTEN_OUT;

            #[inline]
            fn step_kernel(
                &self,
                q0: &SVector<L::Scalar, N>,
                v: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> StepKernel<L::Scalar, N, Self::Matrix> {
                Fused::step_kernel(self, q0, v, h)
            }

            #[inline]
            fn momenta(
                &self,
                q0: &SVector<L::Scalar, N>,
                v: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> Momenta<L::Scalar, N> {
                Fused::momenta(self, q0, v, h)
            }

            #[inline]
            fn cancelling_terms(
                &self,
                q0: &SVector<L::Scalar, N>,
                v: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> SVector<L::Scalar, N> {
                Fused::cancelling_terms(self, q0, v, h)
            }

            fn discrete_lagrangian(
                &self,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> L::Scalar {
                <$rule as $functions>::discrete_lagrangian(self, q0, q1, h)
            }

            fn discrete_lagrangian_derivatives(
                &self,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> Derivatives<L::Scalar, N> {
                <$rule as $functions>::discrete_lagrangian_derivatives(self, q0, q1, h)
            }

            fn discrete_force(
                &self,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> DiscreteForce<L::Scalar, N> {
                <$rule as $functions>::discrete_force(self, q0, q1, h)
            }

            fn discrete_force_derivatives(
                &self,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> DiscreteForceDerivatives<L::Scalar, N> {
                <$rule as $functions>::discrete_force_derivatives(self, q0, q1, h)
            }

            fn segment_energy(
                &self,
                q0: &SVector<L::Scalar, N>,
                q1: &SVector<L::Scalar, N>,
                h: L::Scalar,
            ) -> L::Scalar {
                <$rule as $functions>::segment_energy(self, q0, q1, h)
            }

            fn at_nodes(
                &self,
                q0: &SVector<L::Scalar, N>,
                v: &SVector<L::Scalar, N>,
                h: L::Scalar,
                visit: &mut dyn FnMut(&Self, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
            ) {
                <$rule as $functions>::at_nodes(self, q0, v, h, visit);
            }
        }
    };
}

discrete! {
    /// By nodes and weights.
    [R: DisplacementRule + SolvedForVelocity,] R, DisplacementRule
}
discrete! { [] Fitted, JointRule, Rayleigh }
discrete! { [] FittedTrapezoidal, JointRule, Rayleigh }
discrete! { [] OneSided, JointRule, Rayleigh }

/// [`DiscreteRayleigh`] by the `functions` of the rule, for N coordinates, or for so many.
macro_rules! discrete_rayleigh {
    ([$($of:tt)*] $rule:ty, $n:tt, $functions:path) => {
        impl<$($of)*> DiscreteRayleigh<$rule, $n> for L
        where
            L: Fused<$rule, $n> + Rayleigh<$n>,
        {
            fn discrete_rayleigh(
                &self,
                q0: &SVector<L::Scalar, $n>,
                q1: &SVector<L::Scalar, $n>,
                h: L::Scalar,
            ) -> L::Scalar {
                <$rule as $functions>::discrete_rayleigh(self, q0, q1, h)
            }

            fn discrete_rayleigh_derivatives(
                &self,
                q0: &SVector<L::Scalar, $n>,
                q1: &SVector<L::Scalar, $n>,
                h: L::Scalar,
            ) -> Derivatives<L::Scalar, $n> {
                <$rule as $functions>::discrete_rayleigh_derivatives(self, q0, q1, h)
            }
        }
    };
}

discrete_rayleigh! { [R: DisplacementRule + SolvedForVelocity, L, const N: usize] R, N, DisplacementRule }
discrete_rayleigh! { [L] Fitted, 1, JointRayleighRule }
discrete_rayleigh! { [L, const N: usize] FittedTrapezoidal, N, JointRayleighRule }
discrete_rayleigh! { [L, const N: usize] OneSided, N, JointRayleighRule }

impl<R, L, const N: usize, const M: usize> DiscreteDriven<R, N, M> for L
where
    R: DisplacementRule + SolvedForVelocity,
    L: Fused<R, N> + Driven<N, M>,
{
    fn momenta_by_input(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> MomentaBy<L::Scalar, N, M> {
        R::force_by_input(self, q0, v, h)
    }
}

impl<R, L, const N: usize, const P: usize> DiscreteParameters<R, N, P> for L
where
    R: DisplacementRule + SolvedForVelocity,
    L: Fused<R, N> + Parameters<N, P>,
{
    fn momenta_by_parameters(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> MomentaBy<L::Scalar, N, P> {
        let mut by = R::lagrangian_by_parameters(self, q0, v, h);
        if L::HAS_RAYLEIGH {
            by = by + R::rayleigh_by_parameters(self, q0, v, h);
        }
        if L::HAS_FORCE {
            by = by + R::force_by_parameters(self, q0, v, h);
        }
        by
    }
}
