//! `#[differentiable]`: fields on the configuration space, against closed forms.

use dalembert::nalgebra::{matrix, vector};
use dalembert::{ScalarField, VectorField, differentiable};

/// Rotation of the plane.
#[differentiable]
fn rotation(q: [f64; 2]) -> [f64; 2] {
    [-q[1], q[0]]
}

mod fields {
    use dalembert::differentiable;

    /// Rotation about `axis`, faster with the distance from the origin by the power 2n.
    #[differentiable]
    pub fn spiral(q: [f64; 3], axis: [f64; 3], n: i32, reverse: bool) -> [f64; 3] {
        let sign = if reverse { -1.0 } else { 1.0 };
        let factor = sign * q.iter().map(|x| x * x).sum::<f64>().powi(n);
        let cross = |i: usize, j: usize| factor * (axis[i] * q[j] - axis[j] * q[i]);
        [cross(1, 2), cross(2, 0), cross(0, 1)]
    }

    #[differentiable]
    pub(super) fn generating(q: [f64; 2], s: f64, lambda: [f64; 2]) -> f64 {
        0.5 * s * q[0] * q[0] * q[1].cos() + lambda[0] * q[0] + lambda[1] * q[1]
    }

    #[differentiable]
    pub fn single(q: [f32; 1], k: f32) -> f32 {
        k * q[0].powi(3)
    }
}

#[differentiable]
fn constant(_: [f64; 2]) -> [f64; 2] {
    [1.0, 0.0]
}

#[test]
fn a_rotation_is_a_vector_field() {
    let q = vector![0.3, -1.7];
    assert_eq!(Rotation.vector(&q), vector![1.7, 0.3]);
    assert_eq!(rotation([0.3, -1.7]), [1.7, 0.3]);
    assert_eq!(Rotation.jacobian(&q), matrix![0.0, -1.0; 1.0, 0.0]);
}

#[test]
fn a_field_that_is_constant_has_no_derivatives() {
    assert_eq!(Constant.vector(&vector![0.3, 0.4]), vector![1.0, 0.0]);
    assert_eq!(Constant.jacobian(&vector![0.3, 0.4]), matrix![0.0, 0.0; 0.0, 0.0]);
}

/// ξ = ±|q|²ⁿ a × q, so that Dξ = ±(|q|²ⁿ [a]ₓ + 2n |q|²ⁿ⁻² (a × q) qᵀ).
#[test]
fn parameters_become_fields() {
    let axis = vector![0.2, -0.5, 1.1];
    let q = vector![0.3, -1.7, 0.6];
    let cross = axis.cross(&q);
    for (n, reverse, sign) in [(0, false, 1.0), (1, true, -1.0), (2, false, 1.0)] {
        let field = fields::Spiral { axis: axis.into(), n, reverse };
        let s: f64 = q.norm_squared();
        assert_eq!(fields::spiral(q.into(), axis.into(), n, reverse), <[f64; 3]>::from(field.vector(&q)));
        assert!((field.vector(&q) - cross * (sign * s.powi(n))).amax() < 1e-14 * (1.0 + s.powi(n)));
        let jacobian = (axis.cross_matrix() * s.powi(n)
            + cross * q.transpose() * (2.0 * f64::from(n) * s.powi(n - 1)))
            * sign;
        assert!((field.jacobian(&q) - jacobian).amax() < 1e-14 * jacobian.amax(), "{jacobian}");
    }
}

#[test]
fn a_generating_function_is_a_scalar_field() {
    let field = fields::Generating { s: 1.3, lambda: [0.4, -0.2] };
    let (x, y) = (0.3_f64, 0.7_f64);
    let q = vector![x, y];
    assert_eq!(field.value(&q), fields::generating([x, y], 1.3, [0.4, -0.2]));
    let gradient = vector![1.3 * x * y.cos() + 0.4, -0.65 * x * x * y.sin() - 0.2];
    let hessian = matrix![
        1.3 * y.cos(), -1.3 * x * y.sin();
        -1.3 * x * y.sin(), -0.65 * x * x * y.cos()
    ];
    assert!((field.gradient(&q) - gradient).amax() < 1e-15);
    assert!((field.hessian(&q) - hessian).amax() < 1e-15);
    // The comparison would see a sign.
    assert!((field.hessian(&q) + hessian).amax() > 0.1);
}

#[test]
fn f32_fields_stay_in_f32() {
    let field = fields::Single { k: 2.0 };
    let derivatives = (field.gradient(&vector![0.5])[0], field.hessian(&vector![0.5])[(0, 0)]);
    assert_eq!(derivatives, (6.0 * 0.25_f32, 12.0 * 0.5_f32));
}
