//! Noether's theorem for forced discrete systems (paper, section 3.6).
//!
//! For a vector field ξ on Q, lifted to Q×Q as (ξ(q0), ξ(q1)):
//!
//! ```text
//! J⁻ = ⟨p0, ξ(q0)⟩,  J⁺ = ⟨p1, ξ(q1)⟩
//! J⁺ − J⁻ = ξ(L_d) + f_d(ξ) =: defect(q0, q1)                   always
//! J_{k+1} − J_k = defect(q_k, q_{k+1})                           along solutions
//! ξ(L_d) = D1 L_d·ξ(q0) + D2 L_d·ξ(q1),   f_d(ξ) = f_d⁻·ξ(q0) + f_d⁺·ξ(q1)
//! ```
//!
//! Of a system at a time t0, a view, the k-th segment is judged at t0 + k h, and so is the k-th step of a
//! balance.
//!
//! J is conserved iff the defect vanishes: a symmetry of L_d on which the force does no work, or the two
//! cancelling.
//!
//! **On holonomic constraints** all of this is that of the pair restricted to N×N, N = g⁻¹(0), for ξ tangent
//! to N: what momenta have along the normals does nothing on ξ, nor do reactions. Samples have to be on N,
//! where [`on_constraints`](crate::Discretised::on_constraints) moves them, and a ξ that leaves N is an
//! error.
//!
//! **Rules with interior points**, [`Gauss`](crate::Gauss): the forced equations eliminate those points, so
//! that ξ(L_d) and f_d(ξ) mix what L and the force do; only their sum is J⁺ − J⁻. There the causes are taken
//! at the stages,
//!
//! ```text
//! J⁺ − J⁻ = h Σ bᵢ ξ(L)(Qᵢ, Vᵢ) + h Σ bᵢ f_L·ξ(Qᵢ)               ξ affine, ξ(q) = A q + b
//! ```
//!
//! with ξ(L) = ∂L/∂q·ξ + ∂L/∂v·Dξ v: a symmetry of L on which the force does no work keeps J to rounding. Of
//! other ξ a third part is left, [`Defect::interior`], of the rule's order.
//!
//! Beware of how a force is discretised. A force that does no work along ξ, f(q, v)·ξ(q) = 0, does none along
//! it in the midpoint rule either when ξ is affine; the same force taken from a Rayleigh function R(q, v)
//! does, to order h³ a step, through ∂R/∂q: f_d(ξ) = D1 R_d·ξ(q0) − D2 R_d·ξ(q1) does not vanish for an
//! invariant R_d. In coordinates that make ξ a translation it does none in either.
//!
//! ```
//! use dalembert::noether::{Generator, Noether};
//! use dalembert::{Discretise, Midpoint, rayleigh_system, samples};
//!
//! #[rayleigh_system]
//! fn puck(q: [f64; 2], v: [f64; 2], k: f64, r: f64) -> (f64, f64) {
//!     let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1]);
//!     (kinetic - 0.5 * k * q[1] * q[1], 0.5 * r * v[1] * v[1])
//! }
//!
//! let puck = Puck { k: 1.0, r: 0.1 };
//! let noether = puck.by(Midpoint, 0.1).noether();
//! let segments = samples::segments([-1.0; 2], [1.0; 2], [0.1; 2], 50);
//! let along_x = noether.symmetry(&Generator::translation("x", [1.0, 0.0]), &segments)?;
//! let along_y = noether.symmetry(&Generator::translation("y", [0.0, 1.0]), &segments)?;
//! assert!(along_x.is_conserved() && !along_y.is_conserved());
//! println!("{along_x}\n{along_y}");
//! # Ok::<(), dalembert::samples::SampleError>(())
//! ```

mod balance;
mod closure;
mod generator;
mod rank;
mod subalgebra;
mod symmetry;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{Discrete, Discretised};
use crate::system::VectorField;
use crate::theory::{
    restriction::at_segment_on_constraints,
    samples::{Pair, SampleError, Tolerance},
    verdict::largest,
};

pub use crate::step::Defect;
pub use balance::Balance;
pub use closure::Closure;
pub use generator::{Generator, bracket};
pub use rank::RankDecision;
pub use subalgebra::{Subalgebra, SubalgebraError, Subspace};
pub use symmetry::{Contribution, Symmetry};

