//! The change of a vector field's momentum map over a segment, split into its causes.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Derivatives, Scalar};
use crate::step::{DiscreteForce, DiscreteForceDerivatives};

/// The change J⁺ − J⁻ = ⟨p1, ξ(q1)⟩ − ⟨p0, ξ(q0)⟩ over a segment, split into its causes.
///
/// Of a rule without points between the ends: ξ(L_d) and f_d(ξ).
///
/// Of a rule whose interior points are eliminated by the forced equations, those two are no diagnosis apart,
/// only their sum is: the force bends the interior points, and with them L_d. There the causes are seen at
/// the stages,
///
/// ```text
/// h Σ bᵢ (∂L/∂q·ξ + ∂L/∂v·Dξ Vᵢ)(Qᵢ, Vᵢ)        h Σ bᵢ f_L·ξ(Qᵢ)
/// ```
///
/// which add up to J⁺ − J⁻ where ξ is affine, ξ(q) = A q + b; `interior` is what is missing elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defect<S> {
    /// ξ(L_d), or ξ(L) at the stages: how far L is from invariant.
    pub lagrangian: S,
    /// f_d(ξ), or f_L·ξ at the stages: the work of the force along ξ.
    pub force: S,
    /// The part of the rule itself: 0 of rules without interior points, and where ξ is affine.
    pub interior: S,
}

impl<S: Scalar> Defect<S> {
    /// J⁺ − J⁻.
    #[must_use]
    pub fn total(&self) -> S {
        self.lagrangian + self.force + self.interior
    }
}

/// Σ aᵢbᵢ and Σ|aᵢ||bᵢ|, the latter NaN where a product is lost to underflow: nothing can be said of its
/// value then.
#[derive(Clone, Copy)]
pub(crate) struct Pairing<S> {
    pub(crate) value: S,
    pub(crate) size: S,
}

impl<S: Scalar> Pairing<S> {
    pub(crate) fn zero() -> Self {
        Self { value: S::zero(), size: S::zero() }
    }

    /// This and a·b.
    pub(crate) fn and<const N: usize>(self, a: &SVector<S, N>, b: &SVector<S, N>) -> Self {
        let mut size = self.size;
        for (a, b) in a.iter().zip(b.iter()) {
            let product = a.abs() * b.abs();
            let is_lost = product < S::SMALLEST_NORMAL && *a != S::zero() && *b != S::zero();
            size += if is_lost { S::constant(f64::NAN) } else { product };
        }
        Self { value: self.value + a.dot(b), size }
    }

    /// Of a stage, of which the step has `weight`.
    pub(crate) fn plus(self, of: Self, weight: S) -> Self {
        Self { value: self.value + of.value * weight, size: self.size + of.size * weight.abs() }
    }
}

/// ξ(L_d) and f_d(ξ), with the sizes of their terms.
pub(super) fn at_the_ends<S: Scalar, const N: usize>(
    l: &Derivatives<S, N>,
    f: &DiscreteForce<S, N>,
    [xi0, xi1]: [&SVector<S, N>; 2],
) -> (Defect<S>, Defect<S>) {
    let lagrangian = Pairing::zero().and(&l.d1, xi0).and(&l.d2, xi1);
    let force = Pairing::zero().and(&f.minus, xi0).and(&f.plus, xi1);
    (
        Defect { lagrangian: lagrangian.value, force: force.value, interior: S::zero() },
        Defect { lagrangian: lagrangian.size, force: force.size, interior: S::zero() },
    )
}

/// ι_ξ df_d = (F − Fᵀ)(ξ(q0), ξ(q1)), F = ∂(f_d⁻, f_d⁺)/∂(q0, q1): each component with the size of its terms.
pub(super) fn contraction<S: Scalar, const N: usize>(
    f: &DiscreteForceDerivatives<S, N>,
    [xi0, xi1]: [&SVector<S, N>; 2],
    component: &mut dyn FnMut(S, S),
) {
    let mut write =
        |by_own: &SMatrix<S, N, N>, by_other: &SMatrix<S, N, N>, of_other: &SMatrix<S, N, N>, own, other| {
            for a in 0..N {
                let (mut value, mut size) = (S::zero(), S::zero());
                for b in 0..N {
                    for (ab, ba, xi) in
                        [(by_own[(a, b)], by_own[(b, a)], own), (by_other[(a, b)], of_other[(b, a)], other)]
                    {
                        let xi: &SVector<S, N> = xi;
                        value += (ab - ba) * xi[b];
                        size += (ab.abs() + ba.abs()) * xi[b].abs();
                    }
                }
                component(value, size);
            }
        };
    write(&f.minus.d1, &f.minus.d2, &f.plus.d1, xi0, xi1);
    write(&f.plus.d2, &f.plus.d1, &f.minus.d2, xi1, xi0);
}
