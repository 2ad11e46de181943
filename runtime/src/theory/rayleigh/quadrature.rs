use core::num::NonZeroUsize;
use core::ops::{Add, Mul};
use std::sync::LazyLock;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::DiscreteForce;
use crate::theory::legendre::GaussLegendre;
use crate::theory::samples::Pair;

/// An integral by quadrature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// The value.
    pub value: f64,
    /// Estimate of its error: the difference of two Gauss–Legendre rules, and the rounding of the integrand.
    pub error: f64,
    /// ∫ |integrand|, the size of the terms.
    pub magnitude: f64,
}

impl Integral {
    pub(super) const ZERO: Self = Self { value: 0.0, error: 0.0, magnitude: 0.0 };
}

impl Add for Integral {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            error: self.error + other.error,
            magnitude: self.magnitude + other.magnitude,
        }
    }
}

impl Mul<f64> for Integral {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            error: self.error * factor.abs(),
            magnitude: self.magnitude * factor.abs(),
        }
    }
}

static COARSE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(COARSE_NODES));
static FINE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(FINE_NODES));

const COARSE_NODES: NonZeroUsize = NonZeroUsize::new(10).unwrap();
const FINE_NODES: NonZeroUsize = NonZeroUsize::new(20).unwrap();

/// Intervals at most: a kink takes some twenty; an integrand that is itself a small difference of large
/// numbers never settles, and its error estimate then states its noise.
const MAX_INTERVALS: usize = 64;

/// Rounding of an integral, in units of ε ∫|integrand|.
const ROUNDINGS: f64 = 64.0;

/// ∫₀¹ g(s) ds by adaptive Gauss–Legendre quadrature: the interval where 10 and 20 nodes differ most is
/// halved until the differences add up to rounding. `epsilon` is that of the scalar type in which g is
/// evaluated.
fn integrate(epsilon: f64, g: impl Fn(f64) -> f64) -> Integral {
    integrate_sum(epsilon, |s| {
        let value = g(s);
        (value, value.abs())
    })
}

/// [`integrate`] of a g that is a sum of terms that may cancel: g gives its value, and the size of the terms,
/// whose rounding it has.
pub(in crate::theory) fn integrate_sum(epsilon: f64, g: impl Fn(f64) -> (f64, f64)) -> Integral {
    // The error of each part is the difference of the two rules.
    let on = |a: f64, b: f64| {
        let mut magnitude = 0.0;
        let value = FINE.integrate(a, b, |s| {
            let (value, terms) = g(s);
            magnitude += terms;
            value
        });
        let error = (value - COARSE.integrate(a, b, |s| g(s).0)).abs();
        // The mean over the nodes says enough of the terms' size.
        (a, b, Integral { value, error, magnitude: magnitude * (b - a) / FINE_NODES.get() as f64 })
    };
    let mut parts = vec![on(0.0, 1.0)];
    loop {
        let sum = parts.iter().fold(Integral::ZERO, |sum, part| sum + part.2);
        let rounding = ROUNDINGS * epsilon * sum.magnitude;
        if sum.error <= rounding || parts.len() >= MAX_INTERVALS || !sum.value.is_finite() {
            return Integral { error: sum.error + rounding, ..sum };
        }
        let worst = (0..parts.len())
            .fold(0, |worst, index| if parts[index].2.error > parts[worst].2.error { index } else { worst });
        let (a, b, _) = parts.swap_remove(worst);
        let middle = 0.5 * (a + b);
        parts.push(on(a, middle));
        parts.push(on(middle, b));
    }
}

/// ∫ f⁻·dq0 − f⁺·dq1 along the straight line from `start` to `end` in Q×Q.
pub(super) fn between<S: Scalar, const N: usize>(
    start: &Pair<S, N>,
    end: &Pair<S, N>,
    force: impl Fn(&SVector<S, N>, &SVector<S, N>) -> DiscreteForce<S, N>,
) -> Integral {
    let (d0, d1) = (end.q0 - start.q0, end.q1 - start.q1);
    if d0.iter().chain(&d1).all(|entry| *entry == S::zero()) {
        return Integral::ZERO;
    }
    integrate(S::EPSILON.widen(), |s| {
        let s = S::constant(s);
        let f = force(&(start.q0 + d0 * s), &(start.q1 + d1 * s));
        (f.minus.dot(&d0) - f.plus.dot(&d1)).widen()
    })
}

/// ∫ θ along the straight line from `start` to `end`, θ a covector field.
pub(super) fn along_line<S: Scalar, const N: usize>(
    start: &SVector<S, N>,
    end: &SVector<S, N>,
    theta: impl Fn(&SVector<S, N>) -> SVector<S, N>,
) -> Integral {
    let direction = end - start;
    if direction.iter().all(|entry| *entry == S::zero()) {
        return Integral::ZERO;
    }
    integrate(S::EPSILON.widen(), |s| theta(&(start + direction * S::constant(s))).dot(&direction).widen())
}

/// An integral along the edges of the box between them, one coordinate after the other.
pub(super) fn along_edges<S: Scalar, const N: usize>(
    start: &SVector<S, N>,
    end: &SVector<S, N>,
    theta: impl Fn(&SVector<S, N>) -> SVector<S, N>,
) -> Integral {
    let mut corner = *start;
    (0..N).fold(Integral::ZERO, |sum, axis| {
        let from = corner;
        corner[axis] = end[axis];
        sum + along_line(&from, &corner, &theta)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::vector;

    #[test]
    fn known_integrals_within_their_error_estimate() {
        let check = |g: fn(f64) -> f64, expected: f64| {
            let integral = integrate(f64::EPSILON, g);
            assert!((integral.value - expected).abs() <= integral.error, "{integral:?} {expected}");
            assert!(integral.error < 1e-12, "{integral:?}");
        };
        check(f64::exp, 1.0_f64.exp() - 1.0);
        check(|s| (40.0 * s).cos(), 40.0_f64.sin() / 40.0);
        // A kink that no halving meets.
        check(|s| (s - 1.0 / 3.0).abs(), 5.0 / 18.0);
        // Positive control: the coarse rule alone misses the kink by far more than the error stated.
        let coarse = COARSE.integrate(0.0, 1.0, |s: f64| (s - 1.0 / 3.0).abs());
        assert!((coarse - 5.0 / 18.0).abs() > 1e-4);
    }

    #[test]
    fn paths_agree_for_a_gradient_alone() {
        let (start, end) = (vector![0.2, -0.4], vector![1.0, 0.7]);
        let gap = |theta: fn(&SVector<f64, 2>) -> SVector<f64, 2>| {
            along_line(&start, &end, theta).value - along_edges(&start, &end, theta).value
        };
        assert!(gap(|q| vector![q[1] * q[1], 2.0 * q[0] * q[1]]).abs() < 1e-15);
        // ∮ −y dx over the triangle is its area, ½·0.8·1.1, taken against the sense of rotation.
        assert!((gap(|q| vector![-q[1], 0.0]) + 0.44).abs() < 1e-15);
    }
}
