//! Vectors (q, p) and the matrices that act on them.

use crate::numbers::Scalar;
use crate::step::{PhaseMatrix, State};

/// `a` and `share` times `b`.
pub(super) fn plus<S: Scalar, const N: usize>(a: &State<S, N>, b: &State<S, N>, share: S) -> State<S, N> {
    State { q: a.q + b.q * share, p: a.p + b.p * share }
}

pub(super) fn times<S: Scalar, const N: usize>(a: &PhaseMatrix<S, N>, x: &State<S, N>) -> State<S, N> {
    State { q: a.q_by_q * x.q + a.q_by_p * x.p, p: a.p_by_q * x.q + a.p_by_p * x.p }
}

/// A norm that does not depend on the units of q and p.
pub(super) fn norm<S: Scalar, const N: usize>(a: &PhaseMatrix<S, N>) -> S {
    norm_and_ratio(a)[0]
}

/// The norm, and how p turns into q beside q into p: √(‖∂ṗ/∂q‖/‖∂q̇/∂p‖).
pub(super) fn norm_and_ratio<S: Scalar, const N: usize>(a: &PhaseMatrix<S, N>) -> [S; 2] {
    let (to_q, to_p) = (a.q_by_p.norm(), a.p_by_q.norm());
    [(to_q * to_p).sqrt() + a.q_by_q.norm().max(a.p_by_p.norm()), (to_p / to_q).sqrt()]
}
