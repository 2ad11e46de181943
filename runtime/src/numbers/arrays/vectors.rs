//! Arithmetic of lanes in the vector types of `wide`: as many lanes as one holds at once, the rest in
//! narrower ones.
//!
//! Each operation is the one that a number has, so lanes are rounded as numbers are.

use wide::{f32x4, f32x8, f64x2, f64x4, f64x8};

/// Arithmetic of numbers side by side.
pub trait Vectors: Sized {
    /// a + b.
    fn sums<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S];

    /// a − b.
    fn differences<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S];

    /// a b.
    fn products<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S];

    /// a/b.
    fn quotients<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S];

    /// a b + c, rounded once where that is asked for and where the target has an instruction for it.
    fn products_plus<const S: usize>(is_fused: bool, a: [Self; S], b: [Self; S], c: [Self; S]) -> [Self; S];

    /// The larger of a and b; where one is NaN, either.
    fn larger<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S];

    /// |a|.
    fn sizes<const S: usize>(a: [Self; S]) -> [Self; S];

    /// √a.
    fn roots<const S: usize>(a: [Self; S]) -> [Self; S];
}

/// The operation on chunks of the widest type whose width S is a multiple of, or else one by one; S alone
/// decides, so that one branch is compiled.
macro_rules! in_chunks {
    ([$($vector:ident $width:literal)*] $arguments:tt => $wide:expr, $alone:expr) => {{
        $(
            if const { S == $width } {
                return in_chunks!(@chunk $vector $width $arguments => $wide);
            }
            if const { S.is_multiple_of($width) } {
                return in_chunks!(@chunks $vector $width $arguments => $wide);
            }
        )*
        in_chunks!(@alone $arguments => $alone)
    }};
    // Without the iterators, which take most of the time that the operation takes to compile.
    (@chunk $vector:ident $width:literal ($x:ident $(, $y:ident)*) => $wide:expr) => {{
        let mut result = $x;
        if let [chunk] = result.as_chunks_mut::<$width>().0
            $(&& let [$y] = $y.as_chunks::<$width>().0)*
        {
            let $x = $vector::new(*chunk);
            $(let $y = $vector::new(*$y);)*
            *chunk = $wide.to_array();
        }
        result
    }};
    (@chunks $vector:ident $width:literal ($x:ident $(, $y:ident)*) => $wide:expr) => {{
        let mut result = $x;
        let all = result.as_chunks_mut::<$width>().0.iter_mut();
        $(let all = all.zip($y.as_chunks::<$width>().0);)*
        for in_chunks!(@pattern chunk $(, $y)*) in all {
            let $x = $vector::new(*chunk);
            $(let $y = $vector::new(*$y);)*
            *chunk = $wide.to_array();
        }
        result
    }};
    (@alone ($x:ident $(, $y:ident)*) => $alone:expr) => {{
        let mut result = $x;
        let all = result.iter_mut();
        $(let all = all.zip($y);)*
        for in_chunks!(@pattern one $(, $y)*) in all {
            let $x = *one;
            *one = $alone;
        }
        result
    }};
    (@pattern $x:ident) => { $x };
    (@pattern $x:ident, $y:ident) => { ($x, $y) };
    (@pattern $x:ident, $y:ident, $z:ident) => { (($x, $y), $z) };
}

macro_rules! vectors {
    ($scalar:ident: $vectors:tt) => {
        impl Vectors for $scalar {
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn sums<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S] {
                in_chunks!($vectors (a, b) => a + b, a + b)
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn differences<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S] {
                in_chunks!($vectors (a, b) => a - b, a - b)
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn products<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S] {
                in_chunks!($vectors (a, b) => a * b, a * b)
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn quotients<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S] {
                in_chunks!($vectors (a, b) => a / b, a / b)
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn products_plus<const S: usize>(
                is_fused: bool,
                a: [Self; S],
                b: [Self; S],
                c: [Self; S],
            ) -> [Self; S] {
                if cfg!(target_feature = "fma") {
                    in_chunks!($vectors (a, b, c) => a.mul_add(b, c), nalgebra::ComplexField::mul_add(a, b, c))
                } else if is_fused {
                    // `wide` rounds twice where there is no instruction.
                    in_chunks!(@alone (a, b, c) => nalgebra::ComplexField::mul_add(a, b, c))
                } else {
                    in_chunks!($vectors (a, b, c) => a * b + c, a * b + c)
                }
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn larger<const S: usize>(a: [Self; S], b: [Self; S]) -> [Self; S] {
                in_chunks!($vectors (a, b) => a.fast_max(b), if a > b { a } else { b })
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn sizes<const S: usize>(a: [Self; S]) -> [Self; S] {
                in_chunks!($vectors (a) => a.abs(), nalgebra::ComplexField::abs(a))
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn roots<const S: usize>(a: [Self; S]) -> [Self; S] {
                in_chunks!($vectors (a) => a.sqrt(), nalgebra::ComplexField::sqrt(a))
            }
        }
    };
}

vectors!(f64: [f64x8 8 f64x4 4 f64x2 2]);
vectors!(f32: [f32x8 8 f32x4 4]);
