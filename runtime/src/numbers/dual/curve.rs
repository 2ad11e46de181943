//! Curves at dual numbers.

use super::primitive::Primitive;
use super::{Dual, Over, Real};
use crate::numbers::Curve;

/// The curve at x, with the derivatives of x by its own.
#[inline]
pub fn at<F, D>(curve: &(impl Curve<F> + ?Sized), x: Real<D>) -> Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    Real(x.0.chain(curve.derivatives(x.0.primal())))
}
