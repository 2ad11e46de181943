//! Characteristics of dual numbers.

use super::primitive::Primitive;
use super::{Dual, Over, Real};
use crate::numbers::Characteristic;

/// The characteristic at x, with the derivatives of x by its own.
#[inline]
pub fn at<F, D>(characteristic: &(impl Characteristic<F> + ?Sized), x: Real<D>) -> Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    Real(x.0.chain(characteristic.derivatives(x.0.primal())))
}
