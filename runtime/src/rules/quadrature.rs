//! Rules of one's own, by nodes and weights.

use nalgebra::{SMatrix, SVector};

use super::force_work::by_nodes;
use super::parts::Parts;
use super::{DisplacementRule, Node, SelfAdjoint};
use crate::step::{Free, Fused, Momenta, Segment, SolvedForVelocity, StepKernel, VelocityHistory};
use crate::system::ActingForce;

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

/// The rule itself, on every system that it steps.
impl<Q: DisplacementRule> DisplacementRule for Quadrature<Q> {
    const NODES: &'static [Node] = Q::NODES;
}

/// One term for each of L, R and f that the system has.
impl<L, Q, const N: usize> Fused<Quadrature<Q>, N> for L
where
    L: ActingForce<N>,
    Q: DisplacementRule,
{
    type Matrix = SMatrix<L::Scalar, N, N>;
    type Memory = VelocityHistory<L::Scalar, N>;
    type Border = Free;

    #[inline]
    fn step_kernel(&self, segment: &Segment<L::Scalar, N>) -> StepKernel<L::Scalar, N> {
        const {
            assert!(
                !L::IS_CONSTRAINED,
                "`Quadrature` steps a system without constraints; take `Midpoint` or `Trapezoidal`"
            );
            assert!(
                !L::STRUCTURE.is_held_by_friction(),
                "`Quadrature` has no step where R has a kink and the motion stops; take `Proximal`"
            );
        }
        let mut kernel = Q::lagrangian_kernel(self, segment);
        if L::HAS_RAYLEIGH {
            kernel = kernel + Q::rayleigh_kernel(&Parts::of(self), segment);
        }
        if L::HAS_FORCE {
            kernel = kernel + Q::force_kernel(&Parts::of(self), segment);
        }
        kernel
    }

    #[inline]
    fn momenta(&self, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        let mut momenta = Q::lagrangian_momenta(self, segment);
        if L::HAS_RAYLEIGH {
            momenta = momenta + Q::rayleigh_momenta(&Parts::of(self), segment);
        }
        if L::HAS_FORCE {
            momenta = momenta + Q::force_momenta(&Parts::of(self), segment);
        }
        momenta
    }

    #[cold]
    fn cancelling_terms(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        Q::cancelling_terms(self, segment)
    }
}

by_nodes!([Q: DisplacementRule,] Quadrature<Q>, of Q);
