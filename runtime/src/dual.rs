//! Derivatives by num-dual: the one place that names its types.
//!
//! A body annotated with `#[rayleigh_system]` is written once, over [`Real<D>`](Real); D = `f64` gives the plain value, a
//! dual number the derivatives. Second derivatives nest [`DualSVec`] in itself: seeding the outer number along one family
//! of directions and the inner one along another makes the cross block their mixed second derivative. With the directions
//! of a rule that block is the Newton matrix, and nothing else is computed.

mod lift;
mod primitive;
mod real;

use nalgebra::{SMatrix, SVector};
use num_dual::{Derivative, DualNum, DualSVec};

use crate::{CovectorDerivatives, Derivatives, Direction, Gradient, Scalar, Variations};

pub use lift::{
    FromInteger, Integer, Lift, Lower, Number, Remainder, Roundable, integer, lift, lower, remainder,
};
pub use primitive::Primitive;
pub use real::Real;

/// A number that carries derivatives, over the scalar `F`: `f64`, `f32` or a num-dual number on them.
#[diagnostic::on_unimplemented(
    message = "`{F}` does not fit the scalar type of this system",
    label = "another scalar type than the system's",
    note = "write fields, constants and literals in the scalar type of `q` and `v`"
)]
pub trait Dual<F: Scalar>: DualNum<Primitive = F> + Copy {
    /// The value without derivatives.
    fn primal(self) -> F;

    /// The same derivatives around another value: corrects a value that was reached by a less accurate way.
    fn with_primal(self, value: F) -> Self;

    /// g(self), from g, g′, g″ and g‴ at its value.
    fn chain(self, derivatives: [F; 4]) -> Self;

    /// Whether all derivatives are absent: a number that depends on neither q nor v.
    fn is_constant(self) -> bool;

    /// The constant `value`.
    #[inline]
    fn real(value: F) -> Real<Self> {
        Real(Self::from(value))
    }

    /// A field or constant of the system, whatever its type: floating-point parts become [`Real`], integers and `bool` stay.
    #[inline]
    fn lift<T: Lift<Self>>(value: T) -> T::Lifted {
        value.lift()
    }

    /// `value as f64` (or `f32`), for a number of any type.
    #[inline]
    fn number<T: Number<Self>>(value: T) -> Real<Self> {
        value.number()
    }
}

macro_rules! primitive {
    ($($float:ty)*) => {$(
        impl Dual<$float> for $float {
            #[inline]
            fn primal(self) -> $float {
                self
            }

            #[inline]
            fn with_primal(self, value: $float) -> Self {
                value
            }

            #[inline]
            fn chain(self, derivatives: [$float; 4]) -> Self {
                derivatives[0]
            }

            #[inline]
            fn is_constant(self) -> bool {
                true
            }
        }
    )*};
}
primitive!(f64 f32);

impl<F, T, const M: usize> Dual<F> for DualSVec<T, M>
where
    F: Scalar,
    T: Dual<F>,
    Self: DualNum<Primitive = F> + Copy,
{
    #[inline]
    fn primal(self) -> F {
        self.re.primal()
    }

    #[inline]
    fn with_primal(self, value: F) -> Self {
        Self { re: self.re.with_primal(value), eps: self.eps }
    }

    #[inline]
    fn chain(self, [g, g1, g2, g3]: [F; 4]) -> Self {
        // g′ as a number of the inner type; its third derivative would be g⁗, beyond what nesting to depth 3 asks for.
        let slope = self.re.chain([g1, g2, g3, nalgebra::zero()]);
        Self { re: self.re.chain([g, g1, g2, g3]), eps: Derivative::new(self.eps.0.map(|eps| eps * slope)) }
    }

    #[inline]
    fn is_constant(self) -> bool {
        self.eps.0.is_none() && self.re.is_constant()
    }
}

/// First derivatives by M seeds.
type First<F, const M: usize> = DualSVec<F, M>;

/// Mixed second derivatives: inner seeds are the columns, outer seeds the rows.
type Second<F, const M: usize> = DualSVec<DualSVec<F, M>, M>;

/// The derivatives of a number, zeros where it carries none.
#[inline]
fn derivatives_of<T: Dual<F>, F: Primitive, const M: usize>(number: &DualSVec<T, M>) -> SVector<T, M>
where
    DualSVec<T, M>: Sized,
{
    match &number.eps.0 {
        Some(eps) => *eps,
        None => SVector::from_element(T::from(nalgebra::zero::<F>())),
    }
}

/// Value with the M unit-vector derivatives `seed`.
#[inline]
fn seeded<F: Primitive, const M: usize>(value: F, index: usize, factor: F) -> First<F, M> {
    let mut eps = SVector::<F, M>::zeros();
    eps[index] = factor;
    DualSVec::new(value, Derivative::some(eps))
}

