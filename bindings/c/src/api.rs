//! The macro that writes the functions of one system.

mod constrained;

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
/// dalembert_c::c_api! { cart: Cart, rule: Midpoint }
///
/// fn main() {
///     assert!(cart::HEADER.to_string().contains("dalembert_status cart_step("));
/// }
/// ```
///
/// `cart` is the prefix of all names in C; `Cart` the struct, which [`parameters!`](crate::parameters) declares
/// and the attribute describes, imported by its name where it stands in another module of the crate; the rule
/// one of the attribute's, or `Gauss<4>`. The functions take u and t where L, R or f do, and a linearised step
/// has derivatives by the parameters that the attribute lists. Of a system of another crate one says besides
/// what the functions take, `takes: [u, t]`, `[u]`, `[t]` or `[]`, and how many constraints there are, if any,
/// `constraints: 1`: it is held against the system.
///
/// It makes a module of the prefix's name with the functions, which C calls and Rust cannot do without
/// `unsafe`, and `HEADER`, which is written by `HEADER.to_string()`.
#[macro_export]
macro_rules! c_api {
    ($prefix:ident: $system:ident, rule: $rule:ty $(,)?) => {
        $system! { $crate::c_functions { $prefix $system [$rule] } }
    };
    ($prefix:ident: $system:ident, rule: $rule:ty, takes: [$($taken:ident),*] $(, constraints: $m:expr)? $(,)?) => {
        $crate::c_api! { @taken [$($taken)*] $prefix $system [$rule] $(constraints $m)? }
    };
    (@taken [] $prefix:ident $system:ident [$rule:ty] $($held:tt)*) => {
        $crate::c_functions! { $prefix $system [$rule] $($held)* }
    };
    (@taken [u] $prefix:ident $system:ident [$rule:ty] $($held:tt)*) => {
        $crate::c_functions! { $prefix $system [$rule] input u $($held)* }
    };
    (@taken [t] $prefix:ident $system:ident [$rule:ty] $($held:tt)*) => {
        $crate::c_functions! { $prefix $system [$rule] time t $($held)* }
    };
    (@taken [u t] $prefix:ident $system:ident [$rule:ty] $($held:tt)*) => {
        $crate::c_functions! { $prefix $system [$rule] input u time t $($held)* }
    };
}

