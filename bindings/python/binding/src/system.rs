//! A system as `module!` states it, and how it is entered without its type.

use dalembert::system::ActingForce;
use dalembert_face::{Described, Events, Fields, Holding};

/// A system: its fields, and what is stepped.
///
/// [`module!`](crate::module) implements it.
pub trait System<const N: usize>: Sized + 'static {
    /// The name of the class.
    const NAME: &'static str;
    /// The struct of the system.
    type Fields: Described<N, Scalar = f64> + Fields + Send + Sync;
    /// The type of u.
    type Input;
    /// The type of the names of the parameters by which steps are differentiated.
    type Parameters;
    /// The type of λ.
    type Multipliers: for<'a> Holding<Self::View<'a>, N>;
    /// The type of the values of event functions.
    type Events: for<'a> Events<Self::View<'a>, N>;
    /// The type that is stepped: the fields, or a view of them with an input and a time.
    type View<'a>: ActingForce<N, Scalar = f64> + Send + Sync;

    /// The system with u at time t, as far as it takes them; u has the length that it takes.
    fn view<'a>(fields: &'a Self::Fields, u: &[f64], t: f64) -> Self::View<'a>;
}
