//! Systems that offer methods where an error is asked for.

use super::Methods;
use crate::system::ActingForce;

/// A system that offers methods where an error is asked for: those of the rules that its attribute lists.
///
/// `#[rayleigh_system]` writes it for every system with a self-adjoint rule of order 2, which stands for
/// itself and its compositions. Splittings come with an explicit trapezoidal rule, Gauss methods with
/// `gauss`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` offers no method for a tolerance",
    label = "no self-adjoint rule of order 2 is listed for this system",
    note = "list one: `#[rayleigh_system(rule = midpoint)]`, or `rule = [trapezoidal, gauss]` for small errors",
    note = "friction that holds, by `rule = proximal`, has no method to an error: step by `by(Proximal, h)`"
)]
pub trait OffersMethods<const N: usize>: ActingForce<N> + Sized {
    /// The methods.
    type Methods: Methods<Self, N> + Default;
}
