//! The verdict on a point that the constraints do not allow.

/// The constraint that a point (q, v) violates, and by how much; or that cannot tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
    /// The constraint, its rate or a derivative of its is NaN or infinite at the point.
    NoDerivative {
        /// The constraint k, from 0.
        constraint: usize,
        /// The coordinate i of the derivative by qᵢ or vᵢ; of no meaning where the value alone is none.
        coordinate: usize,
    },
    /// q is off the constraint.
    Off {
        /// The constraint k, from 0.
        constraint: usize,
        /// gₖ(q).
        value: f64,
    },
    /// q is on the constraints, and v leaves one.
    Leaving {
        /// The constraint k, from 0.
        constraint: usize,
        /// ρₖ(q, v): ∂gₖ/∂q·v + ∂gₖ/∂t, or ψₖ(q, v) of a constraint of velocity.
        rate: f64,
    },
}
