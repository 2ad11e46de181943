//! Rules of one's own, by nodes and weights.

use nalgebra::{SMatrix, SVector};

use super::{DisplacementRule, SelfAdjoint};
use crate::numbers::{CovectorDerivatives, Derivatives, Gradient};
use crate::step::{
    Discrete, DiscreteDriven, DiscreteForce, DiscreteForceDerivatives, DiscreteParameters, DiscreteRayleigh,
    Momenta, MomentaBy, SolvedForVelocity, StepKernel, VelocityHistory,
};
use crate::system::{ActingForce, Driven, Force, Lagrangian, Parameters, Rayleigh};

/// The rule of one's own `Q`, for every system: nodes and weights on the straight line from q0 to q1.
///
/// One declaration, and no line for a system. L_d, R_d and f_d follow as for
/// [`Midpoint`](crate::Midpoint) and [`Trapezoidal`](crate::Trapezoidal), whose derivatives the attribute
/// writes out besides: what such a rule costs is that of a system's derivatives at each node.
///
/// ```
/// use dalembert::rules::{DisplacementRule, Node, Quadrature, SelfAdjoint};
/// use dalembert::{Composition, Discretise, State, rayleigh_system};
///
/// /// Simpson's rule.
/// #[derive(Clone, Copy)]
/// struct Simpson;
///
/// impl DisplacementRule for Simpson {
///     const NODES: &'static [Node] = &[
///         Node { position: 0.0, weight: 1.0 / 6.0 },
///         Node { position: 0.5, weight: 2.0 / 3.0 },
///         Node { position: 1.0, weight: 1.0 / 6.0 },
///     ];
/// }
///
/// impl SelfAdjoint for Simpson {} // its nodes are symmetric about ½: compositions take it
///
/// #[rayleigh_system]
/// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
/// let pendulum = Pendulum { r: 0.1 };
/// let start = State::from_velocity(&pendulum, [1.0], [0.0])?;
/// let end = pendulum.by(Quadrature(Simpson), 0.1).run(start).nth(99).unwrap()?.state;
///
/// let composition = Composition::kahan_li_6(Quadrature(Simpson));
/// let exact = pendulum.by(composition, 0.1).run(start).nth(99).unwrap()?.state;
/// assert!((end.q - exact.q).amax() < 1e-2 && end.q != exact.q);
/// # Ok::<(), dalembert::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quadrature<Q>(pub Q);

impl<Q: DisplacementRule> SolvedForVelocity for Quadrature<Q> {}
impl<Q: SelfAdjoint> SelfAdjoint for Quadrature<Q> {}

