//! The macro that writes the functions of one system.

/// Writes the C functions of a system, and the header that declares them.
///
/// ```
/// use dalembert::{Midpoint, rayleigh_system};
///
/// dalembert_c::parameters! {
///     /// A cart on a rail.
///     pub struct Cart {
///         /// Mass in kg.
///         pub mass: f64,
///         /// Friction in N s/m.
///         pub friction: f64,
///     }
/// }
///
/// #[rayleigh_system(parameters = [mass])]
/// impl Cart {
///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * self.mass * v[0] * v[0]
///     }
///     fn rayleigh(&self, v: [f64; 1]) -> f64 {
///         0.5 * self.friction * v[0] * v[0]
///     }
///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
///         u
///     }
/// }
///
/// dalembert_c::c_api! {
///     cart: Cart, coordinates: 1, rule: Midpoint, driven: DrivenCart, inputs: 1, parameters: 1
/// }
///
/// fn main() {
///     assert!(cart::HEADER.to_string().contains("dalembert_status cart_step("));
/// }
/// ```
///
/// | entry | what it says |
/// |---|---|
/// | `cart: Cart` | the prefix of all names in C, and the struct, which [`parameters!`](crate::parameters) declares |
/// | `coordinates: 1` | N |
/// | `rule: Midpoint` | the rule: one of the attribute's, or `Gauss<4>` |
/// | `driven: DrivenCart, inputs: 1` | where the force takes an input: the type of the system with it, which the attribute makes, and its length |
/// | `driven: DrivenCart, inputs: 1, time` | where L, R or f take the time too |
/// | `at_time: CartAtTime` | where they take the time and no input |
/// | `parameters: 1` | how many parameters the attribute lists: the linearised step has derivatives by them. May be left out |
///
/// It makes a module of the prefix's name with the functions, which C calls and Rust cannot do without
/// `unsafe`, and `HEADER`, which is written by `HEADER.to_string()`.
#[macro_export]
macro_rules! c_api {
    ($prefix:ident: $system:ident, coordinates: $n:literal, rule: $rule:ty, driven: $view:ident, inputs: $inputs:literal, time
        $(, parameters: $parameters:literal)? $(,)?) => {
        $crate::c_api! { @functions $prefix $system $n [$rule] ['a $view<'a>] [$view<'static>] inputs [u $inputs] time [t CScalar]
            |system| system.driven(u, t), parameters [$($parameters)?] }
    };
    ($prefix:ident: $system:ident, coordinates: $n:literal, rule: $rule:ty, driven: $view:ident, inputs: $inputs:literal
        $(, parameters: $parameters:literal)? $(,)?) => {
        $crate::c_api! { @functions $prefix $system $n [$rule] ['a $view<'a>] [$view<'static>] inputs [u $inputs] time []
            |system| system.driven(u), parameters [$($parameters)?] }
    };
    ($prefix:ident: $system:ident, coordinates: $n:literal, rule: $rule:ty, at_time: $view:ident
        $(, parameters: $parameters:literal)? $(,)?) => {
        $crate::c_api! { @functions $prefix $system $n [$rule] ['a $view<'a>] [$view<'static>] inputs [] time [t CScalar]
            |system| system.at_time(t), parameters [$($parameters)?] }
    };
    ($prefix:ident: $system:ident, coordinates: $n:literal, rule: $rule:ty $(, parameters: $parameters:literal)? $(,)?) => {
        $crate::c_api! { @functions $prefix $system $n [$rule] ['a $system] [$system] inputs [] time []
            |system| *system, parameters [$($parameters)?] }
    };
    (@functions $prefix:ident $system:ident $n:literal [$rule:ty] [$life:lifetime $view:ty] [$kind:ty] inputs [$($u:ident $inputs:literal)?]
        time [$($t:ident $time:ident)?] |$of:ident| $call:expr, parameters [$($parameters:literal)?]) => {
        #[doc = concat!("The C functions of [`", stringify!($system), "`], `", stringify!($prefix), "_init` and so on; [`HEADER`](", stringify!($prefix), "::HEADER) declares them.")]
        ///
        /// # Safety
        /// What the header asks of its caller: an address that is not NULL is that of an object of the type
        /// declared, which no other thread uses meanwhile.
        #[allow(unsafe_code, clippy::missing_safety_doc, clippy::too_many_arguments)]
        pub mod $prefix {
            use super::*;
            // Types by their paths: the user's own may have the same names.
            use $crate::boundary::{calls, read};
            use $crate::dalembert::system::Scalar as _;
            use $crate::machine;

            const _: Option<machine::Checked<$kind, $rule, $n>> = None;
            type CScalar = <CSystem as machine::Interface<$n>>::Scalar;
            type CVector = [CScalar; $n];

            /// The system as C sees it.
            pub enum CSystem {}

            /// The caller's memory: opaque in C.
            pub type CMemory = calls::Memory<CSystem, $n>;

            const TIMES: usize = [$(stringify!($t),)? ""].len() - 1;
            const LAYOUT: u64 = $crate::layout(
                <$system as $crate::Fields>::FIELDS,
                &[stringify!($prefix), stringify!($rule), <CScalar as $crate::CType>::BASE],
                &[$n, 0 $(+ $inputs)?, 0 $(+ $parameters)?, TIMES, size_of::<$system>()],
            );
            const _: () = assert!(align_of::<CMemory>() <= 8, "the header aligns the memory to 8 bytes");

            /// The header that declares these functions.
            pub const HEADER: $crate::Header = $crate::Header {
                prefix: stringify!($prefix),
                rule: stringify!($rule),
                layout: LAYOUT,
                documentation: <$system as $crate::Fields>::DOCUMENTATION,
                fields: <$system as $crate::Fields>::FIELDS,
                parameters_size: size_of::<$system>(),
                memory_size: size_of::<CMemory>(),
                scalar: <CScalar as $crate::CType>::BASE,
                coordinates: $n,
                inputs: 0 $(+ $inputs)?,
                takes_time: TIMES == 1,
                parameters: [$(&<$kind as $crate::dalembert::system::Parameters<$n, $parameters>>::PARAMETERS as &[&str],)? &[]][0],
            };

            /// The derivatives of a step, row by row.
            #[derive(Clone, Copy, Debug)]
            #[repr(C)]
            pub struct CLinearized {
                /// ∂(q1, p1)/∂(q0, p0).
                pub by_state: [[CScalar; 2 * $n]; 2 * $n],
                $(
                    /// ∂(q1, p1)/∂u.
                    pub by_input: [[CScalar; $inputs]; 2 * $n],
                )?
                $(
                    /// ∂(q1, p1)/∂θ.
                    pub by_parameters: [[CScalar; $parameters]; 2 * $n],
                )?
            }

            // SAFETY: repr(C), arrays of numbers of one type alone.
            unsafe impl $crate::boundary::Plain for CLinearized {}

            impl machine::Interface<$n> for CSystem {
                const SIGNATURE: u64 = LAYOUT;
                type Parameters = $system;
                type Rule = $rule;
                type Scalar = <$kind as $crate::dalembert::Lagrangian<$n>>::Scalar;
                type Given = ($([CScalar; $inputs],)? $($time,)?);
                type Linearized = CLinearized;
                type RunMemory = <$kind as $crate::dalembert::step::Flow<$rule, $n>>::RunMemory;
                type Kind = $kind;
                type View<$life> = $view;

                fn given(input: &[CScalar], time: CScalar) -> Option<Self::Given> {
                    let _ = (input, time);
                    Some(($(<[CScalar; $inputs]>::try_from(input).ok()?,)? $({ let $t: $time = time; $t },)?))
                }

                fn view($of: &$system, ($($u,)? $($t,)?): Self::Given) -> Self::View<'_> {
                    $call
                }

                fn linearized(
                    taken: &$crate::dalembert::step::StepTaken<'_, Self::View<'_>, $rule, $n>,
                ) -> Result<CLinearized, $crate::dalembert::StepError> {
                    Ok(CLinearized {
                        by_state: machine::rows_by_state(&taken.by_state()?),
                        $(by_input: machine::rows_by(&taken.by_input::<$inputs>()?),)?
                        $(by_parameters: machine::rows_by(&taken.by_parameters::<$parameters>()?),)?
                    })
                }

                fn rows(linearized: &CLinearized) -> [&[CScalar]; 3] {
                    [
                        linearized.by_state.as_flattened(),
                        [$(<[[CScalar; $inputs]]>::as_flattened(&linearized.by_input),)? &[]][0],
                        [$(<[[CScalar; $parameters]]>::as_flattened(&linearized.by_parameters),)? &[]][0],
                    ]
                }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_init_with"))]
            #[doc = "Begins a run at (q, v)."]
            pub unsafe extern "C" fn init_with(
                memory: *mut CMemory,
                size: usize,
                layout: u64,
                parameters: *const $system,
                h: CScalar,
                $($t: $time,)?
                q: *const CVector,
                v: *const CVector,
            ) -> $crate::Status {
                let given = || Ok(($([CScalar::constant(0.0); $inputs],)? $(machine::time($t)?,)?));
                // SAFETY: the caller's promise.
                unsafe { calls::init::<CSystem, $n>(memory, (size, layout), parameters, h, given, [q, v]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_step"))]
            #[doc = "Takes a step."]
            pub unsafe extern "C" fn step(
                memory: *mut CMemory,
                $($u: *const [CScalar; $inputs],)?
                $($t: $time,)?
                report: *mut $crate::CReport,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::step::<CSystem, $n>(memory, || Ok(($(machine::input(read($u)?)?,)? $(machine::time($t)?,)?)), report) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_step_linearized"))]
            #[doc = "Takes a step, and linearises it."]
            pub unsafe extern "C" fn step_linearized(
                memory: *mut CMemory,
                $($u: *const [CScalar; $inputs],)?
                $($t: $time,)?
                report: *mut $crate::CReport,
                linearized: *mut CLinearized,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::step_linearized::<CSystem, $n>(memory, || Ok(($(machine::input(read($u)?)?,)? $(machine::time($t)?,)?)), report, linearized) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_state"))]
            #[doc = "The present (q, p); either may be NULL."]
            pub unsafe extern "C" fn state(
                memory: *const CMemory,
                q: *mut CVector,
                p: *mut CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::state::<CSystem, $n>(memory, [q, p]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_velocity"))]
            #[doc = "The velocity of the present state."]
            pub unsafe extern "C" fn velocity(
                memory: *const CMemory,
                $($t: $time,)?
                v: *mut CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::velocity::<CSystem, $n>(memory, || Ok(($([CScalar::constant(0.0); $inputs],)? $(machine::time($t)?,)?)), v) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_energy"))]
            #[doc = "The energy of the present state."]
            pub unsafe extern "C" fn energy(
                memory: *const CMemory,
                $($t: $time,)?
                energy: *mut CScalar,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::energy::<CSystem, $n>(memory, || Ok(($([CScalar::constant(0.0); $inputs],)? $(machine::time($t)?,)?)), energy) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_time"))]
            #[doc = "The time since the start."]
            pub unsafe extern "C" fn time(
                memory: *const CMemory,
                time: *mut f64,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::time::<CSystem, $n>(memory, time) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_state_after"))]
            #[doc = "The state some time from now, by one step from the present state, which stays."]
            pub unsafe extern "C" fn state_after(
                memory: *const CMemory,
                $($u: *const [CScalar; $inputs],)?
                $($t: $time,)?
                after: CScalar,
                q: *mut CVector,
                p: *mut CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::state_after::<CSystem, $n>(memory, || Ok(($(machine::input(read($u)?)?,)? $(machine::time($t)?,)?)), after, [q, p]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_set_state"))]
            #[doc = "Goes on from (q, p); the guess for the next step is kept."]
            pub unsafe extern "C" fn set_state(
                memory: *mut CMemory,
                q: *const CVector,
                p: *const CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::set_state::<CSystem, $n>(memory, [q, p]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_set_parameters"))]
            #[doc = "Goes on with other parameters."]
            pub unsafe extern "C" fn set_parameters(
                memory: *mut CMemory,
                parameters: *const $system,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::set_parameters::<CSystem, $n>(memory, parameters) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_set_step_size"))]
            #[doc = "Goes on with another step size."]
            pub unsafe extern "C" fn set_step_size(
                memory: *mut CMemory,
                h: CScalar,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::set_step_size::<CSystem, $n>(memory, h) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_text"))]
            #[doc = "What a status says."]
            pub extern "C" fn text(status: i32) -> *const core::ffi::c_char {
                $crate::text(status)
            }
        }
    };
}
