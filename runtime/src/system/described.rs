//! Description of a system for code that knows no system by name: bindings to other languages.

use super::{ActingForce, Scalar};

/// A system of `#[rayleigh_system]` as it is seen from outside: its sizes, and the type that is stepped.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not described: no `#[rayleigh_system]` with {N} coordinates made it",
    label = "no system of `#[rayleigh_system]`",
    note = "put `#[rayleigh_system]` on the `impl` of this struct with L, R and f"
)]
pub trait Described<const N: usize>: Sized + 'static {
    /// `f64` or `f32`.
    type Scalar: Scalar;
    /// The type of u: `[Scalar; INPUTS]`, or `()` where the force takes none.
    type Input;
    /// The type of the listed names, `[&'static str; P]`, or `()` where there are none.
    type Parameters;
    /// The type that is stepped: the system, or its view with an input and a time.
    type View<'a>: ActingForce<N, Scalar = Self::Scalar>;

    /// The length of u.
    const INPUTS: usize;
    /// Whether L, R or f take the time.
    const TAKES_TIME: bool;
    /// The parameters by which steps are differentiated, as listed.
    const PARAMETERS: &'static [&'static str];

    /// The view with u at time t, as far as the system takes them; `copy` where it takes neither.
    fn view(&self, copy: Self, u: Self::Input, t: Self::Scalar) -> Self::View<'_>;
}

/// Implements [`Described`], and makes a macro of the system's name, which hands `input` and `time`, as far as
/// the system takes them, to another macro: how many arguments a function of C has is text, which no trait can
/// give.
#[doc(hidden)]
#[macro_export]
macro_rules! described {
    (
        $system:ident $([$view:ident $function:ident])?: $scalar:ident, $n:expr
        $(, input $u:ident $inputs:expr)? $(, time $time:ident)? $(, parameters [$($parameter:literal),+])?;
        $words:ident $dollar:tt
    ) => {
        #[automatically_derived]
        impl $crate::system::Described<{ $n }> for $system {
            type Scalar = $scalar;
            type Input = $crate::described!(@or () $(; [$scalar; $inputs])?);
            type Parameters = $crate::described!(@or () $(; [&'static str; [$($parameter),+].len()])?);
            type View<'a> = $crate::described!(@or Self $(; $view<'a>)?);

            const INPUTS: usize = 0 $(+ $inputs)?;
            const TAKES_TIME: bool = [$(stringify!($time),)? ""].len() == 2;
            const PARAMETERS: &'static [&'static str] = &[$($($parameter),+)?];

            #[inline]
            #[allow(unused_variables)]
            fn view(&self, itself: Self, u: Self::Input, t: $scalar) -> Self::View<'_> {
                $crate::described!(@view itself self $([$function])?, $([$u u])? $([$time t])?)
            }
        }

        #[doc(hidden)]
        #[allow(unused_macros)]
        macro_rules! $words {
            ($dollar then:path { $dollar($dollar before:tt)* }) => {
                $dollar then! { $dollar($dollar before)* $(input $u)? $(time $time)? }
            };
        }
        #[doc(hidden)]
        #[allow(unused_imports)]
        pub(crate) use $words as $system;
    };
    (@view $itself:ident $system:ident, ) => { $itself };
    (@view $itself:ident $system:ident [$function:ident], $([$name:ident $value:ident])+) => {
        $system.$function($($value),+)
    };
    (@or $other:tt) => { $other };
    (@or $other:tt; $($own:tt)+) => { $($own)+ };
}
