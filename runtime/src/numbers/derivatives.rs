//! First and second derivatives of a function of two points, f: ℝⁿ × ℝⁿ → ℝ, and how they pull back along
//! linear maps.
//!
//! The continuous L(q, v) and the discrete L_d(q0, q1) are both of this kind: D1 and D2 are the derivatives
//! by the first and by the second argument.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;

/// Value and first derivatives of f(x, y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<S, const N: usize> {
    /// f(x, y).
    pub value: S,
    /// D1 f = ∂f/∂x, shape N.
    pub d1: SVector<S, N>,
    /// D2 f = ∂f/∂y, shape N.
    pub d2: SVector<S, N>,
}

/// Value, first and second derivatives of f(x, y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives<S, const N: usize> {
    /// f(x, y).
    pub value: S,
    /// D1 f = ∂f/∂x, shape N.
    pub d1: SVector<S, N>,
    /// D2 f = ∂f/∂y, shape N.
    pub d2: SVector<S, N>,
    /// D1D1 f, shape N×N, symmetric.
    pub d11: SMatrix<S, N, N>,
    /// D1D2 f, shape N×N: entry (i, j) is ∂²f/∂xᵢ∂yⱼ.
    pub d12: SMatrix<S, N, N>,
    /// D2D2 f, shape N×N, symmetric.
    pub d22: SMatrix<S, N, N>,
}

/// Value and first derivatives of a covector-valued function g(x, y) ∈ ℝⁿ, such as a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CovectorDerivatives<S, const N: usize> {
    /// g(x, y), shape N.
    pub value: SVector<S, N>,
    /// D1 g, shape N×N: entry (i, j) is ∂gᵢ/∂xⱼ.
    pub d1: SMatrix<S, N, N>,
    /// D2 g, shape N×N: entry (i, j) is ∂gᵢ/∂yⱼ.
    pub d2: SMatrix<S, N, N>,
}

/// A direction (x, y) = (`first`·e, `second`·e) in ℝⁿ × ℝⁿ, the same pair of factors for every unit vector e.
///
/// The rules of this crate reach (q, v) from (q0, q1) by such scalar factors, so that a variation of q0 or of
/// q1 is one pair of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction<S> {
    /// Factor of the first argument.
    pub first: S,
    /// Factor of the second argument.
    pub second: S,
}

/// Sizes of the terms that may cancel in the equation of motion d/dt ∂L/∂v = g, over ε.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CancellingTerms<T, const N: usize> {
    /// In ∂L/∂v.
    pub momentum: SVector<T, N>,
    /// In g = ∂L/∂q + f_L.
    pub rate: SVector<T, N>,
}

/// Derivatives of f(x, y) along two families of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variations<S, const N: usize> {
    /// Entry i: derivative along the first direction with e = eᵢ.
    pub minus: SVector<S, N>,
    /// Entry j: derivative along the second direction with e = eⱼ.
    pub plus: SVector<S, N>,
    /// Entry (i, j): second derivative along both.
    pub mixed: SMatrix<S, N, N>,
}

impl<S: Scalar, const N: usize> Gradient<S, N> {
    /// Derivatives along `direction`: entry i is first·∂f/∂xᵢ + second·∂f/∂yᵢ.
    #[inline]
    #[must_use]
    pub fn along(&self, direction: Direction<S>) -> SVector<S, N> {
        self.d1 * direction.first + self.d2 * direction.second
    }
}

impl<S: Scalar, const N: usize> Derivatives<S, N> {
    /// The derivatives without the second ones.
    #[inline]
    #[must_use]
    pub fn gradient(&self) -> Gradient<S, N> {
        Gradient { value: self.value, d1: self.d1, d2: self.d2 }
    }

    /// Derivatives of (a, b) ↦ f(x, y) with x = `a.first` a + `b.first` b and y = `a.second` a + `b.second`
    /// b.
    ///
    /// `a` and `b` say what varying each new argument does to the old pair.
    #[inline]
    #[must_use]
    pub(crate) fn pull_back(&self, a: Direction<S>, b: Direction<S>) -> Self {
        let second = |a, b| second_along(&self.d11, &self.d12, &self.d22, a, b);
        let gradient = self.gradient();
        Self {
            value: self.value,
            d1: gradient.along(a),
            d2: gradient.along(b),
            d11: second(a, a),
            d12: second(a, b),
            d22: second(b, b),
        }
    }

