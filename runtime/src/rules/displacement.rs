//! Rules that see a segment through its displacement alone: quadrature along the straight line from q0 to q1.
//!
//! ```text
//! v̄ = (q1 − q0)/h,   qᵢ = (1 − cᵢ) q0 + cᵢ q1
//! L_d = h Σ bᵢ L(qᵢ, v̄),   R_d = (h²/2) Σ bᵢ R(qᵢ, v̄)
//! f_d⁻ = h Σ bᵢ (1 − cᵢ) f(qᵢ, v̄),   f_d⁺ = h Σ bᵢ cᵢ f(qᵢ, v̄)
//! ```
//!
//! Everything else is the chain rule: varying q0 moves (qᵢ, v̄) by (1 − cᵢ, −1/h), varying q1 by (cᵢ, 1/h).

use nalgebra::{SMatrix, SVector};

use super::parts::Parts;
use crate::numbers::{CovectorDerivatives, Derivatives, Direction, Hessian, Scalar};
use crate::step::{DiscreteForce, DiscreteForceDerivatives, Momenta, MomentaBy, Segment, StepKernel};
use crate::system::{ActingForce, Force, Lagrangian, Parameters, Rayleigh, SecondOrder};

/// A node of the quadrature over one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// cᵢ ∈ [0, 1], the share of q1.
    pub position: f64,
    /// bᵢ; the weights of a rule sum to 1.
    pub weight: f64,
}

/// One node on one segment.
struct Sample<'s, S, const N: usize> {
    segment: &'s Segment<S, N>,
    weight: S,
    position: S,
    q: SVector<S, N>,
}

impl<S: Scalar, const N: usize> Sample<'_, S, N> {
    /// The time of the node from the start of the step.
    #[inline]
    fn time(&self) -> S {
        self.position * self.segment.h
    }

    /// The change of (q, v̄) with q0.
    #[inline]
    fn by_q0(&self) -> Direction<S> {
        Direction { first: S::one() - self.position, second: -S::one() / self.segment.h }
    }

    /// The change of (q, v̄) with q1.
    #[inline]
    fn by_q1(&self) -> Direction<S> {
        Direction { first: self.position, second: S::one() / self.segment.h }
    }

    /// [`by_q0`](Self::by_q0) times −h, so that no division is left.
    #[inline]
    fn minus(&self) -> Direction<S> {
        Direction { first: (self.position - S::one()) * self.segment.h, second: S::one() }
    }

    /// [`by_q1`](Self::by_q1) times h.
    #[inline]
    fn plus(&self) -> Direction<S> {
        Direction { first: self.position * self.segment.h, second: S::one() }
    }

    /// Second derivatives by q0 and q1 from those by (q, v) at the node.
    #[inline]
    fn on_segment<const M: usize>(&self, by_node: &Hessian<S, N, M>) -> Hessian<S, N, M> {
        by_node.pull_back(self.by_q0(), self.by_q1())
    }
}

/// The nodes of a rule on a segment.
#[inline]
fn nodes<R: DisplacementRule, S: Scalar, const N: usize>(
    segment: &Segment<S, N>,
) -> impl Iterator<Item = Sample<'_, S, N>> {
    R::NODES.iter().map(move |node| {
        let position = S::constant(node.position);
        Sample { segment, weight: S::constant(node.weight), position, q: segment.at(position) }
    })
}

/// A rule given by its [`NODES`](Self::NODES); the discrete objects follow by formula.
///
/// Each function gives one term, so that a system sums those that it has: no R, no dissipation.
pub trait DisplacementRule: Copy {
    /// Nodes and weights.
    const NODES: &'static [Node];

