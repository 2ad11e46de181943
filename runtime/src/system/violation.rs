//! The verdict on a point that is off the constraints.

/// The constraint that a point (q, v) violates, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
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
        /// ∂gₖ/∂q·v.
        rate: f64,
    },
}