/// Writes what [`c_api!`](crate::c_api) promises, with u and t where the system takes them.
#[doc(hidden)]
#[macro_export]
macro_rules! c_functions {
    ($prefix:ident $system:ident [$rule:ty] $(input $u:ident)? $(time $t:ident)? $(constraints $m:expr)?) => {
        #[doc = concat!("The C functions of [`", stringify!($system), "`], `", stringify!($prefix), "_init` and so on; [`HEADER`](", stringify!($prefix), "::HEADER) declares them.")]
        ///
        /// # Safety
        /// What the header asks of its caller: an address that is not NULL is that of an object of the type
        /// declared, which no other thread uses meanwhile.
        #[allow(unsafe_code, clippy::missing_safety_doc, clippy::too_many_arguments)]
        pub mod $prefix {
            use super::*;
            // Types by their paths: the user's own may have the same names.
            use $crate::boundary::{calls, constrained, machine, read, tables};
            use $crate::dalembert::system::Scalar as _;

            const C_COORDINATES: usize = $crate::face::coordinates(core::marker::PhantomData::<fn() -> $system>);
            type CInput = <$system as $crate::face::Described<C_COORDINATES>>::Input;
            const C_INPUTS: usize = <$system as $crate::face::Described<C_COORDINATES>>::INPUTS;
            const C_CONSTRAINTS: usize = <$system as $crate::face::Described<C_COORDINATES>>::CONSTRAINTS;
            const C_PARAMETERS: &[&str] = <$system as $crate::face::Described<C_COORDINATES>>::PARAMETERS;

            const _: () = assert!(
                (C_INPUTS > 0) == $crate::c_functions!(@or false; $(!stringify!($u).is_empty())?)
                    && <$system as $crate::face::Described<C_COORDINATES>>::TAKES_TIME
                        == $crate::c_functions!(@or false; $(!stringify!($t).is_empty())?),
                "`takes` has u where the force takes an input, and t where L, R or f take the time",
            );
            const _: () = assert!(
                C_CONSTRAINTS == $crate::c_functions!(@or 0; $($m)?),
                "`constraints:` is the number of constraints, and stands where there are some",
            );
            type CScalar = <$system as $crate::face::Described<C_COORDINATES>>::Scalar;
            type CVector = [CScalar; C_COORDINATES];
            type CFilled = <$system as $crate::face::Fields>::Given;

            /// The system as C sees it.
            pub enum CSystem {}

            /// The caller's memory: opaque in C.
            pub type CMemory = calls::Memory<CSystem, C_COORDINATES>;

            const LAYOUT: u64 = $crate::face::layout::<$system, C_COORDINATES>(stringify!($prefix), stringify!($rule));

            /// The header that declares these functions.
            pub const HEADER: $crate::Header = $crate::Header {
                prefix: stringify!($prefix),
                rule: stringify!($rule),
                layout: LAYOUT,
                documentation: <$system as $crate::face::Fields>::DOCUMENTATION,
                fields: <$system as $crate::face::Fields>::FIELDS,
                parameters_size: size_of::<CFilled>(),
                memory_size: size_of::<CMemory>,
                scalar: <CScalar as $crate::face::FieldType>::BASE,
                coordinates: C_COORDINATES,
                inputs: C_INPUTS,
                takes_time: <$system as $crate::face::Described<C_COORDINATES>>::TAKES_TIME,
                constraints: C_CONSTRAINTS,
                parameters: C_PARAMETERS,
            };

            /// The derivatives of a step, row by row.
            #[derive(Clone, Copy, Debug)]
            #[repr(C)]
            pub struct CLinearized {
                /// ∂(q1, p1)/∂(q0, p0).
                pub by_state: [[CScalar; 2 * C_COORDINATES]; 2 * C_COORDINATES],
                /// ∂(q1, p1)/∂u; nothing without an input.
                pub by_input: [[CScalar; C_INPUTS]; 2 * C_COORDINATES],
                /// ∂(q1, p1)/∂θ; nothing where no parameters are listed.
                pub by_parameters: [[CScalar; C_PARAMETERS.len()]; 2 * C_COORDINATES],
            }

            // SAFETY: repr(C), arrays of numbers of one type alone.
            unsafe impl $crate::boundary::Plain for CLinearized {}

            impl machine::Entered<C_COORDINATES> for CSystem {
                const SIGNATURE: u64 = LAYOUT;
                type Of = $crate::face::By<$system, $rule>;
                type Linearized = CLinearized;

                fn linearized(
                    taken: &machine::Taken<'_, '_, Self, C_COORDINATES>,
                ) -> Result<CLinearized, $crate::dalembert::StepError> {
                    let (by_state, by_input, by_parameters) = machine::rows::<Self::Of, _, _, _, _>(taken)?;
                    Ok(CLinearized { by_state, by_input, by_parameters })
                }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_init_with"))]
            #[doc = "Begins a run at (q, v)."]
            pub unsafe extern "C" fn init_with(
                memory: *mut CMemory,
                size: usize,
                layout: u64,
                parameters: *const CFilled,
                h: CScalar,
                $($t: CScalar,)?
                q: *const CVector,
                v: *const CVector,
            ) -> $crate::Status {
                let given = $crate::c_functions!(@given , $($t)?);
                // SAFETY: the caller's promise.
                unsafe { calls::init::<CSystem, C_COORDINATES>(memory, (size, layout), parameters, h, given, [q, v]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_step"))]
            #[doc = "Takes a step."]
            pub unsafe extern "C" fn step(
                memory: *mut CMemory,
                $($u: *const CInput,)?
                $($t: CScalar,)?
                report: *mut $crate::CReport,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::step::<CSystem, C_COORDINATES>(memory, $crate::c_functions!(@given $($u)?, $($t)?), report) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_step_linearized"))]
            #[doc = "Takes a step, and linearises it."]
            pub unsafe extern "C" fn step_linearized(
                memory: *mut CMemory,
                $($u: *const CInput,)?
                $($t: CScalar,)?
                report: *mut $crate::CReport,
                linearized: *mut CLinearized,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::step_linearized::<CSystem, C_COORDINATES>(memory, $crate::c_functions!(@given $($u)?, $($t)?), report, linearized) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_state"))]
            #[doc = "The present (q, p); either may be NULL."]
            pub unsafe extern "C" fn state(
                memory: *const CMemory,
                q: *mut CVector,
                p: *mut CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::state::<CSystem, C_COORDINATES>(memory, [q, p]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_velocity"))]
            #[doc = "The velocity of the present state."]
            pub unsafe extern "C" fn velocity(
                memory: *const CMemory,
                $($t: CScalar,)?
                v: *mut CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::velocity::<CSystem, C_COORDINATES>(memory, $crate::c_functions!(@given , $($t)?), v) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_energy"))]
            #[doc = "The energy of the present state."]
            pub unsafe extern "C" fn energy(
                memory: *const CMemory,
                $($t: CScalar,)?
                energy: *mut CScalar,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::energy::<CSystem, C_COORDINATES>(memory, $crate::c_functions!(@given , $($t)?), energy) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_time"))]
            #[doc = "The time since the start."]
            pub unsafe extern "C" fn time(
                memory: *const CMemory,
                time: *mut f64,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::time::<CSystem, C_COORDINATES>(memory, time) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_state_after"))]
            #[doc = "The state some time from now, by one step from the present state, which stays."]
            pub unsafe extern "C" fn state_after(
                memory: *const CMemory,
                $($u: *const CInput,)?
                $($t: CScalar,)?
                after: CScalar,
                q: *mut CVector,
                p: *mut CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::state_after::<CSystem, C_COORDINATES>(memory, $crate::c_functions!(@given $($u)?, $($t)?), after, [q, p]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_set_state"))]
            #[doc = "Goes on from (q, p); the guess for the next step is kept."]
            pub unsafe extern "C" fn set_state(
                memory: *mut CMemory,
                q: *const CVector,
                p: *const CVector,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::set_state::<CSystem, C_COORDINATES>(memory, [q, p]) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_set_parameters"))]
            #[doc = "Goes on with other parameters."]
            pub unsafe extern "C" fn set_parameters(
                memory: *mut CMemory,
                parameters: *const CFilled,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::set_parameters::<CSystem, C_COORDINATES>(memory, parameters) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_wrong_point"))]
            #[doc = "The first table whose points make none, and which of them is wrong."]
            pub unsafe extern "C" fn wrong_point(
                parameters: *const CFilled,
                wrong: *mut $crate::CWrongPoint,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { tables::wrong_point::<CSystem, C_COORDINATES>(parameters, wrong) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_set_step_size"))]
            #[doc = "Goes on with another step size."]
            pub unsafe extern "C" fn set_step_size(
                memory: *mut CMemory,
                h: CScalar,
            ) -> $crate::Status {
                // SAFETY: the caller's promise.
                unsafe { calls::set_step_size::<CSystem, C_COORDINATES>(memory, h) }
            }

            #[unsafe(export_name = concat!(stringify!($prefix), "_text"))]
            #[doc = "What a status says."]
            pub extern "C" fn text(status: i32) -> *const core::ffi::c_char {
                $crate::text(status)
            }

            $crate::c_functions! { @on_constraints [$($m)?] $prefix $system $(time $t)? }
        }
    };
    (@on_constraints [] $($system:tt)*) => {};
    (@on_constraints [$m:expr] $($system:tt)*) => {
        $crate::c_functions_on_constraints! { $($system)* }
    };
    // u and t of a call, 0 where it has none.
    (@given $($u:ident)?, $($t:ident)?) => {
        || Ok((
            $crate::c_functions!(@or <CInput as $crate::face::Input<CScalar>>::zero(); $(machine::input(read($u)?)?)?),
            $crate::c_functions!(@or CScalar::constant(0.0); $(machine::time($t)?)?),
        ))
    };
    (@or $other:expr;) => { $other };
    (@or $other:expr; $own:expr) => { $own };
}
