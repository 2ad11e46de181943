//! Signatures of functions that L, R or f call: types that they may take and return.

use syn::{FnArg, Ident, ImplItemFn, Pat, ReturnType, Type};

use crate::rayleigh_system::check::qualifiers;
use crate::rayleigh_system::diagnostics::{Mistake, Report};
use crate::rayleigh_system::syntax::{is_integer, simple_name};

pub fn helper_signature(helper: &ImplItemFn, scalar: &Ident, report: &mut Report) {
    qualifiers(&helper.sig, report);
    for parameter in &helper.sig.inputs {
        match parameter {
            FnArg::Receiver(_) => {}
            FnArg::Typed(parameter) => {
                if !matches!(&*parameter.pat, Pat::Ident(_) | Pat::Wild(_)) {
                    report.at(&parameter.pat, Mistake::ParameterPattern);
                }
                let value = match &*parameter.ty {
                    Type::Reference(reference) if reference.mutability.is_none() => &reference.elem,
                    ty => ty,
                };
                if matches!(&*parameter.ty, Type::Reference(reference) if reference.mutability.is_some()) {
                    report.at(&parameter.ty, Mistake::ParameterChanged);
                } else if matches!(value, Type::Slice(_)) {
                    report.at(&parameter.ty, Mistake::ParameterSlice { scalar: scalar.to_string() });
                } else if !is_value(value) {
                    report.at(&parameter.ty, Mistake::ParameterType);
                }
            }
        }
    }
    if let ReturnType::Type(_, ty) = &helper.sig.output {
        match &**ty {
            Type::Reference(_) => report.at(ty, Mistake::HelperReturnsReference),
            ty if !is_value(ty) => report.at(ty, Mistake::ParameterType),
            _ => {}
        }
    }
}

/// Numbers, bools, arrays and tuples of them: what `Lift` and `Lower` take across.
fn is_value(ty: &Type) -> bool {
    match ty {
        Type::Array(array) => is_value(&array.elem),
        Type::Tuple(tuple) => tuple.elems.iter().all(is_value),
        Type::Paren(inner) => is_value(&inner.elem),
        Type::Group(inner) => is_value(&inner.elem),
        ty => {
            is_integer(ty)
                || simple_name(ty)
                    .is_some_and(|name| ["f64", "f32", "bool"].iter().any(|known| name == known))
        }
    }
}
