//! A system as a functional mock-up unit: FMI 3.0 and 2.0, co-simulation.
//!
//! In a crate of its own, `crate-type = ["cdylib", "rlib"]`, [`parameters!`] declares the struct of the
//! system's fields, and [`fmu!`] names the system, its rule, its step size and its start.
//! `UNIT.pack("cart_pole.fmu")` writes the unit; `examples/fmu/` is the template. `UNIT.pack_fmi2` writes one
//! of FMI 2.0.
//!
//! | variable | what it is |
//! |---|---|
//! | `time` | the time |
//! | the fields of the struct | parameters, tunable: `cart`, `friction[1]`, `weights[0,2]`; a line `Unit: kg` of a field's documentation is its unit |
//! | `step_size` | h, a fixed parameter: what it leaves of a communication step is a shorter step |
//! | `u[0]` … | the inputs, each held over a communication step |
//! | `q[0]` …, `v[0]` … | configuration and velocity: outputs, with the start values of the run |
//! | `p[0]` …, `energy` | momenta and energy: outputs |
//! | `lambda[0]` … | of a system with constraints: reactions over the last step, outputs |
//! | `y[0]` … | of a block with `fn outputs`: its values at the communication point, outputs |
//!
//! A parameter that changes between steps leaves (q, p), so that momenta are continuous.
//!
//! On constraints the start values of `q` and `v` are guesses, `initial="approx"`: initialization solves for
//! the nearest state on all constraints, and fails, with the constraint in the log, where none is in reach.
//!
//! The state of a unit can be read and set, and goes on bit by bit as it would have. Written as bytes it is
//! (q, p), the clock, inputs and parameters, without what the solver remembers of earlier steps: read back,
//! it goes on within rounding.
//!
//! Directional derivatives after a communication step are those of its end: by `u` held over it, by `q` and
//! `p` at its beginning and by the parameters that `#[rayleigh_system(parameters = […])]` lists, of `q`, `p`,
//! `v` and `energy`. In initialization mode they are those of `p` and `energy` by `q` and `v`, unless
//! constraints hold these.
//!
//! A line of the documentation of the struct, or of `fn outputs`, names `u[0]`, `q[0]`, `v[0]`, `p[0]` or
//! `y[0]`, describes it and gives its unit, each if it likes:
//!
//! ```text
//! /// - `q[0]` position: of the cart on the rail. Unit: m
//! /// - `u[0]`: force on the cart. Unit: N
//! ```
//!
//! Packing refuses lines about a variable that there is not, and names that are none: [`NamingError`].
//!
//! A call that fails changes nothing and says why to the importer's log. A communication step that is not
//! positive is `fmi3Discard`; a step that cannot be solved is `fmi3Error` with the text of its
//! [`StepError`](dalembert::StepError), and leaves the unit where the communication step began. In FMI 2.0
//! both are `fmi2Error`. An output that is NaN or infinite is an error of the call that asks for it. A panic
//! in the block is `fmi3Fatal`.

#[doc(hidden)]
pub use dalembert;
#[doc(hidden)]
pub use dalembert_face as face;
pub use dalembert_face::fields as parameters;

#[doc(hidden)]
pub mod boundary;
mod cosimulation;
mod description;
mod model;
mod package;
mod refusal;
mod unit;
mod variables;

pub use unit::Unit;
pub use variables::NamingError;

