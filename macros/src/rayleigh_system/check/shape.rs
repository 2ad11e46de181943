//! The shape that all arrays of a system share: N entries of one scalar.

use quote::ToTokens;
use syn::{Expr, ExprLit, Ident, Lit, Type};

use super::super::diagnostics::{Mistake, Report};
use super::super::model::Degrees;
use super::super::syntax::simple_name;

/// The shape that all arrays of a system share.
pub struct Shape {
    pub scalar: Ident,
    pub degrees: Degrees,
}

/// Whether a length is the literal 0.
pub fn is_zero(length: &Expr) -> bool {
    matches!(length, Expr::Lit(ExprLit { lit: Lit::Int(n), .. }) if n.base10_digits() == "0")
}

pub fn shape_of(ty: &Type, name: &'static str, system: &Ident, report: &mut Report) -> Option<Shape> {
    let Type::Array(array) = ty else {
        report.at(ty, Mistake::NotAnArray(name));
        return None;
    };
    let scalar = match simple_name(&array.elem) {
        Some(scalar) if scalar == "f64" || scalar == "f32" => scalar.clone(),
        _ => {
            report.at(&array.elem, Mistake::NotAScalar);
            return None;
        }
    };
    if is_zero(&array.len) {
        report.at(&array.len, Mistake::ZeroDegrees);
        return None;
    }
    Some(Shape { scalar, degrees: Degrees { length: array.len.clone(), system: system.clone() } })
}

pub fn same_shape(ty: &Type, name: &'static str, shape: &Shape, report: &mut Report) {
    let Type::Array(array) = ty else {
        report.at(ty, Mistake::NotAnArray(name));
        return;
    };
    if !is(&array.elem, &shape.scalar) {
        report.at(&array.elem, Mistake::OtherScalar { expected: shape.scalar.to_string() });
    }
    let expected = shape.degrees.length.to_token_stream().to_string();
    if array.len.to_token_stream().to_string() != expected {
        report.at(&array.len, Mistake::OtherDegrees { expected });
    }
}

/// Whether the type is an array as long as q.
pub fn has_shape(ty: &Type, shape: &Shape) -> bool {
    let expected = shape.degrees.length.to_token_stream().to_string();
    matches!(ty, Type::Array(array) if array.len.to_token_stream().to_string() == expected)
}

pub fn is(ty: &Type, scalar: &Ident) -> bool {
    simple_name(ty) == Some(scalar)
}