/// Momentum maps of a discretised system, and their balance.
pub struct Noether<'a, L, R, const N: usize>
where
    L: Discrete<R, N>,
{
    by: Discretised<'a, L, R, N>,
    tolerance: f64,
}

/// One row of the checkers: the defect and the size of the terms that it is a sum of.
#[derive(Clone, Copy)]
struct Terms {
    defect: Defect<f64>,
    size: Defect<f64>,
}

impl<'a, L, R, const N: usize> Noether<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    fn of(by: &Discretised<'a, L, R, N>) -> Self {
        Self { by: *by, tolerance: Tolerance::rounding::<L::Scalar>() }
    }

    /// Counts as zero what is below `relative` times the size of the terms; 1024 ε unless said.
    ///
    /// Raise it where L, R or f lose digits inside, or are known to few digits themselves.
    #[must_use]
    pub fn with_tolerance(self, relative: f64) -> Self {
        Self { tolerance: relative, ..self }
    }

    /// J⁻(q0, q1) = ⟨p0, ξ(q0)⟩, p0 = −D1 L_d − f_d⁻.
    pub fn momentum_map_minus(
        &self,
        generator: &impl VectorField<N, Scalar = L::Scalar>,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> L::Scalar {
        self.by.objects(q0, q1).momenta().p0.dot(&generator.vector(q0))
    }

    /// J⁺(q0, q1) = ⟨p1, ξ(q1)⟩, p1 = D2 L_d + f_d⁺.
    pub fn momentum_map_plus(
        &self,
        generator: &impl VectorField<N, Scalar = L::Scalar>,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> L::Scalar {
        self.by.objects(q0, q1).momenta().p1.dot(&generator.vector(q1))
    }

    /// J⁺ − J⁻ of the segment (q0, q1), by its causes.
    pub fn defect(
        &self,
        generator: &impl VectorField<N, Scalar = L::Scalar>,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
    ) -> Defect<L::Scalar> {
        self.by.objects(q0, q1).defect(generator).0
    }

    /// The defect on the k-th segment, NaN where a product of its terms underflows, by the generator of this
    /// number.
    ///
    /// # Errors
    /// [`SampleError::LeavesConstraints`]; those of [`at_segment_on_constraints`].
    fn terms(
        &self,
        k: usize,
        number: usize,
        generator: &impl VectorField<N, Scalar = L::Scalar>,
        segment: &Pair<L::Scalar, N>,
    ) -> Result<Terms, SampleError> {
        at_segment_on_constraints(&self.by, k, segment, |by, ends| {
            if let Some(share) = ends.and_then(|ends| ends.outward(generator, segment, self.tolerance)) {
                return Err(SampleError::LeavesConstraints { generator: number, index: k, share });
            }
            let (defect, size) = by.objects(&segment.q0, &segment.q1).defect(generator);
            Ok(Terms { defect: widened(&defect), size: widened(&size) })
        })?
    }
}

fn widened<S: Scalar>(of: &Defect<S>) -> Defect<f64> {
    Defect { lagrangian: of.lagrangian.widen(), force: of.force.widen(), interior: of.interior.widen() }
}

/// Whether ξ moves an end of the segment.
fn moves_an_end<S: Scalar, const N: usize>(
    generator: &impl VectorField<N, Scalar = S>,
    segment: &Pair<S, N>,
) -> bool {
    let size = |q| largest(generator.vector(q).iter().map(|entry| entry.widen()));
    size(&segment.q0) != 0.0 || size(&segment.q1) != 0.0
}

impl<'a, L, R, const N: usize> Discretised<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    /// Momentum maps, and what friction does to them.
    #[must_use]
    pub fn noether(&self) -> Noether<'a, L, R, N> {
        const { Self::require_holonomic() };
        Noether::of(self)
    }

    /// [`noether`](Self::noether) for code that is compiled for systems of any kind; none on constraints of
    /// velocity, of which `noether` itself does not compile.
    #[must_use]
    pub fn noether_if_holonomic(&self) -> Option<Noether<'a, L, R, N>> {
        (!L::IS_NONHOLONOMIC).then(|| Noether::of(self))
    }
}
