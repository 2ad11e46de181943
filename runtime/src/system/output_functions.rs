//! Outputs that a system states.

use nalgebra::SVector;

use crate::system::Lagrangian;

/// Outputs of a system, h(q, v, u, t): what is measured of it, in a number each.
///
/// Implemented by `#[rayleigh_system]` for a block with
/// `fn outputs(&self, q: [f64; N], v: [f64; N]) -> [f64; K]`, which may take the input `u: [f64; M]` of the
/// force, the time `t: f64` or both after them. They are plain functions; nothing differentiates them, and no
/// step asks for them. A functional mock-up unit has them as variables, with the names, texts and units that
/// lines of the function's documentation give them. In Rust they are the function:
///
/// ```
/// use dalembert::rayleigh_system;
/// use dalembert::system::OutputFunctions;
///
/// /// A load on a rope, which a winch pulls with u.
/// struct Hoist {
///     mass: f64,
/// }
///
/// #[rayleigh_system]
/// impl Hoist {
///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * self.mass * v[0] * v[0] - self.mass * 9.81 * q[0]
///     }
///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
///         u
///     }
///     /// - `y[0]` height: of the load over the floor. Unit: m
///     /// - `y[1]` power: of the winch. Unit: W
///     fn outputs(&self, q: [f64; 1], v: [f64; 1], u: [f64; 1]) -> [f64; 2] {
///         [q[0], u[0] * v[0]]
///     }
/// }
///
/// let hoist = Hoist { mass: 2.0 };
/// assert_eq!(hoist.outputs([0.5], [3.0], [20.0]), [0.5, 60.0]);
/// // Of the view, which holds u and t, for code that knows no system by name.
/// let of_the_view: [f64; 2] = hoist.driven([20.0]).outputs(&[0.5].into(), &[3.0].into());
/// assert_eq!(of_the_view, [0.5, 60.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no `fn outputs` that returns {K} numbers",
    label = "not stated in the block of this system",
    note = "write `fn outputs(&self, q: [f64; {N}], v: [f64; {N}]) -> [f64; {K}]` in the block of `#[rayleigh_system]`; one \
            that takes `u` or `t` stands on the system's view"
)]
pub trait OutputFunctions<const N: usize, const K: usize>: Lagrangian<N> {
    /// Their values at (q, v).
    fn outputs(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> [Self::Scalar; K];
}