impl<L, Q, const N: usize> Discrete<Quadrature<Q>, N> for L
where
    L: ActingForce<N>,
    Q: DisplacementRule,
{
    type Matrix = SMatrix<L::Scalar, N, N>;
    type Memory = VelocityHistory<L::Scalar, N>;

    fn discrete_lagrangian(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar {
        Q::discrete_lagrangian(self, q0, q1, h)
    }

    fn discrete_lagrangian_derivatives(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Derivatives<L::Scalar, N> {
        Q::discrete_lagrangian_derivatives(self, q0, q1, h)
    }

    fn discrete_force(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> DiscreteForce<L::Scalar, N> {
        let mut force = DiscreteForce::zero();
        if L::HAS_RAYLEIGH {
            force = force + Q::rayleigh_force(&Parts::of(self), q0, q1, h);
        }
        if L::HAS_FORCE {
            force = force + Q::general_force(&Parts::of(self), q0, q1, h);
        }
        force
    }

    fn discrete_force_derivatives(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        let mut force = DiscreteForceDerivatives::zero();
        if L::HAS_RAYLEIGH {
            force = force + Q::rayleigh_force_derivatives(&Parts::of(self), q0, q1, h);
        }
        if L::HAS_FORCE {
            force = force + Q::general_force_derivatives(&Parts::of(self), q0, q1, h);
        }
        force
    }

    #[inline]
    fn step_kernel(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> StepKernel<L::Scalar, N> {
        let mut kernel = Q::lagrangian_kernel(self, q0, v, h);
        if L::HAS_RAYLEIGH {
            kernel = kernel + Q::rayleigh_kernel(&Parts::of(self), q0, v, h);
        }
        if L::HAS_FORCE {
            kernel = kernel + Q::force_kernel(&Parts::of(self), q0, v, h);
        }
        kernel
    }

    #[inline]
    fn momenta(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Momenta<L::Scalar, N> {
        let mut momenta = Q::lagrangian_momenta(self, q0, v, h);
        if L::HAS_RAYLEIGH {
            momenta = momenta + Q::rayleigh_momenta(&Parts::of(self), q0, v, h);
        }
        if L::HAS_FORCE {
            momenta = momenta + Q::force_momenta(&Parts::of(self), q0, v, h);
        }
        momenta
    }

    fn cancelling_terms(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> SVector<L::Scalar, N> {
        Q::cancelling_terms(self, q0, v, h)
    }

    fn segment_energy(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar {
        Q::segment_energy(self, q0, q1, h)
    }

    fn at_nodes(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
        visit: &mut dyn FnMut(&Self, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        Q::at_nodes(self, q0, v, h, visit);
    }
}

impl<L, Q, const N: usize> DiscreteRayleigh<Quadrature<Q>, N> for L
where
    L: ActingForce<N> + Rayleigh<N>,
    Q: DisplacementRule,
{
    fn discrete_rayleigh(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar {
        Q::discrete_rayleigh(self, q0, q1, h)
    }

    fn discrete_rayleigh_derivatives(
        &self,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Derivatives<L::Scalar, N> {
        Q::discrete_rayleigh_derivatives(self, q0, q1, h)
    }
}

impl<L, Q, const N: usize, const M: usize> DiscreteDriven<Quadrature<Q>, N, M> for L
where
    L: ActingForce<N> + Driven<N, M>,
    Q: DisplacementRule,
{
    fn momenta_by_input(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> MomentaBy<L::Scalar, N, M> {
        Q::force_by_input(self, q0, v, h)
    }
}

impl<L, Q, const N: usize, const P: usize> DiscreteParameters<Quadrature<Q>, N, P> for L
where
    L: ActingForce<N> + Parameters<N, P>,
    Q: DisplacementRule,
{
    fn momenta_by_parameters(
        &self,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> MomentaBy<L::Scalar, N, P> {
        let mut by = Q::lagrangian_by_parameters(self, q0, v, h);
        if L::HAS_RAYLEIGH {
            by = by + Q::rayleigh_by_parameters(self, q0, v, h);
        }
        if L::HAS_FORCE {
            by = by + Q::force_by_parameters(self, q0, v, h);
        }
        by
    }
}

/// A system by the parts of its force, whichever it has, `elapsed` from now.
struct Parts<'a, L: Lagrangian<N>, const N: usize> {
    system: &'a L,
    elapsed: L::Scalar,
}

impl<'a, L: Lagrangian<N>, const N: usize> Parts<'a, L, N> {
    fn of(system: &'a L) -> Self {
        Self { system, elapsed: nalgebra::zero() }
    }
}

impl<L: ActingForce<N>, const N: usize> Lagrangian<N> for Parts<'_, L, N> {
    type Scalar = L::Scalar;

    fn lagrangian(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        self.system.later(self.elapsed, |system| system.lagrangian(q, v))
    }

    fn lagrangian_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.lagrangian_derivatives(q, v))
    }

    fn later<T>(&self, elapsed: L::Scalar, evaluate: impl FnOnce(&Self) -> T) -> T {
        evaluate(&Self { system: self.system, elapsed: self.elapsed + elapsed })
    }
}

impl<L: ActingForce<N>, const N: usize> Rayleigh<N> for Parts<'_, L, N> {
    fn rayleigh(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        self.rayleigh_gradient(q, v).value
    }

    fn rayleigh_gradient(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Gradient<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.dissipation(q, v))
    }

    fn rayleigh_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.dissipation_derivatives(q, v))
    }
}

impl<L: ActingForce<N>, const N: usize> Force<N> for Parts<'_, L, N> {
    fn force(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.general_force(q, v))
    }

    fn force_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.general_force_derivatives(q, v))
    }
}
