//! Description of a system for code that knows no system by name: bindings to other languages.

use super::ActingForce;
use crate::numbers::Scalar;

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
    /// The type of λ, the multipliers of all constraints: `[Scalar; CONSTRAINTS]`, or `()` where there are
    /// none.
    type Multipliers;
    /// The type of the values of all event functions: `[Scalar; EVENTS]`, or `()` where there are none.
    type Events;
    /// The type of the values of all outputs: `[Scalar; OUTPUTS]`, or `()` where there are none.
    type Outputs;
    /// The type that is stepped: the system, or its view with an input and a time.
    type View<'a>: ActingForce<N, Scalar = Self::Scalar>;

    /// The length of u.
    const INPUTS: usize;
    /// Whether L, R, f or another function of the block take the time.
    const TAKES_TIME: bool;
    /// The length of λ.
    const CONSTRAINTS: usize;
    /// The number of event functions.
    const EVENTS: usize;
    /// The number of outputs.
    const OUTPUTS: usize;
    /// The documentation of `fn outputs`, a text for each line or block of it.
    const OUTPUTS_TOLD: &'static [&'static str];
    /// The parameters by which steps are differentiated, as listed.
    const PARAMETERS: &'static [&'static str];

    /// The view with u at time t, as far as the system takes them; `copy` where it takes neither.
    fn view(&self, copy: Self, u: Self::Input, t: Self::Scalar) -> Self::View<'_>;
}
