//! Python modules of systems that `#[rayleigh_system]` generates: runs, derivatives and energies as NumPy arrays.
//!
//! In a crate of its own, `crate-type = ["cdylib"]`, [`parameters!`] declares the struct of a system's fields and [`module!`]
//! names the systems; maturin builds the module. `examples/python/` is the template, and `docs/python.md` its guide.
//!
//! | in Python | |
//! |---|---|
//! | `ring = Ring(k=1e-3)` | a class a system, its fields attributes with their documentation |
//! | `ring.run(h=0.1, steps=1000, q=…, v=…)` | the motion: arrays `t`, `q`, `v`, `p`, `energy` |
//! | `ring.run(tolerance=1e-9, until=100.0, q=…, v=…)` | the same to an error asked for |
//! | `ring.ensemble(h=0.1, steps=1000, q=…, v=…)` | many members on all cores: arrays, or Parquet files that are their own checkpoint |
//! | `ring.linearization(h=0.1, q=…, v=…)` | a step with A, B and derivatives by parameters |
//! | `ring.energy(q=…, v=…)` | energies |
//! | `Ring.RULES`, `Ring.STRUCTURE`, … | what is known of the class |
//!
//! A run is one call: it takes its steps without the lock of the interpreter, hands its arrays over without a copy, and
//! ends at Ctrl-C. Steps are those of the run in Rust, bit by bit. A step that fails is the exception `StepError` with
//! what the error of Rust knows.

#[doc(hidden)]
pub use dalembert;
pub use dalembert_c::fields as parameters;
#[doc(hidden)]
pub use pyo3;

mod arguments;
mod arrays;
#[doc(hidden)]
pub mod checks;
mod class;
mod crossings;
#[doc(hidden)]
pub mod derivatives;
mod ensemble;
mod error;
#[doc(hidden)]
pub mod events;
mod linearization;
#[doc(hidden)]
pub mod many;
#[doc(hidden)]
pub mod model;
#[doc(hidden)]
pub mod module;
#[doc(hidden)]
pub mod motion;
#[doc(hidden)]
pub mod offer;
mod pickled;
mod pool;
#[doc(hidden)]
pub mod record;
#[doc(hidden)]
pub mod refusal;
mod reports;
mod results;
mod structure;
mod stub;
#[doc(hidden)]
pub mod system;
#[doc(hidden)]
pub mod together;
#[doc(hidden)]
pub mod watch;
mod watched;
mod watching;

/// Writes the Python module of some systems.
///
/// ```no_run
/// use dalembert::rayleigh_system;
///
/// dalembert_python::parameters! {
///     /// A cart on a rail; u is the force on it in N.
///     pub struct Cart {
///         /// Mass, kg.
///         pub mass: f64,
///         /// Friction of the rail, N s/m.
///         pub friction: f64,
///     }
/// }
///
/// #[rayleigh_system(parameters = [mass, friction])]
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
/// dalembert_python::module!(machines { Cart { driven: DrivenCart, inputs: 1, parameters: 2 } });
/// # fn main() {}
/// ```
///
/// The name is that of the library, which Python imports. A system without an input and without the time is its name
/// alone; in braces behind others stands
///
/// | entry | what it says |
/// |---|---|
/// | `driven: DrivenCart, inputs: 1` | where the force takes an input: the type of the system with it, which the attribute makes, and its length |
/// | `driven: DrivenCart, inputs: 1, time` | where L, R or f take the time too |
/// | `at_time: CartAtTime` | where they take the time and no input |
/// | `parameters: 2` | how many parameters the attribute lists |
///
/// N and the rules are found. Systems are in `f64`.
#[macro_export]
macro_rules! module {
    ($name:ident { $($system:ident $({ $($entry:tt)* })?),+ $(,)? }) => {
        /// The type that `System` is implemented for: the systems may be of another crate.
        struct DalembertPython<S>(::core::marker::PhantomData<S>);

        $($crate::system! { DalembertPython $system { $($($entry)*)? } })+

        #[$crate::pyo3::pymodule(gil_used = false)]
        #[pyo3(crate = "dalembert_python::pyo3")]
        fn $name(
            module: &$crate::pyo3::Bound<'_, $crate::pyo3::types::PyModule>,
        ) -> $crate::pyo3::PyResult<()> {
            static KINDS: &[&dyn $crate::model::Kind] = &[
                $(&$crate::model::KindOf::<DalembertPython<$system>, _>(::core::marker::PhantomData),)+
            ];
            $crate::module::fill(module, KINDS)
        }
    };
}

