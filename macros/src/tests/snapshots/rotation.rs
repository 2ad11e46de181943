fn rotation(q: [f64; 2], speed: f64) -> [f64; 2] {
    [-speed * q[1], speed * q[0]]
}
/// The field of [`rotation`], with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(dead_code)]
struct Rotation {
    /// Parameter `speed` of [`rotation`].
    speed: f64,
}
#[allow(
    clippy::all,
    clippy::pedantic,
    clippy::nursery,
    deprecated,
    nonstandard_style,
    unreachable_code,
    unused
)]
const _: () = {
    use ::dalembert::generated::dual::{self, Dual, Real};
    #[allow(dead_code)]
    impl Rotation {
        /// `rotation` over plain and dual numbers.
        #[inline(always)]
        fn rotation_over<D: Dual<f64>>(q: [Real<D>; 2], speed: Real<D>) -> [Real<D>; 2] {
            [-speed * q[1], speed * q[0]]
        }
        /// The field over plain and dual numbers.
        #[inline(always)]
        fn field_over<D: Dual<f64>>(&self, q: [Real<D>; 2]) -> [Real<D>; 2] {
            Self::rotation_over(q, D::lift(self.speed))
        }
    }
};
#[allow(
    clippy::all,
    clippy::pedantic,
    clippy::nursery,
    nonstandard_style,
    unused_variables,
    unreachable_patterns
)]
const _: () = {
    use ::dalembert::nalgebra::{SMatrix, SVector};
    use ::dalembert::generated::{VectorField, dual};
    type Vector = SVector<f64, 2>;
    #[automatically_derived]
    impl VectorField<2> for Rotation {
        type Scalar = f64;
        fn vector(&self, q: &Vector) -> Vector {
            rotation((*q).into(), self.speed).into()
        }
        fn jacobian(&self, q: &Vector) -> SMatrix<f64, 2, 2> {
            dual::jacobian(q, |q| self.field_over(q), |q| self.field_over(q))
        }
    }
};
