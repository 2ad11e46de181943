//! The list of names that generated code brings along is complete, and no more.

use std::collections::BTreeSet;

use proc_macro2::{TokenStream, TokenTree};
use quote::quote;

use crate::rayleigh_system::hygiene::GENERATED;
use crate::rayleigh_system::rules::Rule;
use crate::rayleigh_system::{Runtime, differentiable, rayleigh_system};

/// What is imported or defined within the constants that hold generated code.
fn names(tokens: TokenStream, in_constant: bool, found: &mut BTreeSet<String>) {
    let tokens: Vec<_> = tokens.into_iter().collect();
    let mut in_import = false;
    for (index, token) in tokens.iter().enumerate() {
        let word = |at: usize| match tokens.get(at) {
            Some(TokenTree::Ident(word)) => word.to_string(),
            Some(TokenTree::Punct(punct)) => punct.as_char().to_string(),
            _ => String::new(),
        };
        match token {
            TokenTree::Group(group) if in_import => {
                let text = group.stream().to_string();
                found.extend(
                    text.split(',').map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()),
                );
            }
            TokenTree::Group(group) => {
                let of_constant = index > 3 && word(index - 1) == "=" && word(index - 4) == "_";
                names(group.stream(), in_constant || of_constant, found);
            }
            TokenTree::Ident(name) if in_constant => {
                in_import |= name == "use";
                if in_import && name != "_" && word(index + 1) == ";" {
                    found.insert(name.to_string());
                }
                if name == "type" && word(index + 2) == "=" && word(index + 1) == "Vector" {
                    found.insert(word(index + 1));
                }
                if name == "trait" {
                    found.insert(word(index + 1));
                }
                // fn over<D: …>(…), and no lifetime
                if name == "fn" && word(index + 2) == "<" && word(index + 3) != "'" {
                    found.insert(word(index + 3));
                }
            }
            TokenTree::Punct(punct) => in_import &= punct.as_char() != ';',
            _ => {}
        }
    }
}

#[test]
fn every_name_that_generated_code_brings_along_is_listed() {
    let mut found = BTreeSet::new();
    let functions = quote! {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
            if q[0] > 0.0 && self.on { 0.5 * v[0] * v[0] } else { 0.5 * v[0] * v[0] - self.k * q[0].cos() * t }
        }
        fn rayleigh(&self, v: [f64; 1]) -> f64 { 0.5 * self.k * v[0] * v[0] }
    };
    let driven = quote! {
        impl System {
            #functions
            fn force(&self, q: [f64; 1], v: [f64; 1], u: [f64; 1]) -> [f64; 1] { [u[0] * q[0]] }
        }
    };
    let linear = quote! {
        impl System {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { 0.5 * v[0] * v[0] - q[0].cos() }
            fn rayleigh(&self, v: [f64; 1]) -> f64 { 0.5 * self.k * v[0] * v[0] }
        }
    };
    let with_own_methods = quote! {
        impl System {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { 0.5 * v[0] * v[0] - q[0].curve() }
        }
    };
    names(rayleigh_system(Runtime::STD, quote!(derivatives = num_dual), with_own_methods), false, &mut found);
    let options = [
        quote!(rule = [midpoint, trapezoidal, gauss], parameters = [k], step_derivatives = second),
        quote!(rule = [midpoint, gauss], derivatives = num_dual, step_derivatives = second),
    ];
    for options in options {
        names(rayleigh_system(Runtime::STD, options, driven.clone()), false, &mut found);
    }
    let joint = quote!(rule = [fitted, fitted_trapezoidal, one_sided]);
    names(rayleigh_system(Runtime::STD, joint, linear.clone()), false, &mut found);
    let kinked = quote! {
        impl System {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { 0.5 * v[0] * v[0] - self.cam.at(q[0]) }
            fn rayleigh(&self, v: [f64; 1]) -> f64 { v[0].abs() }
        }
    };
    names(rayleigh_system(Runtime::STD, quote!(rule = proximal), kinked), false, &mut found);
    let lanes = quote!(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss]);
    names(rayleigh_system(Runtime::STD, lanes, linear), false, &mut found);
    for field in [
        quote!(
            fn f(q: [f64; 1]) -> [f64; 1] {
                q
            }
        ),
        quote!(
            fn f(q: [f64; 1]) -> f64 {
                q[0]
            }
        ),
    ] {
        names(differentiable(Runtime::STD, TokenStream::new(), field), false, &mut found);
    }
    for keyword in ["self", "const"] {
        found.remove(keyword);
    }
    assert!(found.len() > 30, "{found:?}");
    let of_rules = Rule::ALL.map(|rule| rule.entry().name);
    let listed: BTreeSet<_> = GENERATED.iter().chain(&of_rules).map(|&name| name.to_owned()).collect();
    assert_eq!(found, listed);
}