/// Implements [`system::System`] for one entry of [`module!`].
#[doc(hidden)]
#[macro_export]
macro_rules! system {
    ($of:ident $system:ident { driven: $view:ident, inputs: $inputs:literal, time $(, parameters: $parameters:literal)? $(,)? }) => {
        $crate::system! { @implement $of $system ['a $view<'a>] [$view<'static>] input [u $inputs] time [t]
            |fields| fields.driven(u, t), parameters [$($parameters)?] }
    };
    ($of:ident $system:ident { driven: $view:ident, inputs: $inputs:literal $(, parameters: $parameters:literal)? $(,)? }) => {
        $crate::system! { @implement $of $system ['a $view<'a>] [$view<'static>] input [u $inputs] time []
            |fields| fields.driven(u), parameters [$($parameters)?] }
    };
    ($of:ident $system:ident { at_time: $view:ident $(, parameters: $parameters:literal)? $(,)? }) => {
        $crate::system! { @implement $of $system ['a $view<'a>] [$view<'static>] input [] time [t]
            |fields| fields.at_time(t), parameters [$($parameters)?] }
    };
    ($of:ident $system:ident { $(parameters: $parameters:literal)? $(,)? }) => {
        $crate::system! { @implement $of $system ['a $system] [$system] input [] time []
            |fields| *fields, parameters [$($parameters)?] }
    };
    (@input) => { $crate::derivatives::NoInput };
    (@input $inputs:literal) => { $crate::derivatives::Input<$inputs> };
    (@parameters) => { $crate::derivatives::NoParameters };
    (@parameters $parameters:literal) => { $crate::derivatives::Parameters<$parameters> };
    (@implement $of:ident $system:ident [$life:lifetime $view:ty] [$kind:ty] input [$($u:ident $inputs:literal)?] time [$($t:ident)?]
        |$fields:ident| $call:expr, parameters [$($parameters:literal)?]) => {
        const _: () = {
            use ::core::marker::PhantomData;
            use $crate::offer::NoStepsToError as _;

            const N: usize = $crate::system::coordinates(PhantomData::<fn() -> $kind>);
            const TIMES: usize = [$(stringify!($t),)? ""].len() - 1;

            impl $crate::system::System<N> for $of<$system> {
                const NAME: &'static str = stringify!($system);
                const INPUTS: usize = 0 $(+ $inputs)?;
                const TAKES_TIME: bool = TIMES == 1;
                const PARAMETERS: &'static [&'static str] =
                    [$(&<$kind as $crate::dalembert::system::Parameters<N, $parameters>>::PARAMETERS as &[&str],)? &[]][0];
                type Input = $crate::system! { @input $($inputs)? };
                type Parameters = $crate::system! { @parameters $($parameters)? };
                type Fields = $system;
                type View<$life> = $view;
                type Kind = $kind;

                fn view<'a>($fields: &'a $system, input: &[f64], time: f64) -> Self::View<'a> {
                    let _ = (input, time);
                    $(let mut $u = [0.0; $inputs]; $u.copy_from_slice(input);)?
                    $(let $t = time;)?
                    $call
                }

                fn offers() -> ::std::vec::Vec<$crate::offer::Offer<Self, N>> {
                    $crate::offers!(Self, N)
                }

                fn steps_to_error() -> ::core::option::Option<::std::boxed::Box<dyn $crate::offer::StepsToError<Self, N>>> {
                    $crate::offer::Probe::<Self, (), N>::new(()).steps_to_error()
                }
            }
        };
    };
}

/// Lists the offers of all methods to a system; a method that has no step for it offers nothing.
#[doc(hidden)]
#[macro_export]
macro_rules! offers {
    ($system:ty, $n:ident) => {
        $crate::offers! { $system, $n:
            displacement
            "midpoint" $crate::dalembert::Midpoint,
            "trapezoidal" $crate::dalembert::Trapezoidal,
            "fitted" $crate::dalembert::Fitted,
            "fitted_trapezoidal" $crate::dalembert::FittedTrapezoidal,
            "one_sided" $crate::dalembert::OneSided;
            gauss
            "gauss_2" $crate::dalembert::Gauss::<2>,
            "gauss_4" $crate::dalembert::Gauss::<4>,
            "gauss_6" $crate::dalembert::Gauss::<6>,
            "gauss_8" $crate::dalembert::Gauss::<8>;
            splittings
            "blanes_moan_4" $crate::dalembert::Splitting::blanes_moan_4(),
            "blanes_moan_6" $crate::dalembert::Splitting::blanes_moan_6(),
            "blanes_casas_escorihuela_8" $crate::dalembert::Splitting::blanes_casas_escorihuela_8();
        }
    };
    (
        $system:ty, $n:ident:
        displacement $($rule:literal $by:expr),*;
        gauss $($gauss:literal $stages:expr),*;
        splittings $($splitting:literal $kicks:expr),*;
    ) => {{
        use $crate::checks::NoChecks as _;
        use $crate::offer::{NoDifferentiatedSteps as _, NoDrivenSteps as _, NoSteps as _, NoStepsInLanes as _};
        ::std::vec![
            $({
                let probe = $crate::offer::Probe::<$system, _, $n>::new($by);
                $crate::offer::Offer {
                    name: $rule,
                    steps: probe.steps_in_lanes().or_else(|| probe.steps()),
                    driven: probe.driven_steps(),
                    differentiated: None,
                    checks: probe.checks(),
                }
            },)*
            $({
                let probe = $crate::offer::Probe::<$system, _, $n>::new($stages);
                $crate::offer::Offer {
                    name: $gauss,
                    steps: probe.steps_in_lanes().or_else(|| probe.steps()),
                    driven: probe.driven_steps(),
                    differentiated: None,
                    checks: None,
                }
            },)*
            $({
                let probe = $crate::offer::Probe::<$system, _, $n>::new($kicks);
                $crate::offer::Offer {
                    name: $splitting,
                    steps: probe.steps_in_lanes().or_else(|| probe.steps()),
                    driven: None,
                    differentiated: probe.differentiated_steps(),
                    checks: None,
                }
            },)*
        ]
    }};
}
