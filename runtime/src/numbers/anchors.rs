//! Values that a sweep over equations takes from the sweep before: sine and cosine of an angle that has moved
//! little, by the addition theorem; the reciprocal of a number that has, by a step of Newton's method.
//!
//! Each number decides for itself what is little, so that it has the bits that it has alone, whatever stands
//! beside it and however many.

use super::{Blank, Lanes, Members, Scalar};

/// An angle with its sine and cosine; FUSED: products are rounded with the sums that they stand in.
#[derive(Clone, Copy, Debug)]
pub struct Angle<V, const FUSED: bool = false> {
    /// Infinite before the first.
    angle: V,
    sine: V,
    cosine: V,
}

/// 1/x of a number x near by; 0 before the first. FUSED as of [`Angle`].
#[derive(Clone, Copy, Debug)]
pub struct Reciprocal<V, const FUSED: bool = false>(V);

/// For numbers side by side of the one kind or the other.
macro_rules! anchors {
    ($($numbers:ident)*) => {$(
        impl<T: Scalar, const K: usize, const FUSED: bool> Angle<$numbers<T, K>, FUSED> {
            /// Sine and cosine of the angle that it is now.
            ///
            /// From (x₀, sin x₀, cos x₀) with |δ| = |x − x₀| ≤ 3/16,
            ///
            /// ```text
            /// sin x = sin x₀ + (cos x₀ sin δ − sin x₀ (1 − cos δ))
            /// cos x = cos x₀ − (sin x₀ sin δ + cos x₀ (1 − cos δ))
            /// ```
            ///
            /// within 2 ε (|sin x| + |δ|), and the like of the cosine: next to a zero of the sine no worse
            /// than what rounding has made of x, the sum of x₀ and changes as large as δ. Angles farther off,
            /// and those of `f32`, have the sine and cosine of [`sin_cos`](crate::generated::Lanes::sin_cos),
            /// and the next start from there.
            #[cfg_attr(not(debug_assertions), inline(always))]
            #[must_use]
            pub fn sin_cos(&mut self, x: $numbers<T, K>) -> ($numbers<T, K>, $numbers<T, K>) {
                let Self { angle, sine, cosine } = self;
                let (sines, cosines) =
                    T::turned::<K, FUSED>(x.0, &mut angle.0, &mut sine.0, &mut cosine.0);
                ($numbers(sines), $numbers(cosines))
            }
        }

        impl<T: Scalar, const K: usize, const FUSED: bool> Reciprocal<$numbers<T, K>, FUSED> {
            /// The reciprocal r of x by one step from the last, r₀: r = r₀ + r₀ (1 − x r₀), off by the square
            /// of 1 − x r₀; where that is above 1/16, 1/x. For corrections that sweeps follow.
            #[cfg_attr(not(debug_assertions), inline(always))]
            #[must_use]
            pub fn of(&mut self, x: $numbers<T, K>) -> $numbers<T, K> {
                self.0.0 = T::corrected_reciprocals::<K, FUSED>(x.0, self.0.0);
                self.0
            }
        }

        impl<T: Scalar, const K: usize, const FUSED: bool> Blank for Angle<$numbers<T, K>, FUSED> {
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn blank() -> Self {
                let zero = $numbers::splat(T::zero());
                Angle { angle: $numbers::splat(T::one() / T::zero()), sine: zero, cosine: zero }
            }
        }

        impl<T: Scalar, const K: usize, const FUSED: bool> Blank for Reciprocal<$numbers<T, K>, FUSED> {
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn blank() -> Self {
                Reciprocal($numbers::splat(T::zero()))
            }
        }
    )*};
}

anchors!(Lanes Members);