/// Value with an outer and an inner derivative.
#[inline]
fn seeded_twice<F: Primitive, const M: usize>(value: F, index: usize, outer: F, inner: F) -> Second<F, M> {
    let mut eps = SVector::<First<F, M>, M>::from_element(First::from_re(nalgebra::zero()));
    eps[index] = First::from_re(outer);
    DualSVec::new(seeded(value, index, inner), Derivative::some(eps))
}

/// Value, ∂f/∂q and ∂f/∂v of `f`; M = 2N.
#[inline]
pub fn gradient<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<First<F, M>>; N], [Real<First<F, M>>; N]) -> Real<First<F, M>>,
) -> Gradient<F, N> {
    const { assert!(M == 2 * N) };
    let one = nalgebra::one();
    let q: [_; N] = core::array::from_fn(|i| Real(seeded(q[i], i, one)));
    let v: [_; N] = core::array::from_fn(|i| Real(seeded(v[i], N + i, one)));
    let f = f(q, v).0;
    let by = derivatives_of(&f);
    Gradient { value: f.re, d1: SVector::from_fn(|i, _| by[i]), d2: SVector::from_fn(|i, _| by[N + i]) }
}

/// Value, first and second derivatives of `f`; M = 2N.
#[inline]
pub fn derivatives<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Second<F, M>>; N], [Real<Second<F, M>>; N]) -> Real<Second<F, M>>,
) -> Derivatives<F, N> {
    const { assert!(M == 2 * N) };
    let one = nalgebra::one();
    let q: [_; N] = core::array::from_fn(|i| Real(seeded_twice(q[i], i, one, one)));
    let v: [_; N] = core::array::from_fn(|i| Real(seeded_twice(v[i], N + i, one, one)));
    let f = f(q, v).0;
    let first = derivatives_of(&f.re);
    let second = derivatives_of(&f).map(|row| derivatives_of(&row));
    let block = |row: usize, column: usize| SMatrix::from_fn(|i, j| second[row + i][column + j]);
    Derivatives {
        value: f.re.re,
        d1: SVector::from_fn(|i, _| first[i]),
        d2: SVector::from_fn(|i, _| first[N + i]),
        d11: block(0, 0),
        d12: block(0, N),
        d22: block(N, N),
    }
}

/// Derivatives of `f` along `minus` and `plus`, and the mixed one.
#[inline]
pub fn variations<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    minus: Direction<F>,
    plus: Direction<F>,
    f: impl Fn([Real<Second<F, N>>; N], [Real<Second<F, N>>; N]) -> Real<Second<F, N>>,
) -> Variations<F, N> {
    let q: [_; N] = core::array::from_fn(|i| Real(seeded_twice(q[i], i, minus.first, plus.first)));
    let v: [_; N] = core::array::from_fn(|i| Real(seeded_twice(v[i], i, minus.second, plus.second)));
    let f = f(q, v).0;
    let outer = derivatives_of(&f);
    let rows = outer.map(|row| derivatives_of(&row));
    Variations {
        minus: outer.map(|row| row.re),
        plus: derivatives_of(&f.re),
        mixed: SMatrix::from_fn(|i, j| rows[i][j]),
    }
}

/// Value and Jacobians of the covector-valued `f`; M = 2N.
#[inline]
pub fn covector_derivatives<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<First<F, M>>; N], [Real<First<F, M>>; N]) -> [Real<First<F, M>>; N],
) -> CovectorDerivatives<F, N> {
    const { assert!(M == 2 * N) };
    let one = nalgebra::one();
    let q: [_; N] = core::array::from_fn(|i| Real(seeded(q[i], i, one)));
    let v: [_; N] = core::array::from_fn(|i| Real(seeded(v[i], N + i, one)));
    let f = f(q, v);
    let rows = f.map(|component| derivatives_of(&component.0));
    CovectorDerivatives {
        value: SVector::from_fn(|i, _| f[i].0.re),
        d1: SMatrix::from_fn(|i, j| rows[i][j]),
        d2: SMatrix::from_fn(|i, j| rows[i][N + j]),
    }
}

/// Value of the covector-valued `f` and its derivative along `direction`.
#[inline]
pub fn covector_variation<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    direction: Direction<F>,
    f: impl Fn([Real<First<F, N>>; N], [Real<First<F, N>>; N]) -> [Real<First<F, N>>; N],
) -> (SVector<F, N>, SMatrix<F, N, N>) {
    let q: [_; N] = core::array::from_fn(|i| Real(seeded(q[i], i, direction.first)));
    let v: [_; N] = core::array::from_fn(|i| Real(seeded(v[i], i, direction.second)));
    let f = f(q, v);
    let rows = f.map(|component| derivatives_of(&component.0));
    (SVector::from_fn(|i, _| f[i].0.re), SMatrix::from_fn(|i, j| rows[i][j]))
}
