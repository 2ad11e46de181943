use core::fmt;
use core::ops::{Add, Mul, Neg, Sub};
use std::sync::Arc;

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::system::VectorField;

/// The generator ξ of a one-parameter group acting on Q = ℝᴺ, with a name for reports.
///
/// ```text
/// ξ(q) = A q + b + Σ cᵢ ξᵢ(q)
/// ```
///
/// Translations and rotations are the affine part; [`from_field`](Self::from_field) takes any other vector
/// field, and `+`, `-` and `*` combine generators linearly.
///
/// ```
/// use dalembert::VectorField;
/// use dalembert::nalgebra::vector;
/// use dalembert::noether::Generator;
///
/// let rotation: Generator<f64, 2> = Generator::rotation(0, 1);
/// let about_one_zero = rotation.clone() - Generator::translation("y", [0.0, 1.0]);
/// assert_eq!(rotation.vector(&vector![1.0, 2.0]), vector![-2.0, 1.0]);
/// assert_eq!(about_one_zero.vector(&vector![1.0, 0.0]), vector![0.0, 0.0]);
/// ```
#[derive(Clone)]
pub struct Generator<S, const N: usize> {
    name: String,
    linear: SMatrix<S, N, N>,
    constant: SVector<S, N>,
    fields: Vec<(S, Field<S, N>)>,
}

type Field<S, const N: usize> = Arc<dyn VectorField<N, Scalar = S> + Send + Sync>;

impl<S: Scalar, const N: usize> Generator<S, N> {
    /// ξ(q) = A q + b.
    pub fn affine(
        name: impl Into<String>,
        linear: impl Into<SMatrix<S, N, N>>,
        constant: impl Into<SVector<S, N>>,
    ) -> Self {
        Self { name: name.into(), linear: linear.into(), constant: constant.into(), fields: Vec::new() }
    }

    /// Translations along `direction`: ξ(q) = b. J is the momentum along b.
    pub fn translation(name: impl Into<String>, direction: impl Into<SVector<S, N>>) -> Self {
        Self::affine(name, SMatrix::zeros(), direction)
    }

    /// Rotations in the plane of two coordinates, from the first towards the second: ξ = q_from ∂_to − q_to
    /// ∂_from, so that J = q_from p_to − q_to p_from.
    ///
    /// In ℝ³, `rotation(0, 1)`, `rotation(1, 2)` and `rotation(2, 0)` turn about the third, first and second
    /// axis.
    ///
    /// # Panics
    /// If the coordinates are equal or not below N.
    #[must_use]
    pub fn rotation(from: usize, to: usize) -> Self {
        assert!(
            from != to && from < N && to < N,
            "rotation({from}, {to}): two different coordinates below {N}"
        );
        let mut linear = SMatrix::zeros();
        linear[(to, from)] = S::one();
        linear[(from, to)] = -S::one();
        Self::affine(format!("rotation({from}, {to})"), linear, SVector::zeros())
    }

    /// Any vector field.
    pub fn from_field<F>(name: impl Into<String>, field: F) -> Self
    where
        F: VectorField<N, Scalar = S> + Send + Sync + 'static,
    {
        let mut generator = Self::affine(name, SMatrix::zeros(), SVector::zeros());
        generator.fields.push((S::one(), Arc::new(field)));
        generator
    }

    /// This generator under another name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// The name used in reports.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl<S: Scalar, const N: usize> VectorField<N> for Generator<S, N> {
    type Scalar = S;

    fn vector(&self, q: &SVector<S, N>) -> SVector<S, N> {
        self.fields
            .iter()
            .fold(self.linear * q + self.constant, |sum, (factor, field)| sum + field.vector(q) * *factor)
    }

    fn jacobian(&self, q: &SVector<S, N>) -> SMatrix<S, N, N> {
        self.fields.iter().fold(self.linear, |sum, (factor, field)| sum + field.jacobian(q) * *factor)
    }
}

impl<S: Scalar, const N: usize> Add for Generator<S, N> {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self.name = format!("{} + {}", self.name, other.name);
        self.linear += other.linear;
        self.constant += other.constant;
        self.fields.extend(other.fields);
        self
    }
}

impl<S: Scalar, const N: usize> Mul<S> for Generator<S, N> {
    type Output = Self;
    fn mul(mut self, factor: S) -> Self {
        self.name = format!("{factor}·({})", self.name);
        self.linear *= factor;
        self.constant *= factor;
        for (coefficient, _) in &mut self.fields {
            *coefficient *= factor;
        }
        self
    }
}

impl<S: Scalar, const N: usize> Neg for Generator<S, N> {
    type Output = Self;
    fn neg(self) -> Self {
        self * -S::one()
    }
}

impl<S: Scalar, const N: usize> Sub for Generator<S, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<S: Scalar, const N: usize> fmt::Debug for Generator<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Generator")
            .field("name", &self.name)
            .field("linear", &self.linear)
            .field("constant", &self.constant)
            .field("fields", &self.fields.len())
            .finish()
    }
}

/// The bracket of vector fields, [ξ, η] = Dη ξ − Dξ η, at q.
///
/// For a left action, ξ ↦ ξ_Q reverses the sign of the bracket of the Lie algebra; subalgebras are the same.
///
/// ```
/// use dalembert::nalgebra::vector;
/// use dalembert::noether::{Generator, bracket};
///
/// // [∂x, x ∂y − y ∂x] = ∂y
/// let (x, rotation) = (Generator::translation("x", [1.0, 0.0]), Generator::rotation(0, 1));
/// assert_eq!(bracket(&x, &rotation, &vector![0.3, 0.7]), vector![0.0, 1.0]);
/// ```
pub fn bracket<S: Scalar, const N: usize>(
    xi: &impl VectorField<N, Scalar = S>,
    eta: &impl VectorField<N, Scalar = S>,
    q: &SVector<S, N>,
) -> SVector<S, N> {
    eta.jacobian(q) * xi.vector(q) - xi.jacobian(q) * eta.vector(q)
}
