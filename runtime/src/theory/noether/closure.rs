use core::fmt;

use nalgebra::{DMatrix, DVector, SVector};

use super::rank::Conditions;
use super::{Generator, bracket};
use crate::numbers::Scalar;
use crate::system::VectorField;
use crate::theory::verdict::{excess, is_zero, largest, tells, typical};

/// How far the brackets of a basis lie from its span, at the sampled points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Closure {
    /// Largest distance of a bracket from the span, relative to the terms of the bracket: 1 leads out, ε
    /// stays inside.
    pub residual: f64,
    /// The pair of basis elements whose bracket that is.
    pub pair: Option<(usize, usize)>,
    /// The largest residual that counts as closed: rounding of the bracket, and the uncertainty of the basis.
    pub tolerance: f64,
}

impl Closure {
    /// Whether the span is a Lie algebra, to rounding. A tolerance that leaves no digit of 1, the size
    /// of a bracket's terms, says nothing.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        tells(self.tolerance, 1.0) && is_zero(self.residual, self.tolerance)
    }
}

impl fmt::Display for Closure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict =
            if self.is_closed() { "closed under the bracket" } else { "NOT closed under the bracket" };
        write!(f, "{verdict}: residual {:.1e}, zero below {:.1e}", self.residual, self.tolerance)
    }
}

/// The generators and their brackets at the sampled points, one entry for each point and coordinate.
pub(super) struct Fields {
    dimension: usize,
    values: Vec<DVector<f64>>,
    brackets: Vec<Vec<DVector<f64>>>,
    /// |Dη||ξ| + |Dξ||η|, the terms of the bracket.
    sizes: Vec<Vec<DVector<f64>>>,
}

/// A function of two generators and a point.
type PairOfGenerators<'f, S, const N: usize> =
    &'f dyn Fn(&Generator<S, N>, &Generator<S, N>, &SVector<S, N>) -> SVector<S, N>;

impl Fields {
    pub(super) fn at<S: Scalar, const N: usize>(
        generators: &[Generator<S, N>],
        points: &[SVector<S, N>],
    ) -> Self {
        let over_points = |entry: &dyn Fn(&SVector<S, N>) -> SVector<S, N>| {
            DVector::from_iterator(
                N * points.len(),
                points.iter().flat_map(|q| entry(q).map(Scalar::widen).iter().copied().collect::<Vec<_>>()),
            )
        };
        let pairs = |entry: PairOfGenerators<'_, S, N>| {
            generators
                .iter()
                .map(|xi| generators.iter().map(|eta| over_points(&|q| entry(xi, eta, q))).collect())
                .collect()
        };
        Self {
            dimension: N,
            values: generators.iter().map(|xi| over_points(&|q| xi.vector(q))).collect(),
            brackets: pairs(&|xi, eta, q| bracket(xi, eta, q)),
            sizes: pairs(&|xi, eta, q| {
                eta.jacobian(q).abs() * xi.vector(q).abs() + xi.jacobian(q).abs() * eta.vector(q).abs()
            }),
        }
    }

    pub(super) fn first_non_finite(&self) -> Option<usize> {
        let sizes = self.sizes.iter().flatten();
        let first = |vector: &DVector<f64>| {
            vector.iter().position(|entry| !entry.is_finite()).map(|i| i / self.dimension)
        };
        self.values.iter().chain(sizes).filter_map(first).min()
    }

    /// The rows whose null space are the linear relations between the generators, one block a coordinate.
    pub(super) fn conditions(&self) -> Vec<Conditions> {
        (0..self.dimension)
            .map(|axis| {
                let rows = self.values.first().map_or(0, |value| value.len() / self.dimension);
                let values = DMatrix::from_fn(rows, self.values.len(), |i, j| {
                    self.values[j][i * self.dimension + axis]
                });
                Conditions { sizes: values.abs(), values }
            })
            .collect()
    }

    /// Fits the brackets of the combinations `basis` by the combinations.
    pub(super) fn closure(&self, basis: &[Vec<f64>], tolerance: f64) -> Closure {
        let mut closure = Closure { residual: 0.0, pair: None, tolerance };
        let weights = self.weights();
        let weighted = |mut vector: DVector<f64>| {
            vector.iter_mut().zip(&weights).for_each(|(entry, weight)| *entry *= weight);
            vector
        };
        let zero = || DVector::zeros(self.values.first().map_or(0, |value| value.len()));
        let span: Vec<DVector<f64>> = basis
            .iter()
            .map(|c| weighted(c.iter().zip(&self.values).fold(zero(), |sum, (c, value)| sum + value * *c)))
            .collect();
        if span.len() < 2 {
            return closure;
        }
        let orthonormal = DMatrix::from_columns(&span).qr().q();
        let combined = |parts: &[Vec<DVector<f64>>], a: &[f64], b: &[f64], magnitude: bool| {
            let mut sum = zero();
            for (i, row) in parts.iter().enumerate() {
                for (j, part) in row.iter().enumerate() {
                    let factor = a[i] * b[j];
                    sum += part * if magnitude { factor.abs() } else { factor };
                }
            }
            weighted(sum)
        };
        for a in 0..basis.len() {
            for b in a + 1..basis.len() {
                let bracket = combined(&self.brackets, &basis[a], &basis[b], false);
                let size = combined(&self.sizes, &basis[a], &basis[b], true).norm();
                let outside = &bracket - &orthonormal * (orthonormal.transpose() * &bracket);
                let residual = if size == 0.0 { 0.0 } else { outside.norm() / size };
                if excess(residual, tolerance) > excess(closure.residual, tolerance) {
                    closure.residual = residual;
                    closure.pair = Some((a, b));
                }
            }
        }
        closure
    }

    /// Coordinates in units of their own size over all generators, so that none drowns the others, and points
    /// far out in units of theirs, so that none drowns the others either.
    fn weights(&self) -> Vec<f64> {
        let points = self.values.first().map_or(0, |value| value.len() / self.dimension);
        let size = |point: usize, axis: usize| {
            largest(self.values.iter().map(|value| value[point * self.dimension + axis]))
        };
        let axes: Vec<f64> =
            (0..self.dimension).map(|axis| typical((0..points).map(|point| size(point, axis)))).collect();
        (0..points)
            .flat_map(|point| {
                let far = largest((0..self.dimension).map(|axis| size(point, axis) / axes[axis])).max(1.0);
                axes.iter().map(move |axis| 1.0 / axis / far).collect::<Vec<_>>()
            })
            .collect()
    }
}
