//! The functions that a system with constraints has besides.

/// Writes them into the module of [`c_functions!`](crate::c_functions), whose names they use.
#[doc(hidden)]
#[macro_export]
macro_rules! c_functions_on_constraints {
    ($prefix:ident $system:ident $(time $t:ident)?) => {
        #[unsafe(export_name = concat!(stringify!($prefix), "_violation"))]
        #[doc = "The first constraint that (q, v) violates, and by how much."]
        pub unsafe extern "C" fn violation(
            parameters: *const CFilled,
            $($t: CScalar,)?
            q: *const CVector,
            v: *const CVector,
            violation: *mut $crate::CViolation,
        ) -> $crate::Status {
            let given = $crate::c_functions!(@given , $($t)?);
            // SAFETY: the caller's promise.
            unsafe { constrained::violation::<CSystem, C_COORDINATES>(parameters, given, [q, v], violation) }
        }

        #[unsafe(export_name = concat!(stringify!($prefix), "_nearest"))]
        #[doc = "The configuration and velocity on all constraints that are nearest to (q, v)."]
        pub unsafe extern "C" fn nearest(
            parameters: *const CFilled,
            $($t: CScalar,)?
            q: *const CVector,
            v: *const CVector,
            nearest_q: *mut CVector,
            nearest_v: *mut CVector,
        ) -> $crate::Status {
            let (given, to) = ($crate::c_functions!(@given , $($t)?), [nearest_q, nearest_v]);
            // SAFETY: the caller's promise.
            unsafe { constrained::nearest::<CSystem, C_COORDINATES>(parameters, given, [q, v], to) }
        }

        #[unsafe(export_name = concat!(stringify!($prefix), "_reactions"))]
        #[doc = "The multipliers of the last step."]
        pub unsafe extern "C" fn reactions(
            memory: *const CMemory,
            lambda: *mut [CScalar; C_CONSTRAINTS],
        ) -> $crate::Status {
            // SAFETY: the caller's promise.
            unsafe { constrained::reactions::<CSystem, C_COORDINATES, C_CONSTRAINTS>(memory, lambda) }
        }
    };
}