/// Writes the functions of FMI for a system, and `UNIT`, which packs it.
///
/// ```
/// use dalembert::{Midpoint, rayleigh_system};
///
/// dalembert_fmu::parameters! {
///     /// A cart on a rail.
///     pub struct Cart {
///         /// Mass.
///         /// Unit: kg
///         pub mass: f64,
///         /// Friction of the rail.
///         /// Unit: N s/m
///         pub friction: f64,
///     }
/// }
///
/// #[rayleigh_system]
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
/// dalembert_fmu::fmu! {
///     cart: Cart,
///     rule: Midpoint,
///     step_size: 0.01,
///     parameters: Cart { mass: 2.0, friction: 0.1 },
///     q: [0.0],
///     v: [1.0],
/// }
///
/// fn main() {
///     assert!(UNIT.description().contains(r#"name="friction""#));
/// }
/// ```
///
/// The entries are the name of the unit and the struct of the system, its rule, h, the parameters, and the
/// start, the last three each until the importer sets another. A library holds one unit: FMI names its
/// functions alike in all. A field that has the name of another variable of the unit is refused:
///
/// ```compile_fail,E0080
/// # use dalembert::{Midpoint, rayleigh_system};
/// dalembert_fmu::parameters! {
///     /// A cart on a rail.
///     pub struct Cart {
///         /// Mass.
///         pub energy: f64,
///     }
/// }
/// # #[rayleigh_system]
/// # impl Cart {
/// #     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
/// #         0.5 * self.energy * v[0] * v[0]
/// #     }
/// # }
/// dalembert_fmu::fmu! {
///     cart: Cart, rule: Midpoint, step_size: 0.01, parameters: Cart { energy: 2.0 }, q: [0.0], v: [1.0]
/// }
/// # fn main() {}
/// ```
#[macro_export]
macro_rules! fmu {
    ($name:ident: $system:ident, rule: $rule:ty, step_size: $h:expr, parameters: $parameters:expr, q: $q:expr, v: $v:expr $(,)?) => {
        /// The unit: its description, and how it is packed.
        pub static UNIT: $crate::Unit<
            $crate::face::By<$system, $rule>,
            { $crate::face::coordinates(::core::marker::PhantomData::<fn() -> $system>) },
        > = $crate::Unit::new(
            [stringify!($name), stringify!($rule)],
            env!("CARGO_CRATE_NAME"),
            $h,
            $parameters,
            [$q, $v],
        );

        #[allow(unsafe_code, non_snake_case, clippy::too_many_arguments)]
        #[unsafe(no_mangle)]
        #[doc = "Begins an instance of the unit."]
        ///
        /// # Safety
        /// Texts are NULL or ended by a zero byte; the callback is one of FMI.
        pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
            instance_name: *const ::core::ffi::c_char,
            instantiation_token: *const ::core::ffi::c_char,
            _resource_path: *const ::core::ffi::c_char,
            _visible: bool,
            logging_on: bool,
            event_mode_used: bool,
            _early_return_allowed: bool,
            _required_intermediate_variables: *const u32,
            _required_intermediate_variables_length: usize,
            environment: *mut ::core::ffi::c_void,
            log_message: ::core::option::Option<$crate::boundary::LogMessage>,
            _intermediate_update: ::core::option::Option<unsafe extern "C" fn()>,
        ) -> *mut $crate::boundary::Instance {
            let log = $crate::boundary::Log::new(log_message, environment, logging_on);
            // SAFETY: the importer's promise.
            unsafe {
                $crate::boundary::instantiate(&UNIT, instance_name, instantiation_token, event_mode_used, log)
            }
        }

        #[allow(unsafe_code, non_snake_case)]
        #[unsafe(no_mangle)]
        #[doc = "Begins an instance of the unit, by FMI 2.0."]
        ///
        /// # Safety
        /// Texts are NULL or ended by a zero byte; the callbacks are those of FMI.
        pub unsafe extern "C" fn fmi2Instantiate(
            instance_name: *const ::core::ffi::c_char,
            kind: i32,
            guid: *const ::core::ffi::c_char,
            _resource_location: *const ::core::ffi::c_char,
            callbacks: *const $crate::boundary::Callbacks,
            _visible: i32,
            logging_on: i32,
        ) -> *mut $crate::boundary::Instance {
            // SAFETY: the importer's promise.
            unsafe {
                $crate::boundary::instantiate_two(
                    &UNIT,
                    instance_name,
                    kind,
                    guid,
                    callbacks,
                    logging_on != 0,
                )
            }
        }
    };
}
