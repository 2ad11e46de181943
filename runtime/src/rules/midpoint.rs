use super::force_work::by_nodes;
use super::{DisplacementRule, Node, SelfAdjoint};
use crate::step::SolvedForVelocity;

/// The midpoint rule, order 2, self-adjoint.
///
/// With q̄ = (q0 + q1)/2 and v̄ = (q1 − q0)/h:
///
/// ```text
/// L_d = h L(q̄, v̄)                              (paper, section 3.5)
/// R_d = (h²/2) R(q̄, v̄)                         (the paper prints h/2, which has the wrong dimension)
/// f_d⁻ = f_d⁺ = (h/2) f(q̄, v̄)                  (general force)
/// ```
///
/// **Derivation of R_d.** If R does not depend on q, the force −∂R/∂v at the midpoint gives
/// f_d^± = −(h/2) ∂R/∂v(v̄), and f_d⁻ = D1 R_d = −(1/h) ∂R_d/∂v̄ asks for R_d = (h²/2) R. With R(q, v) the
/// same formula keeps the system discrete Rayleigh, self-adjoint and of order 2, and adds ±(h²/4) ∂R/∂q(q̄,
/// v̄) to f_d^∓.
///
/// **The step.** In v̄, with q̄ = q0 + h v̄/2, the minus Legendre transform p0 = −D1 L_d⁺ reads
///
/// ```text
/// p0 = ∂ₐ(L + (h/2) R)            a = (δq, δv) = (−h/2, 1)
/// p1 = ∂_b(L − (h/2) R)           b = (δq, δv) = (+h/2, 1)
/// ∂p0/∂v̄ = ∂_b ∂ₐ (L + (h/2) R)   = −h D2 D1 L_d⁺
/// ```
///
/// so one evaluation of the mixed derivative along a and b is the Newton matrix.
///
/// **Without mass**, where L does not hold the velocity of a coordinate that friction damps, p0 = −(h/2) G
/// and p1 = (h/2) G with the force G of the coordinate at (q̄, v̄): from p0 = 0 the step finds v̄ with G = 0,
/// and p1 is 0 to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Midpoint;

impl DisplacementRule for Midpoint {
    const NODES: &'static [Node] = &[Node { position: 0.5, weight: 1.0 }];
}

impl SolvedForVelocity for Midpoint {
    const TAKES_MASSLESS: bool = true;
}

impl SelfAdjoint for Midpoint {}

by_nodes!([] Midpoint, of Midpoint);
