//! Python modules of systems that `#[rayleigh_system]` generates: runs, derivatives and energies as NumPy
//! arrays.
//!
//! In a crate of its own, `crate-type = ["cdylib"]`, [`parameters!`] declares the struct of a system's fields
//! and [`module!`] names the systems; maturin builds the module. `examples/python/` is the template, and
//! `docs/python.md` its guide.
//!
//! | in Python | |
//! |---|---|
//! | `ring = Ring(k=1e-3)` | a class a system, its fields attributes with their documentation |
//! | `ring.run(h=0.1, until=100.0, q=…, v=…)` | the motion: arrays `t`, `q`, `v`, `p`, `energy` |
//! | `ring.run(tolerance=1e-9, times=…, q=…, v=…)` | to a tolerance, at given times (dense output) |
//! | `ring.ensemble(h=0.1, steps=1000, q=…, v=…)` | many members on all cores: arrays, or Parquet files that are their own checkpoint |
//! | `ring.linearization(h=0.1, q=…, v=…)` | a step with A, B and derivatives by parameters |
//! | `ring.energy(q=…, v=…)` | energies |
//! | `bob.nearest(q=…, v=…)` | of a system with constraints: the nearest state on them |
//! | `Ring.RULES`, `Ring.STRUCTURE`, … | what is known of the class |
//!
//! A run is one call: it takes its steps without the lock of the interpreter, hands its arrays over without a
//! copy, and ends at Ctrl-C. Steps are those of the run in Rust, bit by bit. A step that fails is the
//! exception `StepError` with what the error of Rust knows.

#[doc(hidden)]
pub use dalembert;
#[doc(hidden)]
pub use dalembert_face as face;
pub use dalembert_face::fields as parameters;
#[doc(hidden)]
pub use pyo3;

mod arguments;
mod arrays;
#[doc(hidden)]
pub mod between;
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
mod given_fields;
mod linearization;
#[doc(hidden)]
pub mod look;
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
mod starts;
mod stepping;
mod structure;
mod stub;
#[doc(hidden)]
pub mod system;
mod table;
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
/// dalembert_python::module!(machines { Cart });
/// # fn main() {}
/// ```
///
/// The name is that of the library, which Python imports. A doc comment before it is the documentation of the
/// module, whose `__version__` is that of the crate.
/// Systems are in `f64`; the attribute has described them.
#[macro_export]
macro_rules! module {
    ($(#[$about:meta])* $name:ident { $($system:ident),+ $(,)? }) => {
        /// The type that `System` is implemented for: the systems may be of another crate.
        struct DalembertPython<S>(::core::marker::PhantomData<S>);

        $($crate::system! { DalembertPython $system })+

        $(#[$about])*
        #[$crate::pyo3::pymodule(gil_used = false)]
        #[pyo3(crate = "dalembert_python::pyo3")]
        fn $name(
            module: &$crate::pyo3::Bound<'_, $crate::pyo3::types::PyModule>,
        ) -> $crate::pyo3::PyResult<()> {
            static KINDS: &[&dyn $crate::model::Kind] = &[
                $(&$crate::model::KindOf::<DalembertPython<$system>, _>(::core::marker::PhantomData),)+
            ];
            $crate::module::fill(module, KINDS, env!("CARGO_PKG_VERSION"))
        }
    };
}

/// Implements [`system::System`] for one entry of [`module!`].
#[doc(hidden)]
#[macro_export]
macro_rules! system {
    ($of:ident $system:ident) => {
        const _: () = {
            use ::core::marker::PhantomData;
            use $crate::face::Described;
            use $crate::offer::NotOffered as _;

            const N: usize = $crate::face::coordinates(PhantomData::<fn() -> $system>);

            impl $crate::system::System<N> for $of<$system> {
                const NAME: &'static str = stringify!($system);
                type Fields = $system;
                type Input = <$system as Described<N>>::Input;
                type Parameters = <$system as Described<N>>::Parameters;
                type Multipliers = <$system as Described<N>>::Multipliers;
                type Events = <$system as Described<N>>::Events;
                type View<'a> = <$system as Described<N>>::View<'a>;

                fn view<'a>(fields: &'a $system, u: &[f64], t: f64) -> Self::View<'a> {
                    let u = <Self::Input as $crate::face::Input<f64>>::of(u)
                        .expect("as many as the system takes");
                    fields.view(*fields, u, t)
                }
            }

            impl $crate::offer::Offers<N> for $of<$system> {
                fn offers() -> ::std::vec::Vec<$crate::offer::Offer<Self, N>> {
                    $crate::offers!(Self, N)
                }

                fn steps_to_error()
                -> ::core::option::Option<::std::boxed::Box<dyn $crate::offer::StepsToError<Self, N>>>
                {
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
            "midpoint" $crate::dalembert::Midpoint,
            "trapezoidal" $crate::dalembert::Trapezoidal,
            "fitted" $crate::dalembert::Fitted,
            "fitted_trapezoidal" $crate::dalembert::FittedTrapezoidal,
            "one_sided" $crate::dalembert::OneSided,
            "proximal" $crate::dalembert::Proximal,
            "gauss_2" $crate::dalembert::Gauss::<2>,
            "gauss_4" $crate::dalembert::Gauss::<4>,
            "gauss_6" $crate::dalembert::Gauss::<6>,
            "gauss_8" $crate::dalembert::Gauss::<8>,
            "blanes_moan_4" $crate::dalembert::Splitting::blanes_moan_4(),
            "blanes_moan_6" $crate::dalembert::Splitting::blanes_moan_6(),
            "blanes_casas_escorihuela_8" $crate::dalembert::Splitting::blanes_casas_escorihuela_8(),
        }
    };
    ($system:ty, $n:ident: $($name:literal $method:expr,)*) => {
        ::std::vec![$({
            let probe = $crate::offer::Probe::<$system, _, $n>::new($method);
            $crate::offer::Offer {
                name: $name,
                steps: probe.steps_in_lanes().or_else(|| probe.steps()),
                driven: probe.driven_steps(),
                checks: probe.checks(),
            }
        },)*]
    };
}