    /// Derivatives along `minus` and `plus` and their mixed second derivative.
    #[inline]
    #[must_use]
    pub fn variations(&self, minus: Direction<S>, plus: Direction<S>) -> Variations<S, N> {
        let pulled = self.pull_back(minus, plus);
        Variations { minus: pulled.d1, plus: pulled.d2, mixed: pulled.d12 }
    }
}

/// The derivative along `a` and then `b`, of second derivatives by (x, y).
#[inline]
pub(crate) fn second_along<S: Scalar, const N: usize>(
    d11: &SMatrix<S, N, N>,
    d12: &SMatrix<S, N, N>,
    d22: &SMatrix<S, N, N>,
    a: Direction<S>,
    b: Direction<S>,
) -> SMatrix<S, N, N> {
    d11 * (a.first * b.first)
        + d12 * (a.first * b.second)
        + d12.transpose() * (a.second * b.first)
        + d22 * (a.second * b.second)
}

impl<S: Scalar, const N: usize> CovectorDerivatives<S, N> {
    /// Derivative along `direction`: entry (i, j) is first·∂gᵢ/∂xⱼ + second·∂gᵢ/∂yⱼ.
    #[inline]
    #[must_use]
    pub fn along(&self, direction: Direction<S>) -> SMatrix<S, N, N> {
        self.d1 * direction.first + self.d2 * direction.second
    }
}

/// Second derivatives of a function of (x, y, u), x and y ∈ ℝᴺ, u ∈ ℝᴹ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hessian<S, const N: usize, const M: usize = 0> {
    /// By x twice, symmetric.
    pub d11: SMatrix<S, N, N>,
    /// By x (rows) and y.
    pub d12: SMatrix<S, N, N>,
    /// By y twice, symmetric.
    pub d22: SMatrix<S, N, N>,
    /// By x (rows) and u.
    pub d1u: SMatrix<S, N, M>,
    /// By y (rows) and u.
    pub d2u: SMatrix<S, N, M>,
    /// By u twice, symmetric.
    pub duu: SMatrix<S, M, M>,
}

impl<S: Scalar, const N: usize, const M: usize> Hessian<S, N, M> {
    /// Second derivatives by (a, b, u) where x = `a.first` a + `b.first` b and y = `a.second` a + `b.second`
    /// b.
    #[inline]
    #[must_use]
    pub(crate) fn pull_back(&self, a: Direction<S>, b: Direction<S>) -> Self {
        let second = |a, b| second_along(&self.d11, &self.d12, &self.d22, a, b);
        let with_input = |s: Direction<S>| self.d1u * s.first + self.d2u * s.second;
        Self {
            d11: second(a, a),
            d12: second(a, b),
            d22: second(b, b),
            d1u: with_input(a),
            d2u: with_input(b),
            duu: self.duu,
        }
    }
}

/// Makes a type a vector space: zero, sum and scaling act on every field.
macro_rules! linear {
    ($type:ident $(<$($size:ident),+>)? { $($field:ident),+ }) => {
        impl<S: $crate::numbers::Scalar, const N: usize $($(, const $size: usize)+)?> $type<S, N $($(, $size)+)?> {
            /// Zero in every field.
            #[inline]
            #[must_use]
            pub fn zero() -> Self {
                Self { $($field: nalgebra::zero()),+ }
            }
        }

        impl<S: $crate::numbers::Scalar, const N: usize $($(, const $size: usize)+)?> core::ops::Add
            for $type<S, N $($(, $size)+)?>
        {
            type Output = Self;
            #[inline]
            fn add(self, other: Self) -> Self {
                Self { $($field: self.$field + other.$field),+ }
            }
        }

        impl<S: $crate::numbers::Scalar, const N: usize $($(, const $size: usize)+)?> core::ops::Mul<S>
            for $type<S, N $($(, $size)+)?>
        {
            type Output = Self;
            #[inline]
            fn mul(self, factor: S) -> Self {
                Self { $($field: self.$field * factor),+ }
            }
        }
    };
}
pub(crate) use linear;

linear!(Derivatives { value, d1, d2, d11, d12, d22 });
linear!(CovectorDerivatives { value, d1, d2 });
linear!(Variations { minus, plus, mixed });
linear!(Hessian<M> { d11, d12, d22, d1u, d2u, duu });
