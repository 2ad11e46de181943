use super::force_work::by_nodes;
use super::{DisplacementRule, Node, SelfAdjoint};
use crate::step::SolvedForVelocity;

/// The trapezoidal rule, order 2, self-adjoint.
///
/// With v̄ = (q1 − q0)/h:
///
/// ```text
/// L_d = (h/2) [L(q0, v̄) + L(q1, v̄)]
/// R_d = (h²/4) [R(q0, v̄) + R(q1, v̄)]
/// f_d⁻ = (h/2) f(q0, v̄),   f_d⁺ = (h/2) f(q1, v̄)
/// ```
///
/// **Derivation.** ∫₀ʰ L dt by the trapezoidal rule along the straight line from q0 to q1; the force by the
/// same rule, each endpoint's share going to its own variation. R_d follows as for
/// [`Midpoint`](super::Midpoint), node by node.
///
/// For L = ½vᵀMv − V(q) with constant M this is Störmer–Verlet: p0 = M v̄ + (h/2) ∇V(q0) and p1 = M v̄ −
/// (h/2) ∇V(q1).
///
/// With R = ½vᵀCv and C = 2aM its step is conformally symplectic, AᵀΩA = cΩ with c = (1 − ah)/(1 + ah), for
/// every V and n, and R_d is ah L_d up to functions of one end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trapezoidal;

impl DisplacementRule for Trapezoidal {
    const NODES: &'static [Node] =
        &[Node { position: 0.0, weight: 0.5 }, Node { position: 1.0, weight: 0.5 }];
}

impl SolvedForVelocity for Trapezoidal {}

impl SelfAdjoint for Trapezoidal {}

by_nodes!([] Trapezoidal, of Trapezoidal);
