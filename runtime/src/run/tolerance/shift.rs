//! The part of an error that is a shift in time: the motion carries it exactly.

use super::phase::plus;
use super::scale::Scale;
use super::tangent::carried;
use super::variation::Variation;
use crate::numbers::Scalar;
use crate::step::State;

/// The time by which `error` is a shift: its component along `rate`, in units of `rate`; 0 at rest.
pub(super) fn shift<S: Scalar, const N: usize>(
    error: &State<S, N>,
    rate: &State<S, N>,
    scale: &Scale<S, N>,
) -> S {
    let w = S::constant(scale.weight());
    let length = rate.q.norm_squared() + rate.p.norm_squared() * w * w;
    let shift = (error.q.dot(&rate.q) + error.p.dot(&rate.p) * w * w) / length;
    if shift.is_finite() { shift } else { S::zero() }
}

/// Carries `errors` on to `to`. Their component along the motion, a shift in time, is mapped exactly: f to f.
pub(super) fn along_the_motion<S: Scalar, const N: usize, const K: usize>(
    errors: [State<S, N>; K],
    from: &Variation<S, N>,
    middle: Option<&Variation<S, N>>,
    to: &Variation<S, N>,
    t: S,
    scale: &Scale<S, N>,
) -> [State<S, N>; K] {
    let (f, g) = (&from.rate, &to.rate);
    let shifts = errors.each_ref().map(|error| shift(error, f, scale));
    let across: [State<S, N>; K] = core::array::from_fn(|k| plus(&errors[k], f, -shifts[k]));
    let across = carried(across, from, middle, to, t);
    core::array::from_fn(|k| plus(&across[k], g, shifts[k]))
}
