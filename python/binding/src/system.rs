//! A system as `module!` states it, and how it is entered without its type.

use core::marker::PhantomData;

use dalembert::Lagrangian;
use dalembert::system::ActingForce;

use crate::offer::{Offer, StepsToError};

/// A system: its fields, and what is stepped.
///
/// [`module!`](crate::module) implements it.
pub trait System<const N: usize>: Sized + 'static {
    /// The name of the class.
    const NAME: &'static str;
    /// The length of u, 0 where the system takes none.
    const INPUTS: usize;
    /// Whether L, R or f take the time.
    const TAKES_TIME: bool;
    /// The parameters by which steps are differentiated.
    const PARAMETERS: &'static [&'static str];
    /// The struct of the fields.
    type Fields: dalembert_c::Fields + Send + Sync;
    /// [`NoInput`](crate::derivatives::NoInput), or [`Input<INPUTS>`](crate::derivatives::Input).
    type Input;
    /// [`NoParameters`](crate::derivatives::NoParameters), or [`Parameters`](crate::derivatives::Parameters).
    type Parameters;
    /// The type that is stepped: the fields, or a view of them with an input and a time.
    type View<'a>: ActingForce<N, Scalar = f64> + Send + Sync;

    /// The views as a run names them, which borrows none.
    type Kind: Lagrangian<N, Scalar = f64> + 'static;

    /// The system with the input `u` at the time `t`, as far as it takes them; u has the length that it takes.
    fn view<'a>(fields: &'a Self::Fields, u: &[f64], t: f64) -> Self::View<'a>;

    /// The offers of all methods, to this system.
    fn offers() -> Vec<Offer<Self, N>>;

    /// Runs to an error asked for, where the rules offer some.
    fn steps_to_error() -> Option<Box<dyn StepsToError<Self, N>>>;
}

/// N of a system, which no type but the trait says.
#[must_use]
pub const fn coordinates<L: Lagrangian<N>, const N: usize>(_: PhantomData<fn() -> L>) -> usize {
    N
}