    /// L_d(q0, q1, h) = h Σ bᵢ L(qᵢ, v̄).
    #[inline]
    fn discrete_lagrangian<L: Lagrangian<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        nodes::<Self, _, N>(segment).fold(nalgebra::zero(), |sum: L::Scalar, node| {
            sum + system.later(node.time(), |system| system.lagrangian(&node.q, &segment.v)) * node.weight
        }) * segment.h
    }

    /// L_d with its derivatives by q0 and q1.
    #[inline]
    fn discrete_lagrangian_derivatives<L: Lagrangian<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(Derivatives::zero(), |sum, node| {
            sum + system
                .later(node.time(), |system| system.lagrangian_derivatives(&node.q, &segment.v))
                .pull_back(node.by_q0(), node.by_q1())
                * (segment.h * node.weight)
        })
    }

    /// R_d(q0, q1, h) = (h²/2) Σ bᵢ R(qᵢ, v̄).
    #[inline]
    fn discrete_rayleigh<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        nodes::<Self, _, N>(segment).fold(nalgebra::zero(), |sum: L::Scalar, node| {
            sum + system.later(node.time(), |system| system.rayleigh(&node.q, &segment.v)) * node.weight
        }) * (segment.h * segment.h * L::Scalar::constant(0.5))
    }

    /// R_d with its derivatives by q0 and q1.
    #[inline]
    fn discrete_rayleigh_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        let half_square = segment.h * segment.h * L::Scalar::constant(0.5);
        nodes::<Self, _, N>(segment).fold(Derivatives::zero(), |sum, node| {
            sum + system
                .later(node.time(), |system| system.rayleigh_derivatives(&node.q, &segment.v))
                .pull_back(node.by_q0(), node.by_q1())
                * (half_square * node.weight)
        })
    }

    /// f_d of the Rayleigh function: f_d⁻ = D1 R_d, f_d⁺ = −D2 R_d.
    #[inline]
    fn rayleigh_force<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N> {
        let half_square = segment.h * segment.h * L::Scalar::constant(0.5);
        nodes::<Self, _, N>(segment).fold(DiscreteForce::zero(), |sum, node| {
            let r = system.later(node.time(), |system| system.rayleigh_gradient(&node.q, &segment.v));
            let weight = half_square * node.weight;
            sum + DiscreteForce {
                minus: r.along(node.by_q0()) * weight,
                plus: r.along(node.by_q1()) * -weight,
            }
        })
    }

    /// Derivatives of f_d of the Rayleigh function by q0 and q1.
    #[inline]
    fn rayleigh_force_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        DiscreteForceDerivatives::of_rayleigh(&Self::discrete_rayleigh_derivatives(system, segment))
    }

    /// f_d of the general force: f_d⁻ = h Σ bᵢ (1 − cᵢ) f(qᵢ, v̄), f_d⁺ = h Σ bᵢ cᵢ f(qᵢ, v̄).
    #[inline]
    fn general_force<L: Force<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(DiscreteForce::zero(), |sum, node| {
            let f = system.later(node.time(), |system| system.force(&node.q, &segment.v))
                * (segment.h * node.weight);
            sum + DiscreteForce {
                minus: f * (L::Scalar::constant(1.0) - node.position),
                plus: f * node.position,
            }
        })
    }

    /// Derivatives of f_d of the general force by q0 and q1.
    #[inline]
    fn general_force_derivatives<L: Force<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(DiscreteForceDerivatives::zero(), |sum, node| {
            let f = system.later(node.time(), |system| system.force_derivatives(&node.q, &segment.v));
            let pulled =
                CovectorDerivatives { value: f.value, d1: f.along(node.by_q0()), d2: f.along(node.by_q1()) }
                    * (segment.h * node.weight);
            sum + DiscreteForceDerivatives {
                minus: pulled * (L::Scalar::constant(1.0) - node.position),
                plus: pulled * node.position,
            }
        })
    }

    /// f_d, of the Rayleigh function and the general force, whichever the system has.
    fn discrete_force<L: ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N> {
        let mut force = DiscreteForce::zero();
        if L::HAS_RAYLEIGH {
            force = force + Self::rayleigh_force(&Parts::of(system), segment);
        }
        if L::HAS_FORCE {
            force = force + Self::general_force(&Parts::of(system), segment);
        }
        force
    }

    /// f_d with its derivatives by q0 and q1, of whichever the system has.
    fn discrete_force_derivatives<L: ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        let mut force = DiscreteForceDerivatives::zero();
        if L::HAS_RAYLEIGH {
            force = force + Self::rayleigh_force_derivatives(&Parts::of(system), segment);
        }
        if L::HAS_FORCE {
            force = force + Self::general_force_derivatives(&Parts::of(system), segment);
        }
        force
    }

    /// The part of the step's equation from L: −D1 L_d and its derivative by v̄.
    #[inline]
    fn lagrangian_kernel<L: Lagrangian<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(StepKernel::zero(), |sum, node| {
            let l = system.later(node.time(), |system| {
                system.lagrangian_variations(&node.q, &segment.v, node.minus(), node.plus())
            }) * node.weight;
            sum + StepKernel { p0: l.minus, matrix: l.mixed }
        })
    }

    /// The part of the step's equation from R: −D1 R_d and its derivative by v̄.
    #[inline]
    fn rayleigh_kernel<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N> {
        let half = segment.h * L::Scalar::constant(0.5);
        nodes::<Self, _, N>(segment).fold(StepKernel::zero(), |sum, node| {
            let r = system.later(node.time(), |system| {
                system.rayleigh_variations(&node.q, &segment.v, node.minus(), node.plus())
            }) * (half * node.weight);
            sum + StepKernel { p0: r.minus, matrix: r.mixed }
        })
    }

    /// The part of the step's equation from the general force: −f_d⁻ and its derivative by v̄.
    #[inline]
    fn force_kernel<L: Force<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(StepKernel::zero(), |sum, node| {
            let (f, by_v) =
                system.later(node.time(), |system| system.force_variation(&node.q, &segment.v, node.plus()));
            let weight = segment.h * node.weight * (node.position - L::Scalar::constant(1.0));
            sum + StepKernel { p0: f * weight, matrix: by_v * weight }
        })
    }

    /// The part of p0 and p1 from L: −D1 L_d and D2 L_d.
    #[inline]
    fn lagrangian_momenta<L: Lagrangian<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(Momenta::zero(), |sum, node| {
            let l = system.later(node.time(), |system| system.lagrangian_gradient(&node.q, &segment.v));
            sum + Momenta { p0: l.along(node.minus()) * node.weight, p1: l.along(node.plus()) * node.weight }
        })
    }

    /// Sizes of the terms that may cancel in p0 ([`ActingForce::cancelling_terms`]), added up over the nodes.
    #[cold]
    fn cancelling_terms<L: ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(nalgebra::zero(), |sum: SVector<L::Scalar, N>, node| {
            let terms = system.later(node.time(), |system| system.cancelling_terms(&node.q, &segment.v));
            sum + (terms.momentum + terms.rate * nalgebra::ComplexField::abs(node.minus().first))
                * node.weight
        })
    }

    /// The part of p0 and p1 from R: −D1 R_d and −D2 R_d.
    #[inline]
    fn rayleigh_momenta<L: Rayleigh<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N> {
        let half = segment.h * L::Scalar::constant(0.5);
        nodes::<Self, _, N>(segment).fold(Momenta::zero(), |sum, node| {
            let r = system.later(node.time(), |system| system.rayleigh_gradient(&node.q, &segment.v));
            sum + Momenta {
                p0: r.along(node.minus()) * (half * node.weight),
                p1: r.along(node.plus()) * (-half * node.weight),
            }
        })
    }

    /// The part of p0 and p1 from the general force: −f_d⁻ and f_d⁺.
    #[inline]
    fn force_momenta<L: Force<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N> {
        nodes::<Self, _, N>(segment).fold(Momenta::zero(), |sum, node| {
            let f = system.later(node.time(), |system| system.force(&node.q, &segment.v))
                * (segment.h * node.weight);
            sum + Momenta { p0: f * (node.position - L::Scalar::constant(1.0)), p1: f * node.position }
        })
    }

    /// ∂p0/∂u and ∂p1/∂u, of the general force: −∂f_d⁻/∂u and ∂f_d⁺/∂u, from its `slope` ∂f/∂u.
    #[inline]
    fn force_by_input<L: Lagrangian<N>, const N: usize, const M: usize>(
        segment: &Segment<L::Scalar, N>,
        system: &L,
        slope: impl Fn(&L, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, M>,
    ) -> MomentaBy<L::Scalar, N, M> {
        nodes::<Self, _, N>(segment).fold(MomentaBy::zero(), |sum, node| {
            let f = system.later(node.time(), |system| slope(system, &node.q, &segment.v))
                * (segment.h * node.weight);
            sum + MomentaBy { p0: f * (node.position - L::Scalar::constant(1.0)), p1: f * node.position }
        })
    }

    /// The part of ∂p0/∂θ and ∂p1/∂θ from L.
    #[inline]
    fn lagrangian_by_parameters<L: Parameters<N, P>, const N: usize, const P: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> MomentaBy<L::Scalar, N, P> {
        nodes::<Self, _, N>(segment).fold(MomentaBy::zero(), |sum, node| {
            let l = system.later(node.time(), |system| system.lagrangian_by_parameters(&node.q, &segment.v));
            sum + MomentaBy {
                p0: l.along(node.minus()) * node.weight,
                p1: l.along(node.plus()) * node.weight,
            }
        })
    }

    /// The part of ∂p0/∂θ and ∂p1/∂θ from R.
    #[inline]
    fn rayleigh_by_parameters<L: Parameters<N, P>, const N: usize, const P: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> MomentaBy<L::Scalar, N, P> {
        let half = segment.h * L::Scalar::constant(0.5);
        nodes::<Self, _, N>(segment).fold(MomentaBy::zero(), |sum, node| {
            let r = system.later(node.time(), |system| system.rayleigh_by_parameters(&node.q, &segment.v));
            let weight = half * node.weight;
            sum + MomentaBy { p0: r.along(node.minus()) * weight, p1: r.along(node.plus()) * -weight }
        })
    }

    /// The part of ∂p0/∂θ and ∂p1/∂θ from the general force.
    #[inline]
    fn force_by_parameters<L: Parameters<N, P>, const N: usize, const P: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> MomentaBy<L::Scalar, N, P> {
        nodes::<Self, _, N>(segment).fold(MomentaBy::zero(), |sum, node| {
            let f = system.later(node.time(), |system| system.force_by_parameters(&node.q, &segment.v))
                * (segment.h * node.weight);
            sum + MomentaBy { p0: f * (node.position - L::Scalar::constant(1.0)), p1: f * node.position }
        })
    }

    /// Second derivatives by q0 and q1 of what L adds to `a`·p0 + `b`·p1.
    #[inline]
    fn lagrangian_along<L: SecondOrder<N, M>, const N: usize, const M: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        [a, b]: [&SVector<L::Scalar, N>; 2],
    ) -> Hessian<L::Scalar, N, M> {
        nodes::<Self, _, N>(segment).fold(Hessian::zero(), |sum, node| {
            let (by_q, by_v) = (a * node.minus().first + b * node.plus().first, a + b);
            let l = system
                .later(node.time(), |system| system.lagrangian_along(&node.q, &segment.v, &by_q, &by_v));
            sum + node.on_segment(&l) * node.weight
        })
    }

    /// Second derivatives by q0 and q1 of what R adds to `a`·p0 + `b`·p1.
    #[inline]
    fn rayleigh_along<L: SecondOrder<N, M>, const N: usize, const M: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        [a, b]: [&SVector<L::Scalar, N>; 2],
    ) -> Hessian<L::Scalar, N, M> {
        let half = segment.h * L::Scalar::constant(0.5);
        nodes::<Self, _, N>(segment).fold(Hessian::zero(), |sum, node| {
            let (by_q, by_v) = (a * node.minus().first - b * node.plus().first, a - b);
            let r =
                system.later(node.time(), |system| system.rayleigh_along(&node.q, &segment.v, &by_q, &by_v));
            sum + node.on_segment(&r) * (half * node.weight)
        })
    }

    /// Second derivatives by q0, q1 and u of what the general force adds to `a`·p0 + `b`·p1.
    #[inline]
    fn force_along<L: SecondOrder<N, M>, const N: usize, const M: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        [a, b]: [&SVector<L::Scalar, N>; 2],
    ) -> Hessian<L::Scalar, N, M> {
        nodes::<Self, _, N>(segment).fold(Hessian::zero(), |sum, node| {
            let vector = a * (node.position - L::Scalar::constant(1.0)) + b * node.position;
            let f = system.later(node.time(), |system| system.force_along(&node.q, &segment.v, &vector));
            sum + node.on_segment(&f) * (segment.h * node.weight)
        })
    }

    /// Calls `visit` with the system and (q, v) at the nodes of the segment.
    #[expect(clippy::type_complexity, reason = "a visitor, in full: an alias would hide its lifetime")]
    fn at_nodes<L: Lagrangian<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        visit: &mut dyn FnMut(&L, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        nodes::<Self, _, N>(segment)
            .for_each(|node| system.later(node.time(), |system| visit(system, &node.q, &segment.v)));
    }

    /// Energy on the segment, Σ bᵢ E_L(qᵢ, v̄).
    #[inline]
    fn segment_energy<L: Lagrangian<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar {
        nodes::<Self, _, N>(segment).fold(nalgebra::zero(), |sum: L::Scalar, node| {
            sum + system.later(node.time(), |system| system.energy(&node.q, &segment.v)) * node.weight
        })
    }
}
